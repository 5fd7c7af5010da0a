// Enlarge.h - display values of a small image brought to a larger one. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace osgRayTrace::engine
{

class Workers;

/// Points to pixels in rows, row 0 at the bottom: 4 bytes, premultiplied, and a window depth each.
struct DisplayPixels
{
    int width = 0;
    int height = 0;
    uint8_t* rgba = nullptr;
    float* depth = nullptr;
};

/// Writes the large image from the small one of the same view. Colours are interpolated between the
/// four nearest pixels like those of OpenGL's linear filter. Depths are those of the nearest pixel,
/// as any depth in between would belong to no surface.
void enlarge(const DisplayPixels& small, const DisplayPixels& large, const Workers& workers);

} // namespace osgRayTrace::engine
