// SmoothLanes.cpp - the vector code for mirrors and clear glass. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/SmoothLanes.h"

#include "osgRayTrace/shading/Fresnel.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// A ray and the normal of the interface that it meets.
struct PlainIncident
{
    PlainVec3 direction, normal;
};

/// What an interface reflects and lets through, and the probability of reflection.
struct Lobes
{
    PlainVec3 reflected, refracted;
    float sum; ///< of their luminances
    float p;
};

OSGRAYTRACE_INLINE Lobes lobesOf(const InterfaceLanes& interfaces, int i, float cosO)
{
    const float coat = interfaces.coat[i], grazing = interfaces.grazing[i];
    const float fresnel = select(coat > 0.0f, fresnelDielectric(cosO, interfaces.eta[i]), 0.0f);
    const float schlick = schlickShare(cosO);
    const float coated = coat * fresnel;
    const PlainVec3 r = plainOf(interfaces.reflectance, i);
    Lobes lobes;
    lobes.reflected = {r.x + (grazing - r.x) * schlick + coated,
                       r.y + (grazing - r.y) * schlick + coated,
                       r.z + (grazing - r.z) * schlick + coated};
    lobes.refracted = plainOf(interfaces.transmission, i) * (1.0f - fresnel);
    const float reflectedShare = luminanceOf(lobes.reflected);
    const float refractedShare = luminanceOf(lobes.refracted);
    lobes.sum = reflectedShare + refractedShare;
    lobes.p = select(refractedShare > 0.0f, reflectedShare / lobes.sum, 1.0f);
    return lobes;
}

/// Chooses reflection with the probability p of its share of the light that leaves the surface, and
/// refraction with 1 - p:
///
///   d' = d + 2 c n          weight (S(c) + coat F(c)) / p               c = -d.n
///   d' = d/eta + (c/eta - sqrt(1 - (1 - c^2)/eta^2)) n     transmission (1 - F(c)) / (1 - p)
///
/// Both directions are those of [Walter07, eq. 20, 40]; Schlick's S and the interface's F are those
/// of Bsdf, and refracted radiance is divided by eta^2.
OSGRAYTRACE_INLINE LaneMask sampleLane(const InterfaceLanes& interfaces, PlainIncident incident,
                                       int i, float uLobe, uint32_t use, uint32_t isRadiance,
                                       Vec3Lanes& wi, Vec3Lanes& weight)
{
    const PlainVec3 d = incident.direction, n = incident.normal;
    const float eta = interfaces.eta[i], inverseEta = 1.0f / eta;
    const float cosO = -dot(d, n);
    const Lobes lobes = lobesOf(interfaces, i, cosO);
    const uint32_t reflects = maskOf(uLobe < lobes.p);

    // Where 1 - c^2 rounds to more or less, an index of 1 must bend nothing.
    const float sin2T = (1.0f - cosO * cosO) * inverseEta * inverseEta;
    const float cosT =
        select(eta == 1.0f, cosO, std::sqrt(select(sin2T < 1.0f, 1.0f - sin2T, 0.0f)));
    const float along = select(reflects, 1.0f, inverseEta);
    const float across = select(reflects, 2.0f * cosO, cosO * inverseEta - cosT);
    const PlainVec3 w = d * along + n * across;
    const float length = 1.0f / std::sqrt(dot(w, w));
    setLane(wi, i, select(use, w * length, plainOf(wi, i)));

    const float scale = select(isRadiance, inverseEta * inverseEta, 1.0f) / (1.0f - lobes.p);
    const float inverseP = 1.0f / lobes.p;
    const PlainVec3 chosen = select(reflects, lobes.reflected * inverseP, lobes.refracted * scale);
    setLane(weight, i, select(use, chosen, plainOf(weight, i)));

    const uint32_t passes = maskOf(sin2T < 1.0f) | maskOf(eta == 1.0f);
    const uint32_t alive =
        use & maskOf(cosO > 0.0f) & maskOf(lobes.sum > 0.0f) & (reflects | passes);
    return bitOfLane(alive, i) | (bitOfLane(alive & ~reflects, i) << kLanes);
}

} // namespace

OSGRAYTRACE_KERNEL
SmoothLanes sampleSmoothLanes(const InterfaceLanes& interfaces, const IncidentLanes& incident,
                              const FloatLanes& uLobe, LaneMask lanes, Transport transport,
                              Vec3Lanes& wi, Vec3Lanes& weight)
{
    const uint32_t isRadiance = maskOf(transport == Transport::Radiance);
    // These references stand before the loop: members that are read through a reference within it
    // keep it from being vectorized.
    const FloatLanes &directionX = incident.directionX, &directionY = incident.directionY,
                     &directionZ = incident.directionZ;
    const Vec3Lanes& normal = incident.normal;
    LaneMask outcome = 0;
    OSGRAYTRACE_SIMD_OR(outcome)
    for (int i = 0; i < kLanes; ++i)
        outcome |= sampleLane(interfaces,
                              {{directionX[i], directionY[i], directionZ[i]}, plainOf(normal, i)},
                              i, uLobe[i], laneBit(lanes, i), isRadiance, wi, weight);
    return {outcome & kAllLanes, outcome >> kLanes};
}

} // namespace osgRayTrace::engine
