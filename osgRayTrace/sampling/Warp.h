// Warp.h - maps of the unit square to directions, each with its density. Layer: sampling.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"

#include <cmath>

namespace osgRayTrace::engine
{

/// Sets sine and cosine of 2*pi*turn for turn in [0,1], with an absolute error below 2e-7. The code
/// has no calls and no tables, so that loops over lanes vectorize.
OSGRAYTRACE_INLINE void sinCosTurn(float turn, float& sine, float& cosine)
{
    // The angle is reduced to [-1/8, 1/8] of a turn around the nearest quarter; Taylor series
    // follow.
    const int quarter = static_cast<int>(turn * 4.0f + 0.5f);
    const float x = (turn - 0.25f * static_cast<float>(quarter)) * (2.0f * kPi);
    const float x2 = x * x;
    const float s =
        x *
        (1.0f + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 * (1.0f / 362880)))));
    const float c =
        1.0f + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
    const bool swapped = (quarter & 1) != 0;
    const float swappedSine = select(swapped, c, s), swappedCosine = select(swapped, s, c);
    sine = select((quarter & 2) != 0, -swappedSine, swappedSine);
    cosine = select(((quarter + 1) & 2) != 0, -swappedCosine, swappedCosine);
}

/// Returns a cosine-distributed direction around +z: pdfW = cosTheta / pi.
OSGRAYTRACE_INLINE PlainVec3 squareToCosineHemispherePlain(float u, float v)
{
    float sine, cosine;
    sinCosTurn(u, sine, cosine);
    const float radius = std::sqrt(v);
    const float height2 = 1.0f - v;
    return {radius * cosine, radius * sine, std::sqrt(select(height2 > 0.0f, height2, 0.0f))};
}

OSGRAYTRACE_INLINE Vec3 squareToCosineHemisphere(float u, float v)
{
    const PlainVec3 w = squareToCosineHemispherePlain(u, v);
    return Vec3(w.x, w.y, w.z);
}

inline float squareToCosineHemispherePdf(float cosTheta)
{
    return std::max(cosTheta, 0.0f) * kInvPi;
}

/// Returns a direction, uniform in the cone of directions whose 1 - cosine is below oneMinusCosine
/// around +z: pdfW = 1 / (2 pi oneMinusCosine).
inline Vec3 squareToCone(Vec2 u, float oneMinusCosine)
{
    const float height = u.y * oneMinusCosine;
    const float z = 1.0f - height;
    const float radius = std::sqrt(std::max(0.0f, height * (1.0f + z)));
    float sine, cosine;
    sinCosTurn(u.x, sine, cosine);
    return Vec3(radius * cosine, radius * sine, z);
}

/// A right-handed frame of unit vectors.
struct PlainFrame
{
    PlainVec3 tangent, bitangent, normal;
};

/// The frame around a unit normal [Duff17, listing 3].
OSGRAYTRACE_INLINE PlainFrame frameOf(PlainVec3 n)
{
    const float sign = select(n.z >= 0.0f, 1.0f, -1.0f);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {
        {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

OSGRAYTRACE_INLINE PlainVec3 toWorld(const PlainFrame& frame, PlainVec3 local)
{
    const PlainVec3 &t = frame.tangent, &b = frame.bitangent, &n = frame.normal;
    return {t.x * local.x + b.x * local.y + n.x * local.z,
            t.y * local.x + b.y * local.y + n.y * local.z,
            t.z * local.x + b.z * local.y + n.z * local.z};
}

/// Sets two unit vectors that make a right-handed frame with the unit normal n [Duff17, listing 3].
OSGRAYTRACE_INLINE void frameOf(float nx, float ny, float nz, Vec3& tangent, Vec3& bitangent)
{
    const PlainFrame frame = frameOf(PlainVec3{nx, ny, nz});
    tangent = Vec3(frame.tangent.x, frame.tangent.y, frame.tangent.z);
    bitangent = Vec3(frame.bitangent.x, frame.bitangent.y, frame.bitangent.z);
}

/// Returns a direction around +z turned to the unit vector axis.
inline Vec3 turnedTo(Vec3 axis, Vec3 direction)
{
    Vec3 tangent, bitangent;
    frameOf(axis.x, axis.y, axis.z, tangent, bitangent);
    return tangent * direction.x + bitangent * direction.y + axis * direction.z;
}

} // namespace osgRayTrace::engine
