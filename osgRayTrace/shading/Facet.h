// Facet.h - reflection at microfacets: its value and density. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/Ggx.h"

#include <cmath>

namespace osgRayTrace::engine
{

/// Holds D and the density of a reflection at microfacets.
struct Facet
{
    float cosH = 0.0f;
    float value = 0.0f; ///< D G2 / (4 wo.z)
    float pdfW = 0.0f;
};

template <class Width> Facet facetOf(Vec3 wo, Vec3 wi, Width alpha)
{
    Facet facet;
    const Vec3 sum = wo + wi;
    const float length2 = glm::dot(sum, sum);
    if (length2 < 1e-14f) return facet;
    const float length = std::sqrt(length2);
    facet.cosH = 0.5f * length;
    const float d = evalGgx(sum / length, alpha) / (4.0f * wo.z);
    facet.value = d * ggxG2(wo, wi, alpha);
    facet.pdfW = d * ggxG1(wo, alpha);
    return facet;
}

} // namespace osgRayTrace::engine
