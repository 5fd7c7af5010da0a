// UpsampleCells.h - the cells of an image in which one may interpolate. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/View.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// Tells for one axis which two pixels of the small image a pixel of the large one is between.
struct UpsampleAxis
{
    UpsampleAxis(int small, int large);

    float scale;                  ///< number of large pixels for each small one
    std::vector<int> first;       ///< first of the two small pixels, by large pixel
    std::vector<float> share;     ///< share of the second small pixel, in [0,1]
    std::vector<uint8_t> outside; ///< 1: not between two small pixels, at the image's edge
};

/// Describes the cells of an image. A cell is the area between the middles of 2 x 2 pixels; its
/// number is that of the pixel below on the left.
struct UpsampleCells
{
    int width = 0, height = 0; ///< size of the image
    /// Window depth in the middles of the pixels, not clamped; 1: nothing is hit.
    std::vector<float> depth;
    /// 1: the pixels of the cell and of the cells around it see one surface, flat enough, of one
    /// colour. Something thin is missed between the pixels that see it, so cells beside an edge do
    /// not count as smooth either.
    std::vector<uint8_t> smooth;
    /// Shares of the cells that are not smooth, and that are beside one that is not.
    double edges = 0.0, around = 0.0;
};

/// Places the small image in the view of the large one.
struct UpsampleView
{
    const CameraRays& camera; ///< camera of the large image
    double unit;              ///< Scene::unit
    const UpsampleAxis &x, &y;
    int width, height; ///< size of the small image
};

/// Returns the cells of an image. samples has one entry for each pixel of the small image.
/// mostEdges is the largest share of the cells that may be not smooth. If more are not smooth,
/// those beside an edge count as smooth; if too many still remain, all cells do.
UpsampleCells upsampleCells(const std::vector<SurfaceSample>& samples, const UpsampleView& view,
                            double mostEdges, const Workers& workers);

} // namespace osgRayTrace::engine
