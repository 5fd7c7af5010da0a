// ClearCoat.h - what a clear coat reflects, around the surface's normal or one of its own. Layer:
// shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/BsdfTerms.h"

namespace osgRayTrace::engine
{

// All directions are in the frame of the facets: see toFacets in LayeredTerms.h.

/// Adds the value and the density of a rough clear coat with a normal of its own for two directions
/// on its side. pmf: the probability of this lobe.
void addTiltedClearcoat(const Bsdf& bsdf, Vec3 wo, Vec3 wi, float pmf, Transport transport,
                        BsdfValue& value);

/// Returns a microfacet of a rough clear coat that wo sees.
Vec3 sampleClearcoatFacet(const Bsdf& bsdf, Vec3 wo, float u, float v);

/// Returns the direction in which a smooth clear coat mirrors wo.
Vec3 clearcoatMirrored(const Bsdf& bsdf, Vec3 wo);

/// Returns the share of the light of wo that a smooth clear coat mirrors into that direction.
Vec3 clearcoatShare(const Bsdf& bsdf, Vec3 wo, Vec3 mirrored, Transport transport);

} // namespace osgRayTrace::engine
