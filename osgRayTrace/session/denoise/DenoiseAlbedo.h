// DenoiseAlbedo.h - rows of pixels whose light is divided by their albedo. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/denoise/DenoiseCells.h"

namespace osgRayTrace::engine
{

constexpr int kPixelSegment =
    256; ///< pixels of a row that are worked on while they are in the cache

/// Pixels that are almost not there have no light of their own.
constexpr float kLeastAlpha = 1e-3f;
constexpr float kLargestLight = 1e20f; ///< squares of it are finite

struct AlbedoRow
{
    const float *r, *g, *b;
};

inline AlbedoRow albedoRow(const DenoiseGuides& guides, int x, int y)
{
    return {guides.albedoR.row(y) + x, guides.albedoG.row(y) + x, guides.albedoB.row(y) + x};
}

/// Returns the index of a pixel.
inline std::size_t pixelOf(const ResolvedImage& image, int x, int y)
{
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(x);
}

} // namespace osgRayTrace::engine
