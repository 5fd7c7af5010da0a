// SphericalRectangle.h - directions towards a rectangle, uniform in solid angle. Layer: sampling.
// SPDX-License-Identifier: MIT
//
// A rectangle whose corners are (x0, y0, z), (x1, y0, z), (x1, y1, z) and (x0, y1, z) as seen from
// the origin, z > 0, is bounded on the unit sphere by four great circles. Its solid angle is the
// sum of its inner angles less 2 pi [Urena13, eq. 3]. An inner angle has the cosine y0 x1 / (a b),
// with a = |(y0, z)| and b = |(x1, z)|, or the same of other corners. As a^2 b^2 - (y0 x1)^2 is
// z^2 (x1^2 + y0^2 + z^2), its tangent is z |(x1, y0, z)| / (y0 x1): unlike the arc cosine of
// [Urena13] it loses no digits near the plane of the rectangle.
#pragma once

#include "osgRayTrace/sampling/Warp.h"

namespace osgRayTrace::engine
{

/// Returns the angle in [0, pi] whose tangent is y / x, y >= 0, with a relative error below 2e-7.
/// The code has no calls, so that loops over lanes vectorize.
OSGRAYTRACE_INLINE float upperAngle(float y, float x)
{
    constexpr float kTanEighth = 0.41421356f; // tangent of an eighth of pi
    const float ax = std::fabs(x);
    const uint32_t steep = maskOf(y > ax);
    const float low = select(steep, ax, y), high = select(steep, y, ax);
    const float ratio = low / select(high > 1e-37f, high, 1e-37f);
    // The angle is reduced to less than an eighth of pi. The polynomial interpolates the arc
    // tangent at the Chebyshev points of this range.
    const uint32_t wide = maskOf(ratio > kTanEighth);
    const float t = select(wide, (ratio - 1.0f) / (ratio + 1.0f), ratio);
    const float t2 = t * t;
    const float p = -0.33333287f + t2 * (0.19991238f + t2 * (-0.14024143f + t2 * 0.085204920f));
    const float reduced = t + t * t2 * p;
    const float acute = select(wide, reduced + 0.25f * kPi, reduced);
    const float quadrant = select(steep, 0.5f * kPi - acute, acute);
    return select(x < 0.0f, kPi - quadrant, quadrant);
}

/// A rectangle as seen from a point, in the coordinates of the head of this file.
struct SphericalRectangle
{
    float x0, x1, y0, y1, z;
    float across;     ///< the sum of the inner angles at x1
    float solidAngle; ///< [sr]; its error is some 1e-6 sr
};

/// Returns the rectangle from (x0, y0) to (x0 + width, y0 + height) at distance z, which may be
/// negative: both sides look alike.
OSGRAYTRACE_INLINE SphericalRectangle sphericalRectangle(float x0, float y0, float width,
                                                         float height, float z)
{
    SphericalRectangle r;
    r.x0 = x0;
    r.x1 = x0 + width;
    r.y0 = y0;
    r.y1 = y0 + height;
    r.z = std::fabs(z);
    const float z2 = z * z;
    const float xx0 = r.x0 * r.x0, xx1 = r.x1 * r.x1;
    const float yy0 = r.y0 * r.y0 + z2, yy1 = r.y1 * r.y1 + z2;
    const float g0 = upperAngle(r.z * std::sqrt(xx1 + yy0), r.y0 * r.x1);
    const float g1 = upperAngle(r.z * std::sqrt(xx1 + yy1), -r.y1 * r.x1);
    const float g2 = upperAngle(r.z * std::sqrt(xx0 + yy1), r.y1 * r.x0);
    const float g3 = upperAngle(r.z * std::sqrt(xx0 + yy0), -r.y0 * r.x0);
    r.across = g0 + g1;
    r.solidAngle = (g0 + g1) - (2.0f * kPi - g2 - g3);
    return r;
}

/// Sets the coordinates (x, y) of a point of the rectangle, such that directions to it are uniform
/// in solid angle, and neighbours in (u, v) are neighbours on the rectangle [Urena13, sect. 4].
/// pdfW = 1 / solidAngle.
OSGRAYTRACE_INLINE void squareToSphericalRectangle(const SphericalRectangle& r, float u, float v,
                                                   float& x, float& y)
{
    // The part of the rectangle left of x has the share u of the solid angle.
    // Lanes without a point have no numbers, which cannot become a quadrant.
    const float part = r.across - (1.0f - u) * r.solidAngle;
    const float angle = select(part > 0.0f, part, 0.0f);
    float sine, cosine;
    sinCosTurn(angle * (0.5f * kInvPi), sine, cosine);
    const float perY0 = 1.0f / std::sqrt(r.y0 * r.y0 + r.z * r.z);
    const float b0 = -r.y0 * perY0, b1 = r.y1 / std::sqrt(r.y1 * r.y1 + r.z * r.z);
    // x = z c / sqrt(1 - c^2) for c = sine / sqrt(n^2 + b0^2 sine^2), with the sign of n.
    const float n = cosine * b0 - b1;
    const float zShare = r.z * perY0;
    const float rest = n * n - sine * sine * (zShare * zShare);
    const float far = r.z * sine / std::sqrt(select(rest > 1e-30f, rest, 1e-30f));
    const float signedX = select(n < 0.0f, -far, far);
    const float above = select(signedX > r.x0, signedX, r.x0);
    x = select(above < r.x1, above, r.x1);

    const float d2 = x * x + r.z * r.z;
    const float h0 = r.y0 / std::sqrt(d2 + r.y0 * r.y0), h1 = r.y1 / std::sqrt(d2 + r.y1 * r.y1);
    const float h = h0 + v * (h1 - h0);
    const float left = (1.0f - h) * (1.0f + h);
    const float along = h * std::sqrt(d2 / select(left > 1e-12f, left, 1e-12f));
    const float higher = select(along > r.y0, along, r.y0);
    y = select(higher < r.y1, higher, r.y1);
}

} // namespace osgRayTrace::engine
