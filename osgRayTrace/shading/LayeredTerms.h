// LayeredTerms.h - what the layers of a surface reflect and leave. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/BsdfTerms.h"
#include "osgRayTrace/shading/Fresnel.h"
#include "osgRayTrace/shading/Sheen.h"
#include "osgRayTrace/shading/ThinFilm.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

constexpr float kClearcoatIndex = 1.5f;

inline float largestOf(Vec3 v)
{
    return std::max(v.x, std::max(v.y, v.z));
}

inline bool hasSheen(const Bsdf& b)
{
    return b.sheen != Vec3(0.0f) && !b.inside;
}

inline bool hasClearcoat(const Bsdf& b)
{
    return b.clearcoat > 0.0f && !b.inside;
}

/// Returns a direction in the frame of the facets, whose x axis is the tangent.
inline Vec3 toFacets(const Bsdf& b, Vec3 w)
{
    if (!b.isAnisotropic()) return w;
    const Vec2 t = b.tangent;
    return {w.x * t.x + w.y * t.y, w.y * t.x - w.x * t.y, w.z};
}

/// Returns the cosine of a direction to the normal of the clear coat, both on the side of wo; 0 if
/// the coat turns away from the direction. w: in the frame of the facets, on either side. Few coats
/// are tilted, and what they need is not inlined.
float tiltedCoatCosine(const Bsdf& b, Vec3 w);
inline float coatCosine(const Bsdf& b, Vec3 w)
{
    return b.coatTilted ? tiltedCoatCosine(b, w) : std::fabs(w.z);
}

inline bool isClearcoatSmooth(const Bsdf& b)
{
    return b.clearcoatAlpha < kSmoothAlpha;
}

/// Returns what the sheen leaves to the layers below it: Ss.
inline float belowSheen(const Bsdf& b, float cosTheta)
{
    if (b.sheen == Vec3(0.0f)) return 1.0f;
    return std::max(0.0f, 1.0f - largestOf(b.sheen) * sheenAlbedo(b.sheenAlpha, cosTheta));
}

inline float clearcoatAlbedo(const Bsdf& b, float cosTheta)
{
    if (!b.clearcoatRows) return fresnelDielectric(cosTheta, kClearcoatIndex);
    const float first = b.clearcoatRows[0](cosTheta), second = b.clearcoatRows[1](cosTheta);
    return first + (second - first) * b.clearcoatFraction;
}

/// Returns what sheen and clear coat leave: S, for a direction outside of the body or its opposite.
inline float belowLayers(const Bsdf& b, Vec3 w)
{
    const float below = belowSheen(b, std::fabs(w.z));
    return b.clearcoat > 0.0f ? below * (1.0f - b.clearcoat * clearcoatAlbedo(b, coatCosine(b, w)))
                              : below;
}

/// Returns F' of one face whose reflectance is F.
inline Vec3 tinted(const Bsdf& b, float fresnel)
{
    const float root = (b.eta - 1.0f) / (b.eta + 1.0f), normal = root * root;
    const float share = (fresnel - normal) / (1.0f - normal);
    const Vec3 raised = b.normalReflectance + (Vec3(1.0f) - b.normalReflectance) * share;
    return b.specular * glm::clamp(raised, 0.0f, 1.0f);
}

/// Returns the reflectance of the wall with faces of a reflectance; of one face for solid bodies.
inline Vec3 ofWall(const Bsdf& b, Vec3 face)
{
    return b.thin ? 2.0f * face / (Vec3(1.0f) + face) : face;
}

/// Returns F' of a face with a film. Within a body the film is on the other side, where the light
/// arrives under the refracted angle.
inline Vec3 withFilm(const Bsdf& b, float cosTheta, Vec3 face)
{
    float outside = cosTheta;
    if (b.inside)
    {
        const float sine2 = (1.0f - cosTheta * cosTheta) / (b.eta * b.eta);
        if (sine2 >= 1.0f) return face;
        outside = std::sqrt(1.0f - sine2);
    }
    const Vec3 film =
        filmReflectance(outside, {b.filmIor, b.filmThickness}, b.specular * b.normalReflectance);
    return face + (film - face) * b.film;
}

/// Returns the reflectance of the dielectric interface for one cosine: F'.
inline Vec3 interfaceFresnel(const Bsdf& b, float cosTheta)
{
    if (b.coat == 0.0f) return Vec3(0.0f);
    const Vec3 face = tinted(b, fresnelDielectric(cosTheta, b.eta));
    return ofWall(b, b.film > 0.0f ? withFilm(b, cosTheta, face) : face);
}

/// Returns the reflectance of the metal, times its share.
inline Vec3 metalFresnel(const Bsdf& b, float cosTheta)
{
    const Vec3 metal = fresnelSchlick(cosTheta, b.reflectance, b.grazing);
    if (b.film == 0.0f || b.grazing == 0.0f) return metal;
    const Vec3 film =
        filmReflectance(cosTheta, {b.filmIor, b.filmThickness}, b.reflectance / b.grazing);
    return metal + (film * b.grazing - metal) * b.film;
}

inline Vec3 reflectionFresnel(const Bsdf& b, float cosTheta)
{
    return metalFresnel(b, cosTheta) + b.coat * interfaceFresnel(b, cosTheta);
}

/// Returns whether the surface is a film over a body of the index of air, which reflects by the
/// film alone. The reference of filmRise, and the albedo of coatRows, are then those of the film's
/// index.
inline bool isFilmOnAir(const Bsdf& b)
{
    return b.film > 0.0f && b.eta == 1.0f;
}

/// Returns what the interface leaves to the base: 1 - E'. F' is affine in F, so a rough interface
/// reflects F' of its albedo or, if R is less than F0, at most specular times its albedo. A film
/// raises that by filmRise at most.
inline float belowInterface(const Bsdf& b, float cosTheta)
{
    if (b.coat == 0.0f) return 1.0f;
    if (!b.coatRows) return 1.0f - largestOf(interfaceFresnel(b, cosTheta));
    const float first = b.coatRows[0](cosTheta), second = b.coatRows[1](cosTheta);
    const float albedo = first + (second - first) * b.coatFraction;
    Vec3 most =
        isFilmOnAir(b) ? Vec3(albedo) : glm::max(tinted(b, albedo), Vec3(b.specular * albedo));
    if (b.film > 0.0f) most += b.filmRise * (Vec3(1.0f) - most);
    return 1.0f - largestOf(ofWall(b, most));
}

/// Returns what reaches the base from a direction on the side of wo, or leaves it on the other
/// side: A.
inline float aboveBase(const Bsdf& b, Vec3 w)
{
    return belowInterface(b, std::fabs(w.z)) * (b.inside ? 1.0f : belowLayers(b, w));
}

/// Returns the factor of what passes between wo and a direction on the other side.
inline float passedLayers(const Bsdf& b, Vec3 wo, Vec3 wi)
{
    if (b.thin) return std::min(belowLayers(b, wo), belowLayers(b, wi));
    return belowLayers(b, b.inside ? wi : wo);
}

} // namespace osgRayTrace::engine
