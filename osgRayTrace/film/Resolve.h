// Resolve.h - images in rows of pixels from the film's tiles. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/ToneMap.h"

namespace osgRayTrace::engine
{

/// Decodes display-referred values to linear light; colours stay multiplied with alpha.
void decode(TileRgba& values);

/// Writes the tile's part of an image of width*height*4 linear floats, row 0 at the bottom. A
/// display-referred film is decoded to linear.
void resolveTileRadiance(const Film& film, int tile, bool displayReferred, float* image);

/// Writes the tile's part of an image in display values, 4 bytes a pixel, and of its window depths,
/// 1 float a pixel (may be null); row 0 is at the bottom.
void resolveTileDisplay(const Film& film, int tile, const ToneMap& toneMap, uint8_t* image,
                        float* depth);

/// Writes the display values of linear pixels, premultiplied RGBA, 4 floats each, as
/// resolveTileDisplay computes them. Whether the tone map is display-referred does not matter: the
/// pixels are linear.
void displayPixels(const float* rgba, std::size_t count, const ToneMap& toneMap, uint8_t* image);

/// Writes the display values of linear pixels as they look over a veiled background of its own
/// colour for each of them: opaque, 4 bytes a pixel. behind: the background's display values, 4
/// bytes a pixel.
void displayOver(const float* rgba, const uint8_t* behind, std::size_t count,
                 const ToneMap& toneMap, uint8_t* image);

/// Writes the window depths of the first pass, 1 float a pixel; 1 for a tile without depths.
void resolveTileDepth(const Film& film, int tile, float* depth);

/// Writes the estimated standard error of each pixel's mean, linear RGB, 3 floats a pixel; needs
/// two passes.
void resolveTileError(const Film& film, int tile, bool displayReferred, float* image);

} // namespace osgRayTrace::engine
