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

/// Returns the view of which the window shows all.
View windowView(const View& view, const PixelWindow& window);

/// Returns the part of a map within the window, which lies in the map, as a finished map of the
/// window's view. Smooth and interior pixels are found by the window alone.
SurfaceMap cutMap(const SurfaceMap& map, const PixelWindow& window, const Workers& workers);

/// Places the map as the viewer sees it from a world that is moved: toMoved takes points of the
/// old world to the moved one, without scale.
void moveMap(const Mat4d& toMoved, SurfaceMap& map);

} // namespace osgRayTrace::engine
