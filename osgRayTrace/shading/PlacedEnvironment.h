// PlacedEnvironment.h - the environment of a scene, turned and scaled as its light says. Layer:
// shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Light.h"
#include "osgRayTrace/shading/EnvironmentStrata.h"

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace osgRayTrace::engine
{

/// Thread safe. Directions are unit vectors of engine space.
class PlacedEnvironment
{
public:
    /// previous: of the last snapshot, or null; its tables are taken over if the image is the same.
    PlacedEnvironment(const Light& light, uint32_t index, const PlacedEnvironment* previous);

    uint32_t light() const { return _index; } ///< into Scene::lights
    bool isVisible() const { return _visible; }
    bool isBlack() const { return map().isBlack() || luminance(_scale) <= 0.0f; }

    /// Integral over all directions.
    Vec3 integral() const { return Vec3(map().integral()) * _scale; }

    /// Distributed as the image's luminance; u, v in [0,1).
    EnvironmentSample sample(float u, float v) const;
    float pdfW(Vec3 direction) const { return map().pdfW(_mapFromEngine * direction); }

    /// What lights surfaces, and what is seen: see EnvironmentMap.
    Vec3 radiance(Vec3 direction) const
    {
        return map().radiance(_mapFromEngine * direction) * _scale;
    }
    Vec3 seenRadiance(Vec3 direction) const
    {
        return map().interpolatedRadiance(_mapFromEngine * direction) * _scale;
    }

    /// As count distant lights at most. The last ones made are kept.
    std::vector<EnvironmentStratum> strata(int count) const;

private:
    /// Of an image; shared by snapshots.
    struct Tables
    {
        explicit Tables(std::shared_ptr<const EnvironmentImage> image) : map(std::move(image)) {}

        const EnvironmentMap map;
        std::mutex mutex; ///< sessions of several views, on their draw threads, ask for strata
        int count = 0;    ///< asked for last
        std::vector<EnvironmentStratum> strata;
    };
    const EnvironmentMap& map() const { return _tables->map; }

    std::shared_ptr<Tables> _tables;
    uint32_t _index;
    bool _visible;
    Mat3 _mapFromEngine, _engineFromMap;
    Vec3 _scale;
};

} // namespace osgRayTrace::engine
