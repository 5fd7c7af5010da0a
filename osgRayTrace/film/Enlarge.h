// Enlarge.h - display values of a small image where those of a larger one are shown. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace osgRayTrace::engine
{

class Workers;

/// Pixels in rows, row 0 at the bottom: 4 bytes, premultiplied, and a window depth each.
struct DisplayPixels
{
    int width = 0;
    int height = 0;
    uint8_t* rgba = nullptr;
    float* depth = nullptr;
};

/// Writes the large image from the small one of the same view: colours between the four nearest
/// pixels as OpenGL's linear filter has them, depths of the nearest, as any others would be of
/// nothing there is.
void enlarge(const DisplayPixels& small, const DisplayPixels& large, const Workers& workers);

} // namespace osgRayTrace::engine
