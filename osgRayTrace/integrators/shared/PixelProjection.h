// PixelProjection.h - where points of a scene are in the image, and how much of a plane a pixel
// sees. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/photons/Photon.h"
#include "osgRayTrace/scene/View.h"

#include <cmath>

namespace osgRayTrace::engine
{

/// Holds a plane: the points p with dot(normal, p) = offset.
struct Plane
{
    Vec3 normal{0.0f}; ///< unit
    float offset = 0.0f;
};

/// Returns the distance of a point from a plane, on the side of its normal.
inline float heightAbove(const Plane& plane, Vec3 point)
{
    return glm::dot(plane.normal, point) - plane.offset;
}

/// Planes of sixteen lanes.
struct PlaneLanes
{
    Vec3Lanes normal;
    FloatLanes offset;
};

/// The corners of pixels with the least x and y: their places in the image.
struct PixelLanes
{
    FloatLanes x, y;
};

/// The parts of planes that pixels see, each within a disc.
struct FootprintLanes
{
    Vec3Lanes centre;
    FloatLanes radius; ///< 0: the plane is behind the view, or seen too obliquely
    FloatLanes area;
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
    Place place(Vec3 point) const
    {
        const Vec3 way = point - _camera.origin;
        const float s = glm::dot(_row[0], way);
        const float scale = _camera.orthographic ? 1.0f : 1.0f / s;
        return {glm::dot(_row[1], way) * scale, glm::dot(_row[2], way) * scale, s};
    }

    /// Returns the area that a pixel covers on a plane, per pixel of image, around a point of the
    /// plane whose s is given.
    float pixelArea(Vec3 point, float s, Vec3 normal) const
    {
        // The volume det M ds dx dy (times s^2 if rays diverge) over the height of ds above the
        // plane.
        if (_camera.orthographic)
            return _determinant / std::fabs(glm::dot(normal, _camera.direction));
        return s * s * s * _determinant / std::fabs(glm::dot(normal, point - _camera.origin));
    }

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

    /// Sets footprints to those of some pixels on planes, lane by lane. pixels: the corners with
    /// the least x and y. Lanes may have any values: what comes of them means nothing then.
    void footprints(const PixelLanes& pixels, const PlaneLanes& planes,
                    FootprintLanes& footprints) const;

    /// Returns the window of the image from the pixel with the least x and y of some lanes to that
    /// with the largest.
    ImageWindow windowOf(const PixelLanes& pixels, LaneMask lanes) const;

private:
    CameraRays _camera;
    Vec3 _row[3] = {};         ///< rows of the inverse of (direction, Dx, Dy)
    float _determinant = 0.0f; ///< absolute determinant of (direction, Dx, Dy)
};

} // namespace osgRayTrace::engine
