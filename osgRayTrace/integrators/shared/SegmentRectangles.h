// SegmentRectangles.h - points of stretches with points of a rectangle that shines on them. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/LightLanes.h"
#include "osgRayTrace/media/Equiangular.h"
#include "osgRayTrace/shading/RectangleLight.h"

namespace osgRayTrace::engine
{

/// Stretches of the rays of a block, with random numbers in [0,1) and the points that they choose.
struct StretchLanes
{
    FloatLanes begin{}, end{};
    FloatLanes along{};    ///< number of the point of the stretch
    FloatLanes u{}, v{};   ///< numbers of the point of the rectangle
    FloatLanes t{}, pdf{}; ///< the stretch's point and its density [1/length]
};

/// A rectangle that shines.
struct ShiningRectangle
{
    RectangleLight shape;
    float offset;      ///< error bound of its points
    uint32_t twoSided; ///< all bits or none
    float inversePmf;  ///< of its choice
    PlainVec3 radiance;
};

/// Sets lane i's point of the stretch, and its sample of the rectangle by solid angle from there.
/// Rays that meet the rectangle would otherwise have a sum of 1 / r over its points, whose variance
/// has no bound. Returns all bits if the rectangle can light the point.
OSGRAYTRACE_INLINE uint32_t rectangleLane(const ShiningRectangle& light, const RayBlock& ray, int i,
                                          StretchLanes& stretches, LightLanes& samples)
{
    const RectangleLight& r = light.shape;
    const PlainVec3 origin = plainOrigin(ray, i), direction = plainDirection(ray, i);
    const PlainVec3 centre = mad(r.axisU, 0.5f * r.width, mad(r.axisV, 0.5f * r.height, r.corner));
    const float area = r.width * r.height;
    const Equiangular stretch(origin, direction, stretches.begin[i], stretches.end[i], centre,
                              0.5f * std::sqrt(area));
    const EquiangularSample place = stretch.sample(stretches.along[i]);
    stretches.t[i] = place.t;
    stretches.pdf[i] = place.pdf;

    const PlainVec3 p = mad(direction, place.t, origin);
    const SphericalRectangle seen = seenFrom(r, p);
    const float u = stretches.u[i], v = stretches.v[i];
    float x, y;
    squareToSphericalRectangle(seen, u, v, x, y);
    const uint32_t wide = isWide(r, seen);
    const float alongU = select(wide, x - seen.x0, u * r.width);
    const float alongV = select(wide, y - seen.y0, v * r.height);
    const PlainVec3 way = mad(r.axisU, alongU, mad(r.axisV, alongV, r.corner)) - p;
    const float distance = std::sqrt(dot(way, way));
    const float perDistance = 1.0f / distance;
    const PlainVec3 wi = way * perDistance;
    const float cosine = -dot(wi, r.normal);
    const float cosThetaL = select(light.twoSided, std::fabs(cosine), cosine);
    const float byArea = cosThetaL * area * perDistance * perDistance;
    const float weight = select(wide, seen.solidAngle, byArea) * light.inversePmf;

    setLane(samples.wi, i, wi);
    samples.radiance[0][i] = light.radiance.x;
    samples.radiance[1][i] = light.radiance.y;
    samples.radiance[2][i] = light.radiance.z;
    samples.weight[i] = weight;
    const float end = distance - light.offset / cosThetaL;
    setRay(samples.shadow, i, p, wi, 0.0f, select(end > 0.0f, end, 0.0f));
    return maskOf(place.pdf > 0.0f) & maskOf(place.pdf < kInfinity) & maskOf(distance > 0.0f) &
           maskOf(cosThetaL > 0.0f) & maskOf(byArea * light.inversePmf < 1e30f);
}

/// Does the same for all lanes. Returns those that the rectangle can light.
LaneMask rectangleLanes(const ShiningRectangle& light, const RayBlock& ray, StretchLanes& stretches,
                        LightLanes& samples);

} // namespace osgRayTrace::engine
