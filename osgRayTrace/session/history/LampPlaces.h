// LampPlaces.h - where the lights of a scene are. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

/// Finds where lights are. The middle of a lamp's mesh is kept while the lamp stays as it is.
class LampPlaces
{
public:
    /// Returns the middles of the lights that are not infinitely far away [engine space].
    std::vector<Vec3> of(const std::vector<Light>& lights, const Scene& scene);

private:
    struct Known
    {
        Stamp changed = 0; ///< Light::changed
        std::weak_ptr<const Mesh> mesh;
        Vec3 place{0.0f};
    };

    Vec3 ofMesh(const Light& light, const Scene& scene);

    std::unordered_map<uint32_t, Known> _known; ///< by instance
};

} // namespace osgRayTrace::engine
