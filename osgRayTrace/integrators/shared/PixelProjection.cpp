// PixelProjection.cpp - inverts the linear functions of camera rays. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// A perspective view sees p = origin + s (d + x dx + y dy), an orthographic one p = origin + s d +
// x ox + y oy. Both are linear in (s, s x, s y) or (s, x, y) with the matrix M of three columns.
#include "osgRayTrace/integrators/shared/PixelProjection.h"

#include "osgRayTrace/base/Kernel.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Footprints that are longer than this many roots of their area are left to discs.
constexpr float kLongestFootprint = 4.0f;

OSGRAYTRACE_INLINE float larger(float a, float b)
{
    return select(a > b, a, b);
}

} // namespace

PixelProjection::PixelProjection(const CameraRays& camera) : _camera(camera)
{
    const bool parallel = camera.orthographic;
    const glm::dmat3 columns{Vec3d(camera.direction),
                             Vec3d(parallel ? camera.originDx : camera.directionDx),
                             Vec3d(parallel ? camera.originDy : camera.directionDy)};
    const glm::dmat3 rows = glm::transpose(glm::inverse(columns));
    for (int i = 0; i < 3; ++i)
        _row[i] = Vec3(rows[i]);
    _determinant = static_cast<float>(std::fabs(glm::determinant(columns)));
}

ImageWindow PixelProjection::windowOf(const PixelLanes& pixels, LaneMask lanes) const
{
    ImageWindow window{_camera.origin, _row[0],   _row[1],    _row[2],   _camera.orthographic,
                       kInfinity,      kInfinity, -kInfinity, -kInfinity};
    for (const int i : lanesIn(lanes))
    {
        window.left = std::min(window.left, pixels.x[i]);
        window.bottom = std::min(window.bottom, pixels.y[i]);
        window.right = std::max(window.right, pixels.x[i] + 1.0f);
        window.top = std::max(window.top, pixels.y[i] + 1.0f);
    }
    return window;
}

namespace
{

/// Camera rays as loops over lanes take them.
struct PlainRays
{
    PlainVec3 origin, originDx, originDy, direction, directionDx, directionDy;
};

/// The point of a plane that is seen at a place of the image.
struct SeenPoint
{
    PlainVec3 point;
    float s;
};

OSGRAYTRACE_INLINE SeenPoint pointOnPlane(PlainRays c, float x, float y, PlainVec3 normal,
                                          float offset)
{
    const PlainVec3 o = mad(c.originDy, y, mad(c.originDx, x, c.origin));
    const PlainVec3 d = mad(c.directionDy, y, mad(c.directionDx, x, c.direction));
    const float s = (offset - dot(normal, o)) / dot(normal, d);
    return {mad(d, s, o), s};
}

OSGRAYTRACE_INLINE uint32_t isInFront(float s)
{
    return maskOf(s > 0.0f) & maskOf(s < kInfinity);
}

OSGRAYTRACE_INLINE float distance2(PlainVec3 a, PlainVec3 b)
{
    return dot(a - b, a - b);
}

OSGRAYTRACE_INLINE void setFootprint(PlainRays rays, float determinant, uint32_t parallel, float x,
                                     float y, PlainVec3 normal, float offset, int i,
                                     FootprintLanes& footprints)
{
    const SeenPoint centre = pointOnPlane(rays, x + 0.5f, y + 0.5f, normal, offset);
    const SeenPoint a = pointOnPlane(rays, x, y, normal, offset);
    const SeenPoint b = pointOnPlane(rays, x + 1.0f, y, normal, offset);
    const SeenPoint c = pointOnPlane(rays, x, y + 1.0f, normal, offset);
    const SeenPoint d = pointOnPlane(rays, x + 1.0f, y + 1.0f, normal, offset);
    const float ab = larger(distance2(a.point, centre.point), distance2(b.point, centre.point));
    const float cd = larger(distance2(c.point, centre.point), distance2(d.point, centre.point));
    const float radius2 = larger(ab, cd), s = centre.s;
    const float along =
        select(parallel, dot(normal, rays.direction), dot(normal, centre.point - rays.origin));
    const float area = select(parallel, 1.0f, s * s * s) * determinant / std::fabs(along);
    const uint32_t in = isInFront(s) & isInFront(a.s) & isInFront(b.s) & isInFront(c.s) &
                        isInFront(d.s) &
                        maskOf(radius2 < kLongestFootprint * kLongestFootprint * area);
    footprints.radius[i] = select(in, std::sqrt(radius2) * (1.0f + 0x1p-10f), 0.0f);
    footprints.area[i] = area;
    setLane(footprints.centre, i, centre.point);
}

OSGRAYTRACE_KERNEL
void footprintsOn(const PlainRays& camera, float determinant, uint32_t parallel,
                  const PixelLanes& pixels, const PlaneLanes& planes, FootprintLanes& footprints)
{
    const PlainRays rays = camera;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        setFootprint(rays, determinant, parallel, pixels.x[i], pixels.y[i],
                     plainOf(planes.normal, i), planes.offset[i], i, footprints);
}

} // namespace

void PixelProjection::footprints(const PixelLanes& pixels, const PlaneLanes& planes,
                                 FootprintLanes& footprints) const
{
    const PlainRays rays{plainOf(_camera.origin),      plainOf(_camera.originDx),
                         plainOf(_camera.originDy),    plainOf(_camera.direction),
                         plainOf(_camera.directionDx), plainOf(_camera.directionDy)};
    footprintsOn(rays, _determinant, maskOf(_camera.orthographic), pixels, planes, footprints);
}

} // namespace osgRayTrace::engine
