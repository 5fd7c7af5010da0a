// SceneIndex.h - the part of a Scene that each path to a geometry has become. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/bridge/graph/RasterizedParts.h"
#include "osgRayTrace/scene/Scene.h"

#include <osg/Geometry>

#include <optional>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds the effects of a use's state beyond its material.
struct StateEffects
{
    const char* rasterized = nullptr; ///< see rasterizedState
    uint64_t restart = 0;
    float depthBias = 0.0f;
    bool physical = false;
    unsigned int uvSets = 0; ///< see MeshRequest
    bool setsColor = false;  ///< see setsCurrentColor
    uint64_t clipPlanes = 0; ///< planes that are on, see clipPlanesOn
    bool hasAmbient = false; ///< true: the state has a light model of its own, lit
    Vec3 ambient{0.0f};
    ConversionCounts counts; ///< counts of the use's material

    bool operator==(const StateEffects& other) const;
};

/// Returns the effects of a state. textures is as in rasterizedState.
StateEffects stateEffectsOf(const GraphState& state, const TextureConverter& textures);

struct TracedUse
{
    uint32_t instance = kInvalid; ///< kInvalid: the use is not traced
    uint32_t effects = kInvalid;  ///< kInvalid: OSG draws the use
};

struct TracedGeometry
{
    osg::ref_ptr<const osg::Geometry> geometry; ///< key in SceneIndex::geometries
    std::vector<TracedUse> uses;                ///< in the order of the traversal
    /// False: the mesh is made at its place, as cut faces are, or is not watched.
    bool patchable = true;
    bool raised = false; ///< true: its only use has raised faces, in a mesh made at its place
    bool culled = false; ///< true: CullWatch tells what changes in it, and GraphWatch does not
    bool plain = true;   ///< true: only its conversion is counted
};

/// Uses are added, changed and removed by the functions below alone, which count.
struct SceneIndex
{
    std::unordered_map<const osg::Geometry*, TracedGeometry> geometries;
    std::vector<StateEffects> stateEffects; ///< no two are equal

    /// Returns the entry of a geometry, which is a new one if there is none.
    TracedGeometry& at(const osg::Geometry& geometry)
    {
        TracedGeometry& traced = geometries[&geometry];
        traced.geometry = &geometry;
        return traced;
    }

    uint32_t effects(const StateEffects& effects);

    void addUse(TracedGeometry& traced, const TracedUse& use, std::size_t before);
    void removeUse(TracedGeometry& traced, std::size_t use);
    void removeUses(TracedGeometry& traced);
    void setEffects(TracedUse& use, uint32_t effects);

    /// Returns whether changes of a geometry are told by CullWatch, whose look was complete or will
    /// come to the geometry later. What is traced cannot wait for that, proxies can.
    bool isFollowedInCull(const osg::Geometry& geometry, bool complete) const;

    /// Returns whether OSG draws all of a geometry, and nothing of it is in the scene.
    bool isLeft(const osg::Geometry& geometry) const;

    /// Adds geometry that OpenGL draws and that has no proxy: that of parts, and more. Its place is
    /// that of its path, so it may move without a conversion.
    void addUntraced(const RasterizedParts& parts, const std::vector<const osg::Geometry*>& more);

    /// Uses whose state makes another colour current: see MaterialRules.
    std::size_t colorUses() const { return _colorUses; }

private:
    bool setsColor(const TracedUse& use) const
    {
        return use.effects != kInvalid && stateEffects[use.effects].setsColor;
    }

    std::size_t _colorUses = 0;
};

} // namespace osgRayTrace::engine
