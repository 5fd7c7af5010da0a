// SmoothLanes.cpp - the vector code for mirrors and clear glass. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/SmoothLanes.h"

#include "osgRayTrace/shading/Fresnel.h"

#include <cmath>

namespace osgRayTrace::engine
{

/// Chooses reflection with the probability p of its share of the light that leaves the surface, and
/// refraction with 1 - p:
///
///   d' = d + 2 c n          weight (S(c) + coat F(c)) / p               c = -d.n
///   d' = d/eta + (c/eta - sqrt(1 - (1 - c^2)/eta^2)) n     transmission (1 - F(c)) / (1 - p)
///
/// Both directions are those of [Walter07, eq. 20, 40]; Schlick's S and the interface's F are those
/// of Bsdf, and refracted radiance is divided by eta^2.
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
    FloatLanes shares;
    LaneMask outcome = 0; // alive, and from bit 16 on transmitted
    OSGRAYTRACE_SIMD_OR(outcome)
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t use = laneBit(lanes, i);
        const float dx = directionX[i], dy = directionY[i], dz = directionZ[i];
        const float nx = normal.x[i], ny = normal.y[i], nz = normal.z[i];
        const float eta = interfaces.eta[i], inverseEta = 1.0f / eta;
        const float cosO = -(dx * nx + dy * ny + dz * nz);

        const float fresnel = select(interfaces.coat[i] > 0.0f, fresnelDielectric(cosO, eta), 0.0f);
        const float schlick = schlickShare(cosO), grazing = interfaces.grazing[i];
        const float coated = interfaces.coat[i] * fresnel;
        const float rx = interfaces.reflectance.x[i], ry = interfaces.reflectance.y[i],
                    rz = interfaces.reflectance.z[i];
        const float reflectedX = rx + (grazing - rx) * schlick + coated;
        const float reflectedY = ry + (grazing - ry) * schlick + coated;
        const float reflectedZ = rz + (grazing - rz) * schlick + coated;
        const float below = 1.0f - fresnel;
        const float refractedX = interfaces.transmission.x[i] * below;
        const float refractedY = interfaces.transmission.y[i] * below;
        const float refractedZ = interfaces.transmission.z[i] * below;
        const float reflectedShare = luminanceOf(reflectedX, reflectedY, reflectedZ);
        const float refractedShare = luminanceOf(refractedX, refractedY, refractedZ);
        const float sum = reflectedShare + refractedShare;
        const float p = select(refractedShare > 0.0f, reflectedShare / sum, 1.0f);
        const uint32_t reflects = maskOf(uLobe[i] < p);
        shares[i] = p;

        // Where 1 - c^2 rounds to more or less, an index of 1 must bend nothing.
        const float sin2T = (1.0f - cosO * cosO) * inverseEta * inverseEta;
        const float cosT =
            select(eta == 1.0f, cosO, std::sqrt(select(sin2T < 1.0f, 1.0f - sin2T, 0.0f)));
        const float along = select(reflects, 1.0f, inverseEta);
        const float across = select(reflects, 2.0f * cosO, cosO * inverseEta - cosT);
        const float wx = dx * along + nx * across;
        const float wy = dy * along + ny * across;
        const float wz = dz * along + nz * across;
        const float length = 1.0f / std::sqrt(wx * wx + wy * wy + wz * wz);
        wi.x[i] = select(use, wx * length, wi.x[i]);
        wi.y[i] = select(use, wy * length, wi.y[i]);
        wi.z[i] = select(use, wz * length, wi.z[i]);

        const float scale = select(isRadiance, inverseEta * inverseEta, 1.0f) / (1.0f - p);
        const float inverseP = 1.0f / p;
        weight.x[i] =
            select(use, select(reflects, reflectedX * inverseP, refractedX * scale), weight.x[i]);
        weight.y[i] =
            select(use, select(reflects, reflectedY * inverseP, refractedY * scale), weight.y[i]);
        weight.z[i] =
            select(use, select(reflects, reflectedZ * inverseP, refractedZ * scale), weight.z[i]);

        const uint32_t passes = maskOf(sin2T < 1.0f) | maskOf(eta == 1.0f);
        const uint32_t alive = use & maskOf(cosO > 0.0f) & maskOf(sum > 0.0f) & (reflects | passes);
        outcome |= bitOfLane(alive, i) | (bitOfLane(alive & ~reflects, i) << kLanes);
    }
    return {outcome & kAllLanes, outcome >> kLanes, shares};
}

} // namespace osgRayTrace::engine
