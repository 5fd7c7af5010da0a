// PixelProjection.cpp - inverts the linear functions of camera rays. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// A perspective view sees p = origin + s (d + x dx + y dy), an orthographic one p = origin + s d +
// x ox + y oy. Both are linear in (s, s x, s y) or (s, x, y) with the matrix M of three columns.
#include "osgRayTrace/integrators/shared/PixelProjection.h"

#include <cmath>

namespace osgRayTrace::engine
{

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

PixelProjection::Place PixelProjection::place(Vec3 point) const
{
    const Vec3 way = point - _camera.origin;
    const float s = glm::dot(_row[0], way);
    const float scale = _camera.orthographic ? 1.0f : 1.0f / s;
    return {glm::dot(_row[1], way) * scale, glm::dot(_row[2], way) * scale, s};
}

float PixelProjection::pixelArea(Vec3 point, float s, Vec3 normal) const
{
    // The volume det M ds dx dy (times s^2 if rays diverge) over the height of ds above the plane.
    if (_camera.orthographic) return _determinant / std::fabs(glm::dot(normal, _camera.direction));
    return s * s * s * _determinant / std::fabs(glm::dot(normal, point - _camera.origin));
}

std::optional<Vec3> PixelProjection::onPlane(float x, float y, const Plane& plane) const
{
    const Vec3 o = origin(x, y), d = direction(x, y);
    const float s = (plane.offset - glm::dot(plane.normal, o)) / glm::dot(plane.normal, d);
    if (!(s > 0.0f) || !std::isfinite(s)) return std::nullopt;
    return o + s * d;
}

} // namespace osgRayTrace::engine
