// Sheen.h - light that fibres reflect at grazing angles. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

namespace osgRayTrace::engine
{

constexpr float kLeastSheenRoughness = 0.1f; ///< below it the lobe is too thin for quadrature

/// Returns D V of a sheen of width alpha, the square of its roughness, for directions on the side
/// of the normal: the distribution of [Estevez17, eq. 2] with the masking of [Estevez17, eq. 3 and
/// table 1], where the masking of both directions is 1 / (1 + lambda(wo) + lambda(wi)). Thin lobes
/// would reflect more than arrives at grazing angles: such values are divided by the larger albedo
/// of both directions, which keeps them reciprocal.
float evalSheen(float alpha, Vec3 wo, Vec3 wi);

/// Returns the share of light that a white sheen reflects from a direction with this cosine, at
/// most 1: a table that is made when it is first asked for.
float sheenAlbedo(float alpha, float cosTheta);

} // namespace osgRayTrace::engine
