// PhotonGather.cpp - radiance that a surface sends to the eye from the photons around a point.
// Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/PhotonGather.h"

#include "osgRayTrace/integrators/HitShading.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Where the largest radius holds no more photons than this the radius comes from one look-up. Where it holds
/// more it is narrowed down first, by sums that need not read the photons of a crowd.
constexpr std::size_t kMostReaches = 4096;
constexpr int kNarrowings = 8; ///< of the octave that the radius is in

void addPhotons(const PhotonMap& map, const GatherPoint& point, const PhotonQuery& query,
                const ShadingFrame& frame, Vec3 wo, bool behind, PhotonSum& sum)
{
    static thread_local std::vector<uint32_t> found;
    found.clear();
    map.find(query, found);
    for (const uint32_t k : found)
    {
        const Photon photon = map.photon(k);
        if (point.directOnly && !photon.direct) continue;
        const float cosGeometric = glm::dot(photon.wi, query.normal);
        const Vec3 wi = frame.toLocal(photon.wi);
        // Light and shading normal must agree on the side, as for light samples.
        if ((wi.z > 0.0f) == behind) continue;
        const BsdfValue value = evalBsdf(*point.bsdf, wo, wi);
        sum.power += value.fCos * photon.power / cosGeometric;
    }
    sum.count += static_cast<uint32_t>(found.size());
}

} // namespace

float radiusOf(const PhotonMap& map, PhotonQuery query, float least, float largest)
{
    if (!(least < largest)) return largest;
    static thread_local PhotonReaches reaches;
    query.radius = largest;
    if (map.findReaches(query, kMostReaches, reaches))
        return std::clamp(reaches.radiusBefore(kRadiusPhotons), least, largest);

    const auto holdsMore = [&](float radius)
    {
        query.radius = radius;
        return map.gather(query).count > kRadiusPhotons;
    };
    if (holdsMore(least)) return least;
    float few = least, many = std::min(2.0f * least, largest);
    for (; many < largest && !holdsMore(many); many = std::min(2.0f * many, largest))
        few = many;
    for (int i = 0; i < kNarrowings; ++i)
    {
        query.radius = many;
        if (map.findReaches(query, kMostReaches, reaches))
            return std::clamp(reaches.radiusBefore(kRadiusPhotons), few, many);
        const float middle = std::sqrt(few * many);
        (holdsMore(middle) ? many : few) = middle;
    }
    return many;
}

PhotonSum gatherDiffuse(const PhotonMap& map, const PhotonQuery& query, Vec3 albedo)
{
    PhotonSum sum = map.gather(query);
    sum.power *= albedo * kInvPi;
    return sum;
}

PhotonSum gatherBsdf(const PhotonMap& map, const GatherPoint& point)
{
    const ShadingFrame frame(point.query.shadingNormal);
    const Vec3 wo = frame.toLocal(point.wo);
    PhotonSum sum;
    addPhotons(map, point, point.query, frame, wo, false, sum);
    if (point.bsdf->transmits() && !point.bsdf->isSmooth())
    {
        PhotonQuery behind = point.query;
        behind.normal = -behind.normal;
        addPhotons(map, point, behind, frame, wo, true, sum);
    }
    return sum;
}

} // namespace osgRayTrace::engine
