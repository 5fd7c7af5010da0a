// ProjectedRow.h - where the surfaces of a view are seen in an earlier one. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/session/image/SurfaceMap.h"

#include <cstddef>
#include <vector>

namespace osgRayTrace::engine
{

/// What limits the samples that a pixel may take along.
struct ReprojectionLimits
{
    float count = 32.0f; ///< of any pixel
    float edgeCount =
        4.0f; ///< of pixels that border on other surfaces: what they mix changes as these move
    /// Of glossy surfaces: the viewer has moved around the point by this share of the lobe's width
    /// since the oldest sample that counts, if it moves steadily.
    float lobeShare = 0.5f;
    float turn = 0.0f; ///< angle that is added to the viewer's move around all points [radians]
};

/// Where the surfaces of the new view's pixels are seen in the old one. Everything is divided by s,
/// the distance along the new ray, and that is 1/s = 0 for what is infinitely far away.
struct Projection
{
    Vec3d clip[2][3]; ///< old clip x, y, w of the rays' starts; of their directions: at (0,0), by
                      ///< x, by y
    Vec3 start, startDx, startDy;             ///< of rays, from the old pole
    Vec3 direction, directionDx, directionDy; ///< of rays
    Vec3 oldDirection{0.0f};                  ///< of all old rays, if those are parallel
    double wSign = 1.0;                       ///< of what the old view sees
    double halfWidth = 0.0, halfHeight = 0.0; ///< of the old image
};

Projection projectionOf(const SurfaceMap& from, const SurfaceMap& to);

/// A row of the new view, in the old one.
struct ProjectedRow
{
    explicit ProjectedRow(std::size_t width)
        : x(width), y(width), pointX(width), pointY(width), pointZ(width), limit(width)
    {
    }
    std::vector<float> x, y;                   ///< pixels, whole ones at their centres
    std::vector<float> pointX, pointY, pointZ; ///< from the old pole; divided by s
    std::vector<float> limit;                  ///< of samples; 0: not in the old image
};

/// Projects row y of the new view, whose surfaces are in to.
void projectRow(const Projection& projection, const ReprojectionLimits& limits,
                const SurfaceMap& to, int y, ProjectedRow& projected);

} // namespace osgRayTrace::engine
