// PixelProjection.h - where points of a scene are in the image, and how much of a plane a pixel
// sees. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/View.h"

namespace osgRayTrace::engine
{

/// Holds a plane: the points p with dot(normal, p) = offset.
struct Plane
{
    Vec3 normal{0.0f}; ///< unit
    float offset = 0.0f;
};

/// Projects points of engine space into the image of CameraRays, of any kind of projection.
/// Immutable; thread safe.
class PixelProjection
{
public:
    PixelProjection() = default;
    explicit PixelProjection(const CameraRays& camera);

    /// Holds the place of a point: x right, y up [pixels], and s of the camera's ray there.
    struct Place
    {
        float x, y, s;
    };

    /// Returns the place of a point. x and y have no meaning unless s is greater than 0.
    Place place(Vec3 point) const;

    /// Returns the area that a pixel covers on a plane, per pixel of image, around a point of the
    /// plane whose s is given.
    float pixelArea(Vec3 point, float s, Vec3 normal) const;

    /// Returns the point of a plane that is seen at (x, y), or nothing if the plane is behind the
    /// view there.
    std::optional<Vec3> onPlane(float x, float y, const Plane& plane) const;

    /// Returns the ray at (x, y): its points are origin + s * direction.
    Vec3 origin(float x, float y) const
    {
        return _camera.origin + x * _camera.originDx + y * _camera.originDy;
    }
    Vec3 direction(float x, float y) const
    {
        return _camera.direction + x * _camera.directionDx + y * _camera.directionDy;
    }
    float nearS() const { return _camera.nearS; }

private:
    CameraRays _camera;
    Vec3 _row[3] = {};         ///< rows of the inverse of (direction, Dx, Dy)
    float _determinant = 0.0f; ///< absolute determinant of (direction, Dx, Dy)
};

} // namespace osgRayTrace::engine
