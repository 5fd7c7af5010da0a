// BsdfTerms.h - scattering at a surface point: Lambert base, GGX reflection, refraction. Layer:
// shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/shading/CoatAlbedo.h"
#include "osgRayTrace/shading/Ggx.h"

namespace osgRayTrace::engine
{

/// GGX width from which on a lobe is rough: photons are looked up there. Light that a narrower lobe
/// casts on other surfaces makes caustics.
constexpr float kRoughAlpha = 0.25f;

/// Tells the direction of transport. Radiance: wo is towards the camera. Importance: wo is where a
/// photon came from; refraction then lacks the change of solid angle [Veach97, ch. 5].
enum class Transport
{
    Radiance,
    Importance,
};

/// Describes all surfaces by one model; a component that a surface does not have has weight 0.
/// Directions are local and point away from the surface, with the shading normal at +z on the side
/// of wo.
///
///   f = diffuse/pi (1-E(wi))(1-E(wo))/(1-E_avg)          base, under the coat   [Shirley97, eq. 6]
///     + D G2 / (4 |wi.z wo.z|) (S(h) + coat F(h))        reflection             [Walter07, eq. 20]
///     + transmission D G2 (1-F(h)) ...                   refraction             [Walter07, eq. 21]
///
/// F is the Fresnel reflectance of a dielectric of index eta (0 without a coat). E is the share
/// that the coat reflects in all directions, which is F for a smooth coat, and S is Schlick's
/// formula with reflectance and grazing. With alpha below kSmoothAlpha D is a delta function.
/// Refraction is a delta function, too, if microfacets turn it by too little, which takes an index
/// close to 1. Neither side makes energy, as diffuse + transmission <= 1 - grazing, and coat is 0
/// or 1 - grazing.
///
/// A surface with layers (a clear coat, sheen, a thin wall, a film, anisotropy, diffuse
/// transmission or another reflectance than that of the index) has the terms of LayeredBsdf.h,
/// which says what the last members mean.
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
    /// E of a rough coat over a base is given by two rows of CoatAlbedo, which the MaterialTable
    /// owns, and the share of the second row. Null: E is F.
    const CoatAlbedoRow* coatRows = nullptr;
    float coatFraction = 0.0f;

    bool layered = false;         ///< true: the surface has some of the members below
    bool thin = false;            ///< true: a wall that light passes without being bent
    bool inside = false;          ///< true: wo is within the body; the layers are on the other side
    bool coatTilted = false;      ///< true: the clear coat has a normal of its own
    Vec3 normalReflectance{0.0f}; ///< of the interface, at normal incidence; layered only
    float specular = 1.0f;        ///< factor of the reflectance of the interface
    float clearcoat = 0.0f, clearcoatAlpha = 0.0f;
    const CoatAlbedoRow* clearcoatRows = nullptr; ///< of a rough clear coat; null: it is smooth
    float clearcoatFraction = 0.0f;
    Vec3 coatNormal{0.0f, 0.0f, 1.0f}; ///< of the clear coat, local, on wo's side: see alignLayers
    Vec3 sheen{0.0f};
    float sheenAlpha = 0.0f;
    float alphaTangent = 0.0f;      ///< GGX width along the tangent, alpha across; 0: isotropic
    Vec2 tangent{1.0f, 0.0f};       ///< local, unit
    Vec3 diffuseTransmission{0.0f}; ///< share of light that the base diffuses to the other side
    float film = 0.0f;              ///< share of the surface that has a thin film
    float filmIor = 1.0f, filmThickness = 0.0f; ///< thickness [nm]
    float filmRise = 0.0f;   ///< least a for which F' <= F + a (1 - F) at all angles
    float subsurface = 0.0f; ///< share of diffuse whose light enters the body: see splitSubsurface
    float baseShare = 1.0f;  ///< diffuse over the base colour
    bool leavesBody = false; ///< true: the inner side of the base is all that there is: LayeredBsdf
    float baseAverage = 1.0f; ///< mean over cosine-weighted directions of what reaches the base

    /// Returns the index that radiance and directions change by if light is transmitted.
    float transmittedEta() const { return thin || !transmits() ? 1.0f : eta; }

    bool reflects() const { return coat > 0.0f || grazing > 0.0f || reflectance != Vec3(0.0f); }
    bool transmits() const { return transmission != Vec3(0.0f); }
    /// Returns whether light that arrives on the other side may be seen.
    bool passesLight() const { return transmits() || diffuseTransmission != Vec3(0.0f); }
    /// Returns whether light from the other side is scattered, so that light samples find it.
    bool scattersThrough() const
    {
        return (transmits() && !isSmooth()) || diffuseTransmission != Vec3(0.0f);
    }
    bool isAnisotropic() const { return alphaTangent > 0.0f; }
    /// Returns whether axes of the mesh decide on some layer: see alignLayers.
    bool needsAxes() const { return isAnisotropic() || coatTilted; }
    bool isDiffuse() const { return !reflects() && !transmits() && !layered; }
    bool isSmooth() const { return alpha < kSmoothAlpha; }
    /// Returns whether all lobes are narrower than kRoughAlpha, and some wider than a mirror's. The
    /// answer is the same on both sides of a surface.
    bool isGlossy() const
    {
        const bool spreads = diffuse != Vec3(0.0f) || diffuseTransmission != Vec3(0.0f) ||
                             sheen != Vec3(0.0f) || !(reflects() || transmits());
        const float interface = alpha > alphaTangent ? alpha : alphaTangent;
        const float coatAlpha = clearcoat > 0.0f ? clearcoatAlpha : 0.0f;
        const float widest = interface > coatAlpha ? interface : coatAlpha;
        return !spreads && widest < kRoughAlpha && widest >= kSmoothAlpha;
    }
    /// Returns whether light samples and photons find nothing here: mirrors and clear glass.
    bool isMirror() const { return isSmooth() && diffuse == Vec3(0.0f) && !layered; }
};

struct BsdfSample
{
    Vec3 wi;            ///< unit, local
    Vec3 weight;        ///< f |wi.z| / pdfW
    float pdfW = 0.0f;  ///< [1/sr] of all lobes together; for delta lobes their probability
    bool delta = false; ///< true: a mirror-like lobe, which no light sample can find
    bool transmitted = false;
};

struct BsdfValue
{
    Vec3 fCos{0.0f};   ///< f |wi.z|, delta lobes left out
    float pdfW = 0.0f; ///< [1/sr] of sampleBsdf for wi, delta lobes left out
};

/// Holds the mirror-like lobes of a smooth surface, for integrators that follow all of them.
struct SpecularLobes
{
    Vec3 reflection{0.0f};   ///< weight of the mirror direction
    Vec3 coat{0.0f};         ///< weight of what a clear coat with a normal of its own mirrors
    Vec3 coatMirrored{0.0f}; ///< direction of that, local
    Vec3 refraction{0.0f};   ///< weight of the refracted direction; zero on total reflection
    Vec3 refracted{0.0f};    ///< refracted direction, local
};

} // namespace osgRayTrace::engine
