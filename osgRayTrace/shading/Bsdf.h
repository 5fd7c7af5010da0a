// Bsdf.h - samples and evaluates scattering at a surface point. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/BsdfTerms.h"

#include <optional>

namespace osgRayTrace::engine
{

/// Returns a direction that leaves the surface; nothing: the caller has to discard the sample.
/// uLobe, u, v: uniform in [0,1).
std::optional<BsdfSample> sampleBsdf(const Bsdf& bsdf, Vec3 wo, float uLobe, float u, float v,
                                     Transport transport = Transport::Radiance);

/// Returns the value for any wo and wi; it is zero if wo is below the surface.
BsdfValue evalBsdf(const Bsdf& bsdf, Vec3 wo, Vec3 wi, Transport transport = Transport::Radiance);

/// Returns E_avg of the surface's coat.
float coatAverage(const Bsdf& bsdf);

/// Returns the mirror-like lobes of a smooth surface.
SpecularLobes specularLobes(const Bsdf& bsdf, Vec3 wo);

/// Returns the directional albedo of the diffuse base under its coat, an upper bound: for first-hit
/// channels.
inline Vec3 bsdfAlbedo(const Bsdf& bsdf)
{
    return bsdf.diffuse + bsdf.reflectance + bsdf.transmission + bsdf.diffuseTransmission;
}

} // namespace osgRayTrace::engine
