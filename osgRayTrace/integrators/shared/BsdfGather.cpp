// BsdfGather.cpp - the light that surfaces of any kind scatter from photons. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/PhotonGather.h"
#include "osgRayTrace/shading/BsdfLanes.h"

namespace osgRayTrace::engine
{

namespace
{

/// Adds the light of one photon that the surfaces of the given lanes reflect.
OSGRAYTRACE_KERNEL
void addPhoton(const Photon& photon, const Vec3Lanes& wi, const Vec3Lanes& fCos,
               const Vec3Lanes& geometricNormal, LaneMask lanes, Vec3Lanes& power)
{
    const float red = photon.power.x, green = photon.power.y, blue = photon.power.z;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float cosGeometric = dot(plainOf(wi, i), plainOf(geometricNormal, i));
        const uint32_t in = laneBit(lanes, i);
        power.x[i] += select(in, fCos.x[i] * red / cosGeometric, 0.0f);
        power.y[i] += select(in, fCos.y[i] * green / cosGeometric, 0.0f);
        power.z[i] += select(in, fCos.z[i] * blue / cosGeometric, 0.0f);
    }
}

/// Returns f cosTheta of one point for light from wi, or 0 if wi is not on the side of wo.
Vec3 evalAlone(const GatherLanes& points, int i, Vec3 wi)
{
    const Vec3 normal = laneOf(points.queries.shadingNormal, i);
    if (!(glm::dot(wi, normal) > 0.0f)) return Vec3(0.0f);
    return evalInWorld(points.bsdfs[i], normal, laneOf(points.wo, i), wi).fCos;
}

/// Adds light from the side of wo. Like light samples, photons must also come from above the
/// shading normal.
void addReflected(const PhotonMap& map, const GatherLanes& points, PhotonSumLanes& sums,
                  std::vector<FoundPhoton>& found)
{
    const BsdfLanes bsdfs = bsdfLanes(points.bsdfs, points.queries.lanes);
    LaneMask layered = 0; // lanes that BsdfLanes does not evaluate
    for (const int i : lanesIn(points.queries.lanes))
        layered |= static_cast<LaneMask>(points.bsdfs[i].layered) << i;
    found.clear();
    map.find(points.queries, found);
    Vec3Lanes wi, fCos;
    FloatLanes pdfW;
    for (const FoundPhoton& f : found)
    {
        const Photon photon = map.photon(f.photon);
        for (const int i : lanesIn(f.lanes))
            ++sums.count[i];
        const LaneMask lanes = photon.direct ? f.lanes : f.lanes & ~points.directOnly;
        if (!lanes) continue;
        for (int i = 0; i < kLanes; ++i)
            setLane(wi, i, photon.wi);
        if (countLanes(lanes) < kLeastBsdfLanes || (lanes & layered))
            for (const int i : lanesIn(lanes))
                setLane(fCos, i, evalAlone(points, i, photon.wi));
        else
            evalBsdfLanes(bsdfs, points.queries.shadingNormal, points.wo, wi, lanes, fCos, pdfW);
        addPhoton(photon, wi, fCos, points.queries.normal, lanes, sums.power);
    }
}

/// Adds light from behind a rough surface that transmits.
void addTransmitted(const PhotonMap& map, const GatherLanes& points, int i, PhotonSumLanes& sums,
                    std::vector<uint32_t>& found)
{
    PhotonQuery behind = laneOf(points.queries, i);
    behind.normal = -behind.normal;
    const ShadingFrame frame(behind.shadingNormal);
    const Vec3 wo = frame.toLocal(laneOf(points.wo, i));
    found.clear();
    map.find(behind, found);
    Vec3 power = laneOf(sums.power, i);
    for (const uint32_t k : found)
    {
        const Photon photon = map.photon(k);
        if ((points.directOnly >> i & 1u) && !photon.direct) continue;
        const Vec3 wi = frame.toLocal(photon.wi);
        if (wi.z > 0.0f) continue;
        power += evalBsdf(points.bsdfs[i], wo, wi).fCos * photon.power /
                 glm::dot(photon.wi, behind.normal);
    }
    setLane(sums.power, i, power);
    sums.count[i] += static_cast<uint32_t>(found.size());
}

} // namespace

Vec3 scatterPhoton(const GatherLanes& points, const Vec3Lanes& albedo, LaneMask diffuse, int i,
                   const Photon& photon)
{
    const float cosine = glm::dot(photon.wi, laneOf(points.queries.shadingNormal, i));
    if (!(cosine > 0.0f)) return Vec3(0.0f);
    const float geometric = glm::dot(photon.wi, laneOf(points.queries.normal, i));
    if ((diffuse >> i) & 1u) return laneOf(albedo, i) * (kInvPi * cosine / geometric);
    return evalAlone(points, i, photon.wi) / geometric;
}

void gatherBsdf(const PhotonMap& map, const GatherLanes& points, PhotonSumLanes& sums,
                GatherScratch& scratch)
{
    if (!points.queries.lanes) return;
    addReflected(map, points, sums, scratch.foundLanes);
    for (const int i : lanesIn(points.queries.lanes))
        if (points.bsdfs[i].scattersThrough()) addTransmitted(map, points, i, sums, scratch.found);
}

} // namespace osgRayTrace::engine
