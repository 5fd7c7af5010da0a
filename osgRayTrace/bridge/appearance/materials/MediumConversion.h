// MediumConversion.h - converts a Medium of the API to one of the engine. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Medium.h"

#include <osgRayTrace/Medium>

namespace osgRayTrace::engine
{

inline Medium mediumOf(const osgRayTrace::Medium& source)
{
    const auto vector = [](const osg::Vec3& v) { return Vec3(v.x(), v.y(), v.z()); };
    Medium medium;
    medium.sigmaA = vector(source.getAbsorption());
    medium.sigmaS = vector(source.getScattering());
    medium.emission = vector(source.getEmission());
    medium.anisotropy = source.getAnisotropy();
    if (source.getPhase() == osgRayTrace::Medium::DROPLETS)
        medium.dropletSize = source.getDropletSize();
    medium.priority = source.getPriority();
    return medium;
}

} // namespace osgRayTrace::engine
