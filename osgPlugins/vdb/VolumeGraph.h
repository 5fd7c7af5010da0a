// VolumeGraph.h - images of voxels as tiles of osgVolume. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/vdb/VdbDense.h"

#include <osgVolume/VolumeTile>

#include <optional>

namespace osgRayTrace::vdb
{

/// Returns a tile of a grid. The image of a density is divided by its largest value, which is the
/// layer's texel scale, and the tile has a PhysicalMaterial with an interior: smoke. A level set is
/// an isosurface. extinction: of a density of 1 [1/length]; nothing: the mean of the densities
/// above 0 has an optical depth of 10 along the longest side. Throws a VdbError.
osg::ref_ptr<osgVolume::VolumeTile> volumeTile(const VdbDense& dense, const VdbGrid& grid,
                                               std::optional<double> extinction);

} // namespace osgRayTrace::vdb
