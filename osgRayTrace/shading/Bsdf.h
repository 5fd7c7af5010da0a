// Bsdf.h - scattering at a surface point: Lambert base, GGX reflection, smooth and rough
// refraction. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/shading/CoatAlbedo.h"
#include "osgRayTrace/shading/Ggx.h"

#include <optional>

namespace osgRayTrace::engine
{

/// Radiance: wo is towards the camera. Importance: wo is where a photon came from; refraction then
/// lacks the change of solid angle [Veach97, ch. 5].
enum class Transport
{
    Radiance,
    Importance,
};

/// One model for all surfaces; what a surface does not have has weight 0. Directions are local, the
/// shading normal at +z on the side of wo, and point away from the surface.
///
///   f = diffuse/pi (1-E(wi))(1-E(wo))/(1-E_avg)          base, under the coat   [Shirley97, eq. 6]
///     + D G2 / (4 |wi.z wo.z|) (S(h) + coat F(h))        reflection             [Walter07, eq. 20]
///     + transmission D G2 (1-F(h)) ...                   refraction             [Walter07, eq. 21]
///
/// F = Fresnel of a dielectric of index eta (0 without a coat), E = what the coat reflects in all
/// directions: F of a smooth one, S = Schlick with reflectance and grazing. With alpha below
/// kSmoothAlpha D is a delta function; refraction is one, too, where microfacets turn it by too
/// little, which takes an index close to 1. Neither side makes energy, as diffuse + transmission <=
/// 1 - grazing, and coat is 0 or 1 - grazing.
struct Bsdf
{
    Vec3 diffuse{0.0f};       ///< albedo of the base
    Vec3 reflectance{0.0f};   ///< Schlick part at normal incidence: metals, highlights
    float grazing = 0.0f;     ///< Schlick part at grazing incidence
    float coat = 0.0f;        ///< share of dielectric interface
    Vec3 transmission{0.0f};  ///< tint of refracted light times its share; only with a coat
    float eta = 1.0f;         ///< index on the far side over that on wo's side
    float coatAverage = 0.0f; ///< fresnelDielectricAverage(eta)
    float alpha = 1.0f;       ///< GGX width
    /// E of a rough coat over a base: two rows of CoatAlbedo, which the MaterialTable owns, and the
    /// share of the second. Null: F.
    const CoatAlbedoRow* coatRows = nullptr;
    float coatFraction = 0.0f;

    bool reflects() const { return coat > 0.0f || grazing > 0.0f || reflectance != Vec3(0.0f); }
    bool transmits() const { return transmission != Vec3(0.0f); }
    bool isDiffuse() const { return !reflects() && !transmits(); }
    bool isSmooth() const { return alpha < kSmoothAlpha; }
};

struct BsdfSample
{
    Vec3 wi;            ///< unit, local
    Vec3 weight;        ///< f |wi.z| / pdfW
    float pdfW = 0.0f;  ///< [1/sr] of all lobes together; of delta lobes: their probability
    bool delta = false; ///< a mirror-like lobe, that no light sample can find
    bool transmitted = false;
};

/// A direction that leaves the surface. uLobe, u, v: uniform in [0,1). Nothing: discard the sample.
std::optional<BsdfSample> sampleBsdf(const Bsdf& bsdf, Vec3 wo, float uLobe, float u, float v,
                                     Transport transport = Transport::Radiance);

struct BsdfValue
{
    Vec3 fCos{0.0f};   ///< f |wi.z|, delta lobes left out
    float pdfW = 0.0f; ///< [1/sr] of sampleBsdf for wi, delta lobes left out
};

/// Any wo, wi; zero where wo is below the surface.
BsdfValue evalBsdf(const Bsdf& bsdf, Vec3 wo, Vec3 wi, Transport transport = Transport::Radiance);

/// E_avg of its coat.
float coatAverage(const Bsdf& bsdf);

/// The mirror-like lobes of a smooth surface, for integrators that follow all of them.
struct SpecularLobes
{
    Vec3 reflection{0.0f}; ///< weight of the mirror direction
    Vec3 refraction{0.0f}; ///< weight of the refracted one; zero on total reflection
    Vec3 refracted{0.0f};  ///< its direction, local
};
SpecularLobes specularLobes(const Bsdf& bsdf, Vec3 wo);

/// The direction behind an interface with normal h; nothing on total reflection. eta: far over
/// near.
std::optional<Vec3> refract(Vec3 wo, Vec3 h, float eta);

/// Directional albedo of the diffuse base under its coat, an upper bound: for first-hit channels.
inline Vec3 bsdfAlbedo(const Bsdf& bsdf)
{
    return bsdf.diffuse + bsdf.reflectance + bsdf.transmission;
}

} // namespace osgRayTrace::engine
