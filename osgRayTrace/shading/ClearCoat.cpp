// ClearCoat.cpp - reflection of clear coats around the surface's normal or their own. Layer:
// shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/ClearCoat.h"

#include "osgRayTrace/sampling/Warp.h"
#include "osgRayTrace/shading/Facet.h"
#include "osgRayTrace/shading/LayeredTerms.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Holds the orthonormal frame around the normal of the coat, in the frame of the facets.
struct CoatFrame
{
    explicit CoatFrame(const Bsdf& b) : n(toFacets(b, b.coatNormal))
    {
        frameOf(n.x, n.y, n.z, x, y);
    }
    Vec3 toLocal(Vec3 w) const { return {glm::dot(w, x), glm::dot(w, y), glm::dot(w, n)}; }

    Vec3 n, x, y;
};

/// Returns the factor that photons need where the coat has a normal of its own: radiance is weighed
/// with the cosine of wi to that normal in place of the surface's, and the adjoint of that
/// [Veach97, sect. 5.3] with the cosine of wo.
float clearcoatAdjoint(const Bsdf& b, Vec3 wo, Vec3 wi, Transport transport)
{
    if (!b.coatTilted || transport == Transport::Radiance) return 1.0f;
    return coatCosine(b, wo) * wi.z / (coatCosine(b, wi) * wo.z);
}

} // namespace

float tiltedCoatCosine(const Bsdf& b, Vec3 w)
{
    const float cosine = glm::dot(w, toFacets(b, b.coatNormal));
    return std::max(w.z < 0.0f ? -cosine : cosine, 0.0f);
}

void addTiltedClearcoat(const Bsdf& b, Vec3 wo, Vec3 wi, float pmf, Transport transport,
                        BsdfValue& value)
{
    const CoatFrame frame(b);
    const Vec3 o = frame.toLocal(wo), i = frame.toLocal(wi);
    if (!(o.z > 0.0f && i.z > 0.0f)) return;
    const Facet facet = facetOf(o, i, b.clearcoatAlpha);
    const float below = std::min(belowSheen(b, wo.z), belowSheen(b, wi.z));
    value.fCos += Vec3(b.clearcoat * fresnelDielectric(facet.cosH, kClearcoatIndex) * facet.value *
                       below * clearcoatAdjoint(b, wo, wi, transport));
    value.pdfW += pmf * facet.pdfW;
}

Vec3 clearcoatMirrored(const Bsdf& b, Vec3 wo)
{
    if (!b.coatTilted) return Vec3(-wo.x, -wo.y, wo.z);
    const Vec3 n = toFacets(b, b.coatNormal);
    return n * (2.0f * glm::dot(wo, n)) - wo;
}

Vec3 clearcoatShare(const Bsdf& b, Vec3 wo, Vec3 wi, Transport transport)
{
    if (!(wi.z > 0.0f)) return Vec3(0.0f);
    const float below =
        b.coatTilted ? std::min(belowSheen(b, wo.z), belowSheen(b, wi.z)) : belowSheen(b, wo.z);
    return Vec3(b.clearcoat * fresnelDielectric(coatCosine(b, wo), kClearcoatIndex) * below *
                clearcoatAdjoint(b, wo, wi, transport));
}

Vec3 sampleClearcoatFacet(const Bsdf& b, Vec3 wo, float u, float v)
{
    if (!b.coatTilted) return sampleGgxVisible(wo, b.clearcoatAlpha, u, v);
    const CoatFrame frame(b);
    const Vec3 h = sampleGgxVisible(frame.toLocal(wo), b.clearcoatAlpha, u, v);
    return frame.x * h.x + frame.y * h.y + frame.n * h.z;
}

} // namespace osgRayTrace::engine
