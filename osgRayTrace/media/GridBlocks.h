// GridBlocks.h - bounds of what a volume takes from light, block by block. Layer: media.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Volume.h"

#include <array>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// The least and the largest value of an image that look-ups within each block of voxels find.
struct ValueBlocks
{
    static constexpr int kSide = 8; ///< voxels along a block

    std::array<int, 3> count{};     ///< blocks along x, y and z
    std::vector<float> least, most; ///< by block, x first

    /// Returns the blocks of an image. workers may be null.
    static std::shared_ptr<const ValueBlocks> of(const VolumeImage& image, const Workers* workers);
};

/// The least and the largest amount (VolumeSample.h) of a volume within each block. An amount of 0
/// throughout lets rays pass the block in one step.
struct GridBlocks
{
    std::shared_ptr<const ValueBlocks> values;
    std::vector<float> least, most; ///< by block, as in values

    /// Returns the bounds of a volume with these values.
    static std::shared_ptr<const GridBlocks> of(const Volume& volume,
                                                std::shared_ptr<const ValueBlocks> values);
};

} // namespace osgRayTrace::engine
