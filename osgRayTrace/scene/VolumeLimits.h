// VolumeLimits.h - how large volumes may be. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace osgRayTrace::engine
{

/// The number of voxels along a side that a VolumeImage may have.
constexpr int kMostVoxelSide = 1 << 14;

/// The number of entries that Volume::transfer may have: its bounds take memory in proportion to
/// their number and its logarithm.
constexpr std::size_t kMostTransferEntries = std::size_t(1) << 16;

/// The largest value of a voxel, of either sign, and the largest element of the maps from engine
/// space to a volume's cubes: they leave floats for products with coefficients and coordinates.
constexpr float kLargestVoxel = 1e12f, kLargestVolumeMap = 1e18f;

} // namespace osgRayTrace::engine
