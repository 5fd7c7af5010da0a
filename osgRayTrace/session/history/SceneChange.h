// SceneChange.h - where two versions of a scene differ. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// A box with sides along the axes.
struct ChangedBox
{
    Vec3 low{kInfinity}, high{-kInfinity};
};

/// An instance that has moved without a change of its shape, its size or its material. Lengths are
/// those of engine space.
struct RigidMove
{
    uint32_t instance = kInvalid;
    Mat4d afterFromBefore{1.0}; ///< takes points of the instance to their new places
    ChangedBox before, after;
};

/// Holds the differences between two versions of a scene that are some instances which have moved
/// or deformed, came, went, or have another material.
struct SceneChange
{
    std::vector<ChangedBox> boxes;   ///< old and new places, engine space
    std::vector<uint32_t> instances; ///< indices of the instances, ascending
    std::vector<RigidMove> moves;    ///< those of the instances that have moved rigidly
};

/// Changes of more instances than this are not told apart.
constexpr std::size_t kMostChanged = 256;

/// Returns what differs. Returns nothing if more differs than some instances, as lights, textures
/// and what lights do, or if one of these instances emits light.
std::optional<SceneChange> sceneChange(const Scene& before, const Scene& after);

/// Returns the bounds of an instance in engine space; an empty box if it has no triangles.
ChangedBox instanceBounds(const Scene& scene, const Instance& instance);

} // namespace osgRayTrace::engine
