// VdbDense.h - sparse grids as images with a value for each place. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/vdb/VdbTree.h"

#include <osg/Image>

namespace osgRayTrace::vdb
{

/// The cells of an image may be this many, and this many along a side: what VolumeImages take.
constexpr std::uint64_t kMostCells = std::uint64_t(1) << 29;
constexpr int kMostCellSide = 1 << 14;

/// A grid between the outermost of its active voxels.
struct VdbDense
{
    /// GL_LUMINANCE, GL_FLOAT. Values of level sets are turned to 0 outside, 1 inside and 0.5 at
    /// the surface, and linear in between.
    osg::ref_ptr<osg::Image> image;
    VdbIndex low{};             ///< the lowest voxel
    std::int64_t factor = 1;    ///< voxels along a side of a cell, which has their mean
    std::uint64_t repaired = 0; ///< values not finite, or above 1e30; they are the background
};

/// Reads a tree. The cells are as small as mostCells, at most kMostCells, allows. Throws a
/// VdbError, or std::bad_alloc.
VdbDense readDense(const std::string& file, const VdbGrid& grid, std::uint64_t mostCells);

} // namespace osgRayTrace::vdb
