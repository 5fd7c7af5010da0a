// BsdfGather.cpp - what surfaces of any kind make of the photons around sixteen points. Layer:
// integrators. SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/HitShading.h"
#include "osgRayTrace/integrators/PhotonGather.h"
#include "osgRayTrace/shading/Fresnel.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Of sixteen BSDFs what does not depend on a photon. Surfaces have no tangents: directions stay in
/// the world.
struct BsdfLanes
{
    Vec3Lanes normal; ///< shading
    Vec3Lanes wo;
    FloatLanes cosO; ///< of wo and normal
    Vec3Lanes base;  ///< diffuse / pi, and what the coat leaves of wo
    UintLanes coated; ///< mask: what the coat leaves of wi counts, too
    UintLanes shines; ///< mask: there is reflection that is not mirror-like
    Vec3Lanes reflectance;
    FloatLanes grazing, coat, eta;
    FloatLanes alpha2, lambdaO;
    FloatLanes coatFraction;
};

/// Light that a photon brings.
struct PhotonLight
{
    float wiX, wiY, wiZ;
    float r, g, b;
};

/// Albedo of a coat by the two rows of its roughness: CoatAlbedoRow, without branches.
OSGRAYTRACE_INLINE float rowAlbedo(const float* first, const float* second, float fraction,
                                   float cosTheta)
{
    constexpr int kSteps = CoatAlbedoRow::kSteps;
    const float c = select(cosTheta > 0.0f, select(cosTheta < 1.0f, cosTheta, 1.0f), 0.0f);
    const float x = std::sqrt(c) * float(kSteps);
    const int k = static_cast<int>(x);
    const float t = x - static_cast<float>(k);
    const float a = first[k] + (first[k + 1] - first[k]) * t;
    const float b = second[k] + (second[k + 1] - second[k]) * t;
    return a + (b - a) * fraction;
}

/// power f / |cos| of the geometric normal: evalBsdf in lanes, of light from the side of wo.
template <bool kRows>
OSGRAYTRACE_INLINE void addLight(const BsdfLanes& s, const Vec3Lanes& geometricNormal,
                                 const float* firstRow, const float* secondRow,
                                 const PhotonLight& light, LaneMask lanes, Vec3Lanes& power)
{
    const float wx = light.wiX, wy = light.wiY, wz = light.wiZ;
    const float red = light.r, green = light.g, blue = light.b;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float nx = s.normal.x[i], ny = s.normal.y[i], nz = s.normal.z[i];
        const float cosO = s.cosO[i], eta = s.eta[i];
        const float cosI = wx * nx + wy * ny + wz * nz;
        const float cosGeometric = wx * geometricNormal.x[i] + wy * geometricNormal.y[i] +
                                   wz * geometricNormal.z[i];
        // Light and shading normal must agree on the side, as for light samples.
        const uint32_t in =
            laneBit(lanes, i) & maskOf(cosI > 0.0f) & maskOf(cosO > 0.0f);

        const float albedo = kRows ? rowAlbedo(firstRow, secondRow, s.coatFraction[i], cosI)
                                   : fresnelDielectric(cosI, eta);
        const float below = cosI * select(s.coated[i], 1.0f - albedo, 1.0f);

        // D G2 / (4 cosO) [Walter07, eq. 20]
        float hx = s.wo.x[i] + wx, hy = s.wo.y[i] + wy, hz = s.wo.z[i] + wz;
        const float length2 = hx * hx + hy * hy + hz * hz;
        const float length = std::sqrt(length2), inverse = 1.0f / length;
        const float cosN = (hx * nx + hy * ny + hz * nz) * inverse, cosH = 0.5f * length;
        hx = hx * inverse - nx * cosN;
        hy = hy * inverse - ny * cosN;
        hz = hz * inverse - nz * cosN;
        const float alpha2 = s.alpha2[i];
        const float d = hx * hx + hy * hy + hz * hz + alpha2 * cosN * cosN;
        const float cos2 = cosI * cosI;
        const float lambdaI = 0.5f * (std::sqrt(1.0f + alpha2 * (1.0f - cos2) / cos2) - 1.0f);
        const float facets = alpha2 / (kPi * d * d * (1.0f + s.lambdaO[i] + lambdaI) * 4.0f * cosO);
        const float glint =
            select(s.shines[i] & maskOf(length2 >= 1e-14f), facets, 0.0f);
        const float m = 1.0f - select(cosH < 1.0f, cosH, 1.0f), m2 = m * m;
        const float schlick = m2 * m2 * m, grazing = s.grazing[i];
        const float coat = s.coat[i] * fresnelDielectric(cosH, eta);

        const float rx = s.reflectance.x[i], ry = s.reflectance.y[i], rz = s.reflectance.z[i];
        const float x = s.base.x[i] * below + (rx + (grazing - rx) * schlick + coat) * glint;
        const float y = s.base.y[i] * below + (ry + (grazing - ry) * schlick + coat) * glint;
        const float z = s.base.z[i] * below + (rz + (grazing - rz) * schlick + coat) * glint;
        power.x[i] += select(in, x * red / cosGeometric, 0.0f);
        power.y[i] += select(in, y * green / cosGeometric, 0.0f);
        power.z[i] += select(in, z * blue / cosGeometric, 0.0f);
    }
}

OSGRAYTRACE_KERNEL
void addLightLanes(const BsdfLanes& surfaces, const Vec3Lanes& geometricNormal,
                   const CoatAlbedoRow* rows, const PhotonLight& light, LaneMask lanes,
                   Vec3Lanes& power)
{
    if (rows)
        addLight<true>(surfaces, geometricNormal, rows[0].albedo.data(), rows[1].albedo.data(),
                       light, lanes, power);
    else
        addLight<false>(surfaces, geometricNormal, nullptr, nullptr, light, lanes, power);
}

void setLane(BsdfLanes& lanes, int i, const Bsdf& bsdf, Vec3 normal, Vec3 wo)
{
    const float cosO = glm::dot(wo, normal);
    const bool coated = bsdf.coat > 0.0f && bsdf.diffuse != Vec3(0.0f);
    engine::setLane(lanes.normal, i, normal);
    engine::setLane(lanes.wo, i, wo);
    lanes.cosO[i] = cosO;
    engine::setLane(lanes.base, i, bsdf.diffuse * (kInvPi * (coated ? coatShareOf(bsdf, cosO) : 1.0f)));
    lanes.coated[i] = maskOf(coated);
    lanes.shines[i] = maskOf(bsdf.reflects() && !bsdf.isSmooth());
    engine::setLane(lanes.reflectance, i, bsdf.reflectance);
    lanes.grazing[i] = bsdf.grazing;
    lanes.coat[i] = bsdf.coat;
    lanes.eta[i] = bsdf.eta;
    lanes.alpha2[i] = bsdf.alpha * bsdf.alpha;
    lanes.lambdaO[i] = ggxLambda(ShadingFrame(normal).toLocal(wo), bsdf.alpha);
    lanes.coatFraction[i] = bsdf.coatFraction;
}

/// Light from the side of wo.
void addReflected(const PhotonMap& map, const GatherLanes& points, PhotonSumLanes& sums)
{
    BsdfLanes surfaces;
    for (int i = 0; i < kLanes; ++i)
    {
        // Lanes out of use hold what a lane in use does: vector code reads them.
        const int from = (points.queries.lanes >> i) & 1u ? i : __builtin_ctz(points.queries.lanes);
        setLane(surfaces, i, points.bsdfs[from], laneOf(points.queries.shadingNormal, from),
                laneOf(points.wo, from));
    }
    static thread_local std::vector<FoundPhoton> found;
    found.clear();
    map.find(points.queries, found);
    for (const FoundPhoton& f : found)
    {
        const Photon photon = map.photon(f.photon);
        const PhotonLight light{photon.wi.x,    photon.wi.y,    photon.wi.z,
                                photon.power.x, photon.power.y, photon.power.z};
        for (LaneMask lanes = f.lanes; lanes; lanes &= lanes - 1)
            ++sums.count[__builtin_ctz(lanes)];
        LaneMask left = photon.direct ? f.lanes : f.lanes & ~points.directOnly;
        while (left) // once, where the points are of one material
        {
            const CoatAlbedoRow* rows = points.bsdfs[__builtin_ctz(left)].coatRows;
            LaneMask same = 0;
            for (LaneMask lanes = left; lanes; lanes &= lanes - 1)
                same |= points.bsdfs[__builtin_ctz(lanes)].coatRows == rows ? lanes & -lanes : 0;
            addLightLanes(surfaces, points.queries.normal, rows, light, same, sums.power);
            left &= ~same;
        }
    }
}

/// Light from behind a rough surface that transmits.
void addTransmitted(const PhotonMap& map, const GatherLanes& points, int i, PhotonSumLanes& sums)
{
    PhotonQuery behind = laneOf(points.queries, i);
    behind.normal = -behind.normal;
    const ShadingFrame frame(behind.shadingNormal);
    const Vec3 wo = frame.toLocal(laneOf(points.wo, i));
    static thread_local std::vector<uint32_t> found;
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
    engine::setLane(sums.power, i, power);
    sums.count[i] += static_cast<uint32_t>(found.size());
}

} // namespace

void gatherBsdf(const PhotonMap& map, const GatherLanes& points, PhotonSumLanes& sums)
{
    if (!points.queries.lanes) return;
    addReflected(map, points, sums);
    for (LaneMask lanes = points.queries.lanes; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        if (points.bsdfs[i].transmits() && !points.bsdfs[i].isSmooth())
            addTransmitted(map, points, i, sums);
    }
}

} // namespace osgRayTrace::engine
