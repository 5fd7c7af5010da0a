// DenoiseCells.h - the denoiser's steps, row by row. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/denoise/DenoiseGuides.h"

namespace osgRayTrace::engine
{

/// Light over albedo of the cells, and the variance of its luminance. kNoLight: there is none.
struct CellLight
{
    CellPlane r, g, b, variance;
};

/// Of the luminance of light over albedo in the pixels of a cell.
struct CellStatistics
{
    CellPlane mean;     ///< kNoLight: there are none
    CellPlane spread;   ///< mean square of their difference from the mean
    CellPlane error;    ///< mean square of their standard errors; 0 for an image of one pass
    CellPlane variance; ///< of the mean, by those errors
};

/// Row y of the cells, from the image.
void gatherCells(const ResolvedImage& image, const DenoiseGuides& guides, int y, CellLight& light,
                 CellStatistics& statistics);

/// Row y with its variance, and single bright cells brought down to what their neighbours bear.
/// hasErrors: variance is that of the statistics, smoothed; else that of the neighbours.
void boundCells(const DenoiseGuides& guides, const CellStatistics& statistics,
                const CellLight& light, bool hasErrors, int y, CellLight& bounded);

/// Row y of a level of the filter, its taps step cells apart.
void filterCells(const DenoiseGuides& guides, const CellLight& light, int step, int y,
                 CellLight& filtered);

/// Row y: to spread is added how far the filtered light is from the mean; 0 where there is no
/// light. So it is the mean square of what the filter takes away.
void compareCells(const DenoiseGuides& guides, const CellLight& filtered, int y,
                  CellStatistics& statistics);

/// Row y of how much of the image's own light is kept: k in DenoiseFilter.h, into kept.
void keepDetail(const DenoiseGuides& guides, const CellStatistics& statistics, int y,
                CellPlane& kept);

/// Row y of the pixels, from the filtered cells.
void spreadCells(const DenoiseGuides& guides, const CellLight& filtered, const CellPlane& kept,
                 int y, ResolvedImage& image);

} // namespace osgRayTrace::engine
