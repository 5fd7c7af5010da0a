// ThinFilm.h - the colours of a film as thin as light waves are long. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

namespace osgRayTrace::engine
{

struct ThinFilm
{
    float ior = 1.3f;
    float thickness = 0.0f; ///< [nm]
};

/// Returns the reflectance of a film over a base, in linear RGB, within [0, 1], for light from air
/// under an angle with this cosine. normalReflectance: that of the base in air at normal incidence,
/// dielectric or metal. The film is that of [Belcour17, eq. 3] as [glTF20,
/// KHR_materials_iridescence] has it: two orders of interference, the base by Schlick's formula,
/// and a film thinner than 30 nm fades.
Vec3 filmReflectance(float cosTheta, ThinFilm film, Vec3 normalReflectance);

} // namespace osgRayTrace::engine
