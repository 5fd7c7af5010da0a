// PlacedEnvironment.h - an environment, turned and scaled as its light says. Layer: shading.
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

/// Samples an environment in engine space by unit directions. Any thread may use the object.
class PlacedEnvironment
{
public:
    /// Places a light's image. previous: environment of the last snapshot, or null; its tables are
    /// taken over if the image is the same.
    PlacedEnvironment(const Light& light, uint32_t index, const PlacedEnvironment* previous);

    uint32_t light() const { return _index; } ///< index into Scene::lights
    bool isVisible() const { return _visible; }
    bool isBlack() const { return map().isBlack() || luminance(_scale) <= 0.0f; }
    bool isEven() const { return map().isEven(); } ///< see EnvironmentMap::isEven

    /// Returns the integral of radiance over all directions.
    Vec3 integral() const { return Vec3(map().integral()) * _scale; }

    /// Returns a sample; u, v in [0,1).
    EnvironmentSample sample(float u, float v,
                             EnvironmentDensity density = EnvironmentDensity::Luminance) const;
    float pdfW(Vec3 direction, EnvironmentDensity density) const
    {
        return map().pdfW(_mapFromEngine * direction, density);
    }

    /// Returns the radiance that lights surfaces; seenRadiance returns the radiance for eyes, which
    /// is interpolated: see EnvironmentMap.
    Vec3 radiance(Vec3 direction) const
    {
        return map().radiance(_mapFromEngine * direction) * _scale;
    }
    Vec3 seenRadiance(Vec3 direction) const
    {
        return map().interpolatedRadiance(_mapFromEngine * direction) * _scale;
    }

    /// Returns at most count distant lights that stand for the environment. The last strata made
    /// are kept.
    std::vector<EnvironmentStratum> strata(int count) const;

private:
    /// Holds the tables of an image; shared by snapshots.
    struct Tables
    {
        explicit Tables(std::shared_ptr<const EnvironmentImage> image) : map(std::move(image)) {}

        const EnvironmentMap map;
        std::mutex mutex; ///< sessions of several views ask for strata on their draw threads
        int count = 0;    ///< count that was last asked for
        std::vector<EnvironmentStratum> strata;
    };
    const EnvironmentMap& map() const { return _tables->map; }

    std::shared_ptr<Tables> _tables;
    uint32_t _index;
    bool _visible;
    Mat3 _mapFromEngine, _engineFromMap;
    Vec3 _scale;
};

/// Returns the irradiance of a surface by the environment, as a luminance [W/m^2], to some 0.1 %.
/// normal: unit, engine space.
float irradianceOf(const PlacedEnvironment& environment, Vec3 normal);

} // namespace osgRayTrace::engine
