// PaneLanes.cpp - the vector code for light that passes clear panes. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/PaneLanes.h"

#include "osgRayTrace/shading/Fresnel.h"

#include <cmath>

namespace osgRayTrace::engine
{

bool isClearPane(const Bsdf& b)
{
    return b.thin && b.isSmooth() && b.transmits() && b.film == 0.0f && b.clearcoat == 0.0f &&
           b.sheen == Vec3(0.0f);
}

/// What LayeredTerms.h says of one channel, with the reflectance 2 F' / (1 + F') of both faces:
/// transmission (1 - F') / (1 + F'). rise: (F - F0) / (1 - F0) of the faces' Fresnel term F.
static OSGRAYTRACE_INLINE float passed(float transmission, float normalReflectance, float specular,
                                       float rise)
{
    const float raised = normalReflectance + (1.0f - normalReflectance) * rise;
    const float atMostOne = select(raised < 1.0f, raised, 1.0f);
    const float face = specular * select(atMostOne > 0.0f, atMostOne, 0.0f);
    return transmission * (1.0f - face) / (1.0f + face);
}

OSGRAYTRACE_KERNEL
void clearPaneLanes(const Bsdf& pane, const IncidentLanes& incident, Vec3Lanes& share)
{
    // These stand before the loop: members that are read within it keep it from being vectorized.
    const FloatLanes &directionX = incident.directionX, &directionY = incident.directionY,
                     &directionZ = incident.directionZ;
    const Vec3Lanes& normal = incident.normal;
    const float eta = pane.eta, root = (eta - 1.0f) / (eta + 1.0f), least = root * root;
    const float specular = pane.coat == 0.0f ? 0.0f : pane.specular;
    const PlainVec3 transmission = plainOf(pane.transmission),
                    reflectance = plainOf(pane.normalReflectance);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float cosine =
            directionX[i] * normal.x[i] + directionY[i] * normal.y[i] + directionZ[i] * normal.z[i];
        const float rise = (fresnelDielectric(cosine, eta) - least) / (1.0f - least);
        share.x[i] = passed(transmission.x, reflectance.x, specular, rise);
        share.y[i] = passed(transmission.y, reflectance.y, specular, rise);
        share.z[i] = passed(transmission.z, reflectance.z, specular, rise);
    }
}

} // namespace osgRayTrace::engine
