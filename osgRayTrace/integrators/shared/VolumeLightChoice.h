// VolumeLightChoice.h - the light that lights osgVolume's tiles. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/PassContext.h"
#include "osgRayTrace/media/VolumeLighting.h"

namespace osgRayTrace::engine
{

/// Returns the light that OpenGL numbers 0. Without one it is as OpenGL has it at first: far behind
/// the eye.
inline VolumeLight volumeLight(const PassContext& context)
{
    for (const Light& light : *context.lights)
        if (light.number == 0 &&
            (light.kind == LightKind::Directional || light.kind == LightKind::Point))
            return {light.kind == LightKind::Directional, light.direction, light.position};
    return {true, -context.towardsViewer, Vec3(0.0f)};
}

} // namespace osgRayTrace::engine
