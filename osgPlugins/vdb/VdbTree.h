// VdbTree.h - goes through the nodes of a tree. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/vdb/VdbValues.h"

#include <array>

namespace osgRayTrace::vdb
{

/// Indices of a voxel: they may be up to 4096 beyond those of 32 bits.
using VdbIndex = std::array<std::int64_t, 3>;

constexpr int kLeafSide = 8; ///< voxels

/// Takes the parts of a tree.
class VdbVisitor
{
public:
    virtual ~VdbVisitor() = default;

    /// Takes a cube of voxels with one value. side: voxels.
    virtual void tile(const VdbIndex& low, int side, float value, bool active) = 0;

    /// Takes a leaf, whose values stand behind the whole tree.
    virtual void leaf(const VdbIndex& low, const VdbMask& active) = 0;
};

/// A tree within a file, which must outlive it. Its cubes do not overlap each other. The functions
/// throw a VdbError.
class VdbTree
{
public:
    VdbTree(const std::string& file, const VdbGrid& grid)
        : _bytes(file, grid.tree), _values(grid.format)
    {
    }

    /// Visits all tiles and leaves, in the order of the file. Returns the place behind them, where
    /// the values of the leaves are.
    std::uint64_t visit(VdbVisitor& visitor);

    /// Returns the value of what no node has, once the tree was visited.
    float background() const { return _background; }

private:
    void visitNode(VdbBytes& bytes, const VdbIndex& low, int level, VdbVisitor& visitor);

    const VdbBytes _bytes;
    VdbValues _values;
    float _background = 0.0f;
};

/// Reads the values of leaves, one after the other. Value (x * 8 + y) * 8 + z is that of voxel (x,
/// y, z) of the leaf.
class VdbLeafReader
{
public:
    /// place: what VdbTree::visit() returned.
    VdbLeafReader(const std::string& file, const VdbGrid& grid, std::uint64_t place,
                  float background)
        : _bytes(file, place), _values(grid.format)
    {
        _values.setBackground(background);
    }

    /// Returns the values of the next leaf. Throws a VdbError.
    const std::vector<float>& next();

private:
    VdbBytes _bytes;
    VdbValues _values;
    std::vector<float> _leaf;
};

} // namespace osgRayTrace::vdb
