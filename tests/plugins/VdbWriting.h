// VdbWriting.h - writes grids by OpenVDB itself. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace osgRayTrace::test
{

/// Maps from the indices of voxels to the world, as OpenVDB classes.
enum class VdbMap
{
    UniformScale,
    Scale,
    ScaleTranslate,
    Translation,
    Affine,
    Unitary,
    Frustum
};

enum class VdbContent
{
    Fog,      ///< ballDensity()
    LevelSet, ///< ballLevel()
    Tiles,    ///< tiles of 8 and 128 voxels, active and inactive, above a background of 0.5
    Inactive, ///< nodes with none, one, two and more inactive values, with both signs
    Octants,  ///< values around the origin, on both sides of it
    Far,      ///< two voxels 100,000 apart
    Empty,    ///< no active voxel
    NotFinite ///< ballDensity() with two values that are no numbers
};

struct VdbStyle
{
    VdbContent content = VdbContent::Fog;
    std::uint32_t compression = 0; ///< OpenVDB's flags
    bool isDouble = false, half = false;
    bool isFog = true; ///< the class of the grid; OpenVDB does not use zip for fog and level sets
    VdbMap map = VdbMap::UniformScale;
    std::string name = "density";
    bool others =
        false; ///< writes grids of other names and types, too, and one that shares the tree
    bool asStream = false;
};

/// A file, and what OpenVDB itself says of the grid in it.
struct VdbWritten
{
    std::string bytes;
    std::array<int, 3> low{}, size{}; ///< of active voxels
    std::function<float(int, int, int)> value;
    std::function<std::array<double, 3>(int, int, int)> world; ///< of the middle of a voxel
};

VdbWritten writeVdb(const VdbStyle& style);

/// Returns a fog of size^3 active voxels, and nothing else.
std::string writeDenseVdb(int size, std::uint32_t compression);

} // namespace osgRayTrace::test
