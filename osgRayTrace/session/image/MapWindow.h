// MapWindow.h - a part of a surface map as a map of its own. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/image/SurfaceMap.h"

#include <cstddef>

namespace osgRayTrace::engine
{

/// A rectangle of pixels of an image.
struct PixelWindow
{
    int left = 0, bottom = 0, right = 0, top = 0;

    int width() const { return right - left; }
    int height() const { return top - bottom; }
    bool isEmpty() const { return left >= right || bottom >= top; }
    std::size_t area() const
    {
        return isEmpty() ? 0
                         : static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    }
};

/// Returns the view whose whole image is the window: the same eye, and the part of the frustum that
/// the window's pixels cover.
View windowView(const View& view, const PixelWindow& window);

/// Returns the part of a map within the window, which lies in the map, as a finished map of the
/// window's view. Smooth and interior pixels are found by the window alone.
SurfaceMap cutMap(const SurfaceMap& map, const PixelWindow& window, const Workers& workers);

/// Moves the map's view, rays and surfaces together, so that each pixel still shows the same point
/// of its surface. toMoved takes points of the world to their new places, without scale.
void moveMap(const Mat4d& toMoved, SurfaceMap& map);

} // namespace osgRayTrace::engine
