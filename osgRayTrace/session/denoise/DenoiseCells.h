// DenoiseCells.h - the denoiser's steps, row by row. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/denoise/DenoiseGuides.h"

namespace osgRayTrace::engine
{

/// Holds the light over albedo of the cells, and the variance of its luminance. kNoLight: the cell
/// has no light.
struct CellLight
{
    CellPlane r, g, b, variance;
};

/// Holds the statistics of the luminance of light over albedo in the pixels of each cell.
struct CellStatistics
{
    CellPlane mean;     ///< mean luminance; kNoLight: the cell has no light
    CellPlane spread;   ///< mean square of the pixels' differences from the mean
    CellPlane error;    ///< mean square of the pixels' standard errors; 0 for an image of one pass
    CellPlane variance; ///< variance of the mean, by the pixels' errors
};

/// Sets row y of the cells from the pixels of the image.
void gatherCells(const ResolvedImage& image, const DenoiseGuides& guides, int y, CellLight& light,
                 CellStatistics& statistics);

/// Sets row y of bounded: the light with its variance, with single bright cells reduced to a
/// brightness that their neighbours allow. hasErrors: the variance is that of the statistics,
/// smoothed; otherwise it is that of the neighbours.
void boundCells(const DenoiseGuides& guides, const CellStatistics& statistics,
                const CellLight& light, bool hasErrors, int y, CellLight& bounded);

/// Computes row y of a level of the filter, whose taps are step cells apart.
void filterCells(const DenoiseGuides& guides, const CellLight& light, int step, int y,
                 CellLight& filtered);

/// Adds to row y of spread how far the filtered light is from the mean; cells without light get 0.
/// The spread is then the mean square of the light that the filter takes away.
void compareCells(const DenoiseGuides& guides, const CellLight& filtered, int y,
                  CellStatistics& statistics);

/// Sets row y of kept to the share of the image's own light that is kept: k in DenoiseFilter.h.
void keepDetail(const DenoiseGuides& guides, const CellStatistics& statistics, int y,
                CellPlane& kept);

/// Sets row y of the pixels from the filtered cells.
void spreadCells(const DenoiseGuides& guides, const CellLight& filtered, const CellPlane& kept,
                 int y, ResolvedImage& image);

} // namespace osgRayTrace::engine
