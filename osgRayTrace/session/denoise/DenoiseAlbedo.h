// DenoiseAlbedo.h - rows of pixels whose light is divided by their albedo. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/denoise/DenoiseCells.h"

namespace osgRayTrace::engine
{

/// Pixels of a row that are worked on while they are in the cache.
constexpr int kPixelSegment = 256;

/// Pixels of less alpha are almost empty and have no light of their own.
constexpr float kLeastAlpha = 1e-3f;
constexpr float kLargestLight = 1e20f; ///< largest light whose square is finite

struct AlbedoRow
{
    const float *r, *g, *b;
};

inline AlbedoRow albedoRow(const DenoiseGuides& guides, int x, int y)
{
    return {guides.albedoR.row(y) + x, guides.albedoG.row(y) + x, guides.albedoB.row(y) + x};
}

/// Returns the index of a pixel in the arrays of the image.
inline std::size_t pixelOf(const ResolvedImage& image, int x, int y)
{
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(x);
}

} // namespace osgRayTrace::engine
