// SkyPortals.cpp - directions through rectangles, and their densities. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/SkyPortals.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns about the solid angle under which p sees the rectangle; 0 on its outer side.
OSGRAYTRACE_INLINE float weightOf(const RectangleLight& r, PlainVec3 p)
{
    const PlainVec3 centre = mad(r.axisU, 0.5f * r.width, mad(r.axisV, 0.5f * r.height, r.corner));
    const PlainVec3 d = centre - p;
    const float height = dot(d, r.normal);
    const float area = r.width * r.height;
    const float distance2 = dot(d, d) + area;
    return select(height > 0.0f, area * height / (distance2 * std::sqrt(distance2)), 0.0f);
}

/// Returns all bits if a ray crosses the rectangle outwards.
OSGRAYTRACE_INLINE uint32_t crosses(const RectangleLight& r, PlainVec3 p, PlainVec3 wi)
{
    const PlainVec3 d = r.corner - p;
    const float height = dot(d, r.normal), along = dot(wi, r.normal);
    const uint32_t outwards = maskOf(height > 0.0f) & maskOf(along > 0.0f);
    const float t = select(outwards, height / along, 0.0f);
    const float x = t * dot(wi, r.axisU) - dot(d, r.axisU);
    const float y = t * dot(wi, r.axisV) - dot(d, r.axisV);
    return outwards & maskOf(x >= 0.0f) & maskOf(x <= r.width) & maskOf(y >= 0.0f) &
           maskOf(y <= r.height);
}

/// Returns the width of a beam through the rectangle, 0 for one that comes from its inner side.
OSGRAYTRACE_INLINE float widthOf(const RectangleLight& r, PlainVec3 direction)
{
    return r.width * r.height * std::max(dot(direction, r.normal), 0.0f);
}

/// Returns the density of a direction among those that sample one rectangle from p [1/sr].
OSGRAYTRACE_INLINE float densityOf(const RectangleLight& r, PlainVec3 p, PlainVec3 wi)
{
    const SphericalRectangle seen = seenFrom(r, p);
    const float height = dot(r.corner - p, r.normal);
    const float along = dot(wi, r.normal);
    const uint32_t outwards = maskOf(height > 0.0f) & maskOf(along > 0.0f);
    const float t = select(outwards, height / along, 0.0f);
    const float x = t * dot(wi, r.axisU), y = t * dot(wi, r.axisV);
    const uint32_t crosses = outwards & maskOf(x >= seen.x0) & maskOf(x <= seen.x1) &
                             maskOf(y >= seen.y0) & maskOf(y <= seen.y1);
    const float byArea = t * t / (r.width * r.height * along);
    const float density = select(isWide(r, seen), 1.0f / seen.solidAngle, byArea);
    return select(crosses, density, 0.0f);
}

OSGRAYTRACE_KERNEL
void addWeights(const RectangleLight& rectangle, const Vec3Lanes& points, FloatLanes& sums)
{
    const RectangleLight r = rectangle;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        sums[i] += weightOf(r, plainOf(points, i));
}

/// Returns a direction from p, not unit, through the point (u, v) of the rectangle.
OSGRAYTRACE_INLINE PlainVec3 towards(const RectangleLight& r, PlainVec3 p, float u, float v)
{
    const SphericalRectangle seen = seenFrom(r, p);
    float x, y;
    squareToSphericalRectangle(seen, u, v, x, y);
    const uint32_t wide = isWide(r, seen);
    const float atX = select(wide, x, seen.x0 + u * r.width);
    const float atY = select(wide, y, seen.y0 + v * r.height);
    return mad(r.axisU, atX, mad(r.axisV, atY, r.normal * seen.z));
}

/// Sets the direction of lane i if it chooses this rectangle, and takes the weight of the rectangle
/// from left.
OSGRAYTRACE_INLINE void sampleLane(const RectangleLight& r, const Vec3Lanes& points,
                                   const FloatLanes& u, const FloatLanes& v, int i,
                                   FloatLanes& left, Vec3Lanes& wi)
{
    const PlainVec3 p = plainOf(points, i);
    const float weight = weightOf(r, p), before = left[i];
    const uint32_t chosen = maskOf(before >= 0.0f) & maskOf(before < weight);
    left[i] = before - weight;
    const PlainVec3 d = towards(r, p, u[i], v[i]);
    const float length2 = dot(d, d);
    const float inverse = 1.0f / std::sqrt(select(length2 > 0.0f, length2, 1.0f));
    wi.x[i] = select(chosen, d.x * inverse, wi.x[i]);
    wi.y[i] = select(chosen, d.y * inverse, wi.y[i]);
    wi.z[i] = select(chosen, d.z * inverse, wi.z[i]);
}

/// Sets the directions of the lanes that choose this rectangle. left: what is left of the numbers
/// that choose, in units of weights.
OSGRAYTRACE_KERNEL
void sampleOne(const RectangleLight& rectangle, const Vec3Lanes& points, const FloatLanes& u,
               const FloatLanes& v, FloatLanes& left, Vec3Lanes& wi)
{
    const RectangleLight r = rectangle;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        sampleLane(r, points, u, v, i, left, wi);
}

/// Returns the part of a rectangle in the density of a direction [1/sr].
OSGRAYTRACE_INLINE float partOf(const RectangleLight& r, PlainVec3 p, float sum, PlainVec3 wi)
{
    const float share = weightOf(r, p) / select(sum > 0.0f, sum, 1.0f);
    return share * densityOf(r, p, wi);
}

OSGRAYTRACE_KERNEL
void addDensities(const RectangleLight& rectangle, const Vec3Lanes& points, const FloatLanes& sums,
                  const Vec3Lanes& wi, FloatLanes& pdf)
{
    const RectangleLight r = rectangle;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        pdf[i] += partOf(r, plainOf(points, i), sums[i], plainOf(wi, i));
}

} // namespace

SkyPortals::SkyPortals(std::vector<RectangleLight> rectangles, bool lightsSpots,
                       std::vector<PaneSide> panes)
    : _rectangles(std::move(rectangles)), _lightsSpots(lightsSpots), _panes(std::move(panes))
{
}

void SkyPortals::weigh(const Vec3Lanes& points, FloatLanes& sums) const
{
    sums = {};
    for (const RectangleLight& rectangle : _rectangles)
        addWeights(rectangle, points, sums);
}

void SkyPortals::sample(const Vec3Lanes& points, const FloatLanes& sums, const FloatLanes& choice,
                        const FloatLanes& u, const FloatLanes& v, Vec3Lanes& wi) const
{
    FloatLanes left;
    for (int i = 0; i < kLanes; ++i)
        left[i] = choice[i] * sums[i];
    wi = {};
    for (const RectangleLight& rectangle : _rectangles)
        sampleOne(rectangle, points, u, v, left, wi);
}

void SkyPortals::pdfW(const Vec3Lanes& points, const FloatLanes& sums, const Vec3Lanes& wi,
                      FloatLanes& pdf) const
{
    pdf = {};
    for (const RectangleLight& rectangle : _rectangles)
        addDensities(rectangle, points, sums, wi, pdf);
}

SkyPortals::Chance SkyPortals::chanceOf(Vec3 point, Vec3 direction) const
{
    const PlainVec3 p = plainOf(point), wi = plainOf(direction);
    float sum = 0.0f, pdf = 0.0f;
    for (const RectangleLight& rectangle : _rectangles)
    {
        const float weight = weightOf(rectangle, p);
        sum += weight;
        if (weight > 0.0f) pdf += weight * densityOf(rectangle, p, wi);
    }
    return {sum > 0.0f, sum > 0.0f ? pdf / sum : 0.0f};
}

std::optional<Vec3> SkyPortals::sampleBeam(Vec3 direction, float u, float v) const
{
    const PlainVec3 omega = plainOf(direction);
    float sum = 0.0f;
    for (const RectangleLight& r : _rectangles)
        sum += widthOf(r, omega);
    float left = u * sum;
    for (const RectangleLight& r : _rectangles)
    {
        const float width = widthOf(r, omega);
        if (left < width)
        {
            const PlainVec3 p =
                mad(r.axisU, left / width * r.width, mad(r.axisV, v * r.height, r.corner));
            return Vec3(p.x, p.y, p.z);
        }
        left -= width;
    }
    return std::nullopt;
}

float SkyPortals::beamPdfA(Vec3 point, Vec3 direction, float cosine) const
{
    const PlainVec3 p = plainOf(point), omega = plainOf(direction);
    float sum = 0.0f, count = 0.0f;
    for (const RectangleLight& r : _rectangles)
    {
        sum += widthOf(r, omega);
        count += crosses(r, p, omega) ? 1.0f : 0.0f;
    }
    return sum > 0.0f && cosine > 0.0f ? count * cosine / sum : 0.0f;
}

} // namespace osgRayTrace::engine
