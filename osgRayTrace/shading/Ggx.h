// Ggx.h - the GGX microfacet distribution in a frame with the normal at +z. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/sampling/Warp.h"

#include <cmath>

namespace osgRayTrace::engine
{

/// Below this width a surface is treated as perfectly smooth.
constexpr float kSmoothAlpha = 1e-3f;

/// Returns the density of microfacet normals [1/sr] [Walter07, eq. 33], computed from the
/// tangential part of h, which keeps its digits near the peak.
inline float evalGgx(Vec3 h, float alpha)
{
    const float tangential2 = h.x * h.x + h.y * h.y;
    const float a2 = alpha * alpha;
    const float d = tangential2 + a2 * h.z * h.z;
    return a2 / (kPi * d * d);
}

/// Returns Smith's Lambda [Heitz14, eq. 72].
inline float ggxLambda(Vec3 w, float alpha)
{
    const float cos2 = w.z * w.z;
    const float sin2 = w.x * w.x + w.y * w.y;
    if (cos2 <= 0.0f) return std::numeric_limits<float>::max();
    return 0.5f * (std::sqrt(1.0f + alpha * alpha * sin2 / cos2) - 1.0f);
}

/// Returns the masking of one direction [Heitz14, eq. 43].
inline float ggxG1(Vec3 w, float alpha)
{
    return 1.0f / (1.0f + ggxLambda(w, alpha));
}

/// Returns the height-correlated masking and shadowing of two directions on the same side [Heitz14,
/// eq. 99].
inline float ggxG2(Vec3 wo, Vec3 wi, float alpha)
{
    return 1.0f / (1.0f + ggxLambda(wo, alpha) + ggxLambda(wi, alpha));
}

/// Returns a microfacet normal visible from wo (wo.z > 0), by spherical caps [Dupuy23, listing 3].
inline Vec3 sampleGgxVisible(Vec3 wo, float alpha, float u, float v)
{
    const Vec3 stretched = glm::normalize(Vec3(alpha * wo.x, alpha * wo.y, wo.z));
    float sine, cosine;
    sinCosTurn(u, sine, cosine);
    const float z = (1.0f - v) * (1.0f + stretched.z) - stretched.z;
    const float radius = std::sqrt(std::fmin(std::fmax(1.0f - z * z, 0.0f), 1.0f));
    const Vec3 cap(radius * cosine, radius * sine, z);
    const Vec3 h = cap + stretched;
    const Vec3 normal(alpha * h.x, alpha * h.y, std::fmax(h.z, 1e-30f));
    return glm::normalize(normal);
}

/// Returns the density of sampleGgxVisible [1/sr] [Heitz18, eq. 3].
inline float pdfGgxVisible(Vec3 wo, Vec3 h, float alpha)
{
    return ggxG1(wo, alpha) * std::fmax(glm::dot(wo, h), 0.0f) * evalGgx(h, alpha) / wo.z;
}

/// Holds the GGX widths along x and y. Where both are equal, the functions are those of one width.
struct GgxWidths
{
    float x, y;
    bool isRound() const { return x == y; }
};

/// Returns the density of microfacet normals [1/sr] [Heitz18, eq. 1].
inline float evalGgx(Vec3 h, GgxWidths alpha)
{
    if (alpha.isRound()) return evalGgx(h, alpha.x);
    const float x = h.x / alpha.x, y = h.y / alpha.y;
    const float d = x * x + y * y + h.z * h.z;
    return 1.0f / (kPi * alpha.x * alpha.y * d * d);
}

/// Returns Smith's Lambda [Heitz18, eq. 2].
inline float ggxLambda(Vec3 w, GgxWidths alpha)
{
    if (alpha.isRound()) return ggxLambda(w, alpha.x);
    const float cos2 = w.z * w.z, x = alpha.x * w.x, y = alpha.y * w.y;
    if (cos2 <= 0.0f) return std::numeric_limits<float>::max();
    return 0.5f * (std::sqrt(1.0f + (x * x + y * y) / cos2) - 1.0f);
}

inline float ggxG1(Vec3 w, GgxWidths alpha)
{
    return 1.0f / (1.0f + ggxLambda(w, alpha));
}

inline float ggxG2(Vec3 wo, Vec3 wi, GgxWidths alpha)
{
    return 1.0f / (1.0f + ggxLambda(wo, alpha) + ggxLambda(wi, alpha));
}

/// Returns a microfacet normal visible from wo (wo.z > 0): spherical caps [Dupuy23, listing 3] in
/// the space in which the distribution is a sphere [Heitz18, sect. 3].
inline Vec3 sampleGgxVisible(Vec3 wo, GgxWidths alpha, float u, float v)
{
    if (alpha.isRound()) return sampleGgxVisible(wo, alpha.x, u, v);
    const Vec3 round =
        sampleGgxVisible(glm::normalize(Vec3(alpha.x * wo.x, alpha.y * wo.y, wo.z)), 1.0f, u, v);
    return glm::normalize(Vec3(alpha.x * round.x, alpha.y * round.y, round.z));
}

} // namespace osgRayTrace::engine
