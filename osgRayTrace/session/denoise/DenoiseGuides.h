// DenoiseGuides.h - what is seen in the pixels, as the denoiser's loops read it. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/denoise/DenoisePlanes.h"
#include "osgRayTrace/session/denoise/DenoiseSurfaces.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

namespace osgRayTrace::engine
{

/// Of the cells: one surface each, that of the first of its pixels that shows one.
struct CellGuides
{
    CellPlane normalX, normalY, normalZ;
    CellPlane distance;       ///< kNoSurface: there is none
    CellPlane slopeX, slopeY; ///< of distance, a cell
    CellPlane sharpness;      ///< 1 / how much distance may differ from a plane's
};

/// Made once for a view. What is filtered is light over albedo [Schied17, sect. 4.2]; lamps,
/// mirrors, clear glass and the background are not: what is seen in them has nothing to do with
/// their surface.
struct DenoiseGuides
{
    /// Throws std::bad_alloc.
    void set(const std::vector<SurfaceSample>& surfaces, int pixelsX, int pixelsY,
             const Workers& workers);

    int width = 0, height = 0; ///< pixels
    int cellsX = 0, cellsY = 0;

    /// What light is divided by and multiplied with again: the albedo, but not near 0. 0: not
    /// filtered.
    PixelPlane<float> albedoR, albedoG, albedoB;
    PixelPlane<uint8_t> inCell; ///< 1: the pixel shows its cell's surface
    /// How much of its light a pixel takes from its cell, from the next one to its own side in x,
    /// in y, in both: bilinear weights, times how alike the surfaces are. Of a row, first the
    /// pixels of even columns, then those of odd ones.
    PixelPlane<uint8_t> near, acrossX, acrossY, acrossBoth;

    CellGuides cells;

    PixelPlane<uint8_t> scatters; ///< 1: the pixel scatters light; with a margin of one pixel

private:
    void allocate(int pixelsX, int pixelsY);
};

} // namespace osgRayTrace::engine
