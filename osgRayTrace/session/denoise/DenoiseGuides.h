// DenoiseGuides.h - the surfaces of the pixels, as the denoiser's loops read them. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/denoise/DenoisePlanes.h"
#include "osgRayTrace/session/denoise/DenoiseSurfaces.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

namespace osgRayTrace::engine
{

/// Holds one surface for each cell: the mean over those of its pixels that show the same surface as
/// the first of them that shows any.
struct CellGuides
{
    CellPlane normalX, normalY, normalZ;
    CellPlane distance;       ///< distance along the ray; kNoSurface: no surface
    CellPlane slopeX, slopeY; ///< change of distance from cell to cell
    CellPlane sharpness;      ///< 1 / allowed difference of a distance from that of a plane
};

/// Holds the guides of a view, which are made once for all of its images. The denoiser filters
/// light over albedo [Schied17, sect. 4.2]. Lamps, mirrors, clear glass and the background are not
/// filtered, as the light that they show has nothing to do with their surface.
struct DenoiseGuides
{
    /// Sets the guides from the surfaces of a view's pixels. Throws std::bad_alloc.
    void set(const std::vector<SurfaceSample>& surfaces, int pixelsX, int pixelsY,
             const Workers& workers);

    int width = 0, height = 0; ///< size in pixels
    int cellsX = 0, cellsY = 0;

    /// Divisor of the light, by which the filtered light is multiplied again: the albedo, but not
    /// near 0. 0: the pixel is not filtered.
    PixelPlane<float> albedoR, albedoG, albedoB;
    PixelPlane<uint8_t> inCell; ///< 1: the pixel shows its cell's surface
    /// Weights by which a pixel takes light from its cell, from the next cell on its own side in x,
    /// from that in y and from that in both. The weights are bilinear, times how alike the surfaces
    /// are. A row has first the pixels of even columns, then those of odd columns.
    PixelPlane<uint8_t> near, acrossX, acrossY, acrossBoth;

    CellGuides cells;

    PixelPlane<uint8_t> scatters; ///< 1: the pixel scatters light; with a margin of one pixel

private:
    void allocate(int pixelsX, int pixelsY);
};

} // namespace osgRayTrace::engine
