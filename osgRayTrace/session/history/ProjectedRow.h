// ProjectedRow.h - finds the surfaces of a view in an earlier view. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/session/image/SurfaceMap.h"

#include <cstddef>
#include <vector>

namespace osgRayTrace::engine
{

/// Limits the samples that a pixel may take along.
struct ReprojectionLimits
{
    float count = 32.0f; ///< largest number of samples of any pixel
    /// Largest number for pixels that border on other surfaces: the mixture in them changes as the
    /// surfaces move.
    float edgeCount = 4.0f;
    /// Share of a glossy surface's lobe width by which the viewer has moved around the point since
    /// the oldest sample that counts, if the viewer moves steadily.
    float lobeShare = 0.5f;
    float turn = 0.0f; ///< angle that is added to the viewer's move around all points [radians]
};

/// Tells where the surfaces of the new view's pixels are seen in the old view. All lengths are
/// divided by s, the distance along the new ray; 1/s is 0 for surfaces that are infinitely far
/// away.
struct Projection
{
    /// Old clip x, y, w of the rays' starts; of their directions: at (0,0), by x, by y.
    Vec3d clip[2][3];
    Vec3 start, startDx, startDy;             ///< starts of rays, from the old pole
    Vec3 direction, directionDx, directionDy; ///< directions of rays
    Vec3 oldDirection{0.0f};                  ///< direction of all old rays, if they are parallel
    double wSign = 1.0;                       ///< sign of w in front of the old view
    double halfWidth = 0.0, halfHeight = 0.0; ///< half the size of the old image
};

Projection projectionOf(const SurfaceMap& from, const SurfaceMap& to);

/// Holds where a row of the new view is in the old view.
struct ProjectedRow
{
    explicit ProjectedRow(std::size_t width)
        : x(width), y(width), pointX(width), pointY(width), pointZ(width), limit(width)
    {
    }
    std::vector<float> x, y; ///< place in the old image [pixels], integers at pixel centres
    std::vector<float> pointX, pointY, pointZ; ///< place from the old pole, divided by s
    std::vector<float> limit; ///< largest number of samples; 0: not in the old image
};

/// Projects row y of the new view, whose surfaces are in the map to.
void projectRow(const Projection& projection, const ReprojectionLimits& limits,
                const SurfaceMap& to, int y, ProjectedRow& projected);

} // namespace osgRayTrace::engine
