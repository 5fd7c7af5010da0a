// UpsampleCells.h - between which pixels of an image one may interpolate. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/View.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// Of one axis: which two pixels of the small image a pixel of the large one is between.
struct UpsampleAxis
{
    UpsampleAxis(int small, int large);

    float scale;                  ///< large pixels a small one
    std::vector<int> first;       ///< the first of the two, by large pixel
    std::vector<float> share;     ///< of the second, in [0,1]
    std::vector<uint8_t> outside; ///< not between two: at the image's edge
};

/// A cell is what is between the middles of 2 x 2 pixels; its number is that of the one below on
/// the left.
struct UpsampleCells
{
    int width = 0, height = 0; ///< of the image
    std::vector<float>
        depth; ///< window depth in the middles of the pixels, not clamped; 1: nothing is hit
    /// Its pixels, and those of the cells around it, see one surface, flat enough, of one colour.
    /// What is thin is missed between the pixels that see it: so cells beside an edge are not taken
    /// for smooth either.
    std::vector<uint8_t> smooth;
    double edges = 0.0,
           around = 0.0; ///< shares of the cells: not smooth; or beside one that is not
};

/// The small image in the view of the large one.
struct UpsampleView
{
    const CameraRays& camera; ///< of the large image
    double unit;              ///< Scene::unit
    const UpsampleAxis &x, &y;
    int width, height; ///< of the small image
};

/// Returns the cells of an image. samples: one a pixel of the small image. mostEdges: the largest
/// share of the cells that is not to be smooth. If more are not, those beside an edge count as
/// smooth; if there still are too many, all do.
UpsampleCells upsampleCells(const std::vector<SurfaceSample>& samples, const UpsampleView& view,
                            double mostEdges, const Workers& workers);

} // namespace osgRayTrace::engine
