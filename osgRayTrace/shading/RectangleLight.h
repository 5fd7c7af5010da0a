// RectangleLight.h - rectangles that shine, sampled by solid angle from near by. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/sampling/SphericalRectangle.h"

namespace osgRayTrace::engine
{

/// Rectangles of more than this solid angle are sampled uniformly by solid angle [sr]. Smaller ones
/// are sampled by area: there is no gain, and rounding would be a part of so small an angle.
constexpr float kWideAngle = 0.05f;

/// Returns whether a parallelogram with these edges is a rectangle, but for rounding.
inline bool isRectangle(Vec3 edgeU, Vec3 edgeV)
{
    const Vec3d u(edgeU), v(edgeV);
    return std::fabs(glm::dot(u, v)) <= 1e-6 * glm::length(u) * glm::length(v);
}

struct RectangleLight
{
    PlainVec3 corner;
    PlainVec3 axisU, axisV, normal; ///< unit
    float width, height;            ///< along axisU and axisV
};

OSGRAYTRACE_INLINE RectangleLight rectangleLight(PlainVec3 corner, PlainVec3 edgeU, PlainVec3 edgeV)
{
    RectangleLight r;
    r.corner = corner;
    r.width = std::sqrt(dot(edgeU, edgeU));
    r.height = std::sqrt(dot(edgeV, edgeV));
    r.axisU = edgeU * (1.0f / r.width);
    r.axisV = edgeV * (1.0f / r.height);
    r.normal = cross(r.axisU, r.axisV);
    return r;
}

/// Returns all bits if the solid angle may be wide, as seen from p: bounds it by the area over the
/// square of the least distance from a sphere around the rectangle.
OSGRAYTRACE_INLINE uint32_t mayBeWide(const RectangleLight& r, PlainVec3 p)
{
    const float halfWidth = 0.5f * r.width, halfHeight = 0.5f * r.height;
    const PlainVec3 centre = mad(r.axisU, halfWidth, mad(r.axisV, halfHeight, r.corner));
    const PlainVec3 d = p - centre;
    const float radius = std::sqrt(halfWidth * halfWidth + halfHeight * halfHeight);
    const float clear = std::sqrt(dot(d, d)) - radius;
    const float least = select(clear > 0.0f, clear, 0.0f);
    return maskOf(r.width * r.height > kWideAngle * (least * least));
}

OSGRAYTRACE_INLINE SphericalRectangle seenFrom(const RectangleLight& r, PlainVec3 p)
{
    const PlainVec3 d = r.corner - p;
    return sphericalRectangle(dot(d, r.axisU), dot(d, r.axisV), r.width, r.height,
                              dot(d, r.normal));
}

/// Returns all bits if samples are uniform by solid angle: if that is wide, and the rectangle's
/// plane is well beyond the error bounds of points near it. Shadow rays begin and end that far off,
/// and could not follow the directions of a closer rectangle, whose light rays find by chance
/// alone.
OSGRAYTRACE_INLINE uint32_t isWide(const RectangleLight& r, const SphericalRectangle& seen)
{
    constexpr float kClear = 0x1p-15f; // 16 times the error bound of points on the light
    const float extent =
        std::fabs(r.corner.x) + std::fabs(r.corner.y) + std::fabs(r.corner.z) + r.width + r.height;
    return maskOf(seen.solidAngle > kWideAngle) & maskOf(seen.z > kClear * extent);
}

/// Returns the solid angle over which samples are uniform from p [sr]; 0: they are so by area.
inline float sampledAngle(const RectangleLight& r, PlainVec3 p)
{
    if (!mayBeWide(r, p)) return 0.0f;
    const SphericalRectangle seen = seenFrom(r, p);
    return isWide(r, seen) ? seen.solidAngle : 0.0f;
}

} // namespace osgRayTrace::engine
