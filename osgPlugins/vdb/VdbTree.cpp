// VdbTree.cpp - reads the nodes of a tree [Museth13]. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/vdb/VdbTree.h"

#include <set>

namespace osgRayTrace::vdb
{

namespace
{

constexpr int kLeafVoxels = kLeafSide * kLeafSide * kLeafSide;

/// A node has (2^log2Parts)^3 parts, each of which is a child or a tile of 2^log2Side voxels a
/// side.
struct LevelShape
{
    int log2Parts, log2Side;
};
constexpr LevelShape kLevels[] = {{5, 7}, {4, 3}}; ///< beneath the root, from the top
constexpr int kLeafLevel = 2;
constexpr int kRootSide = 4096; ///< voxels along a side of a part of the root

/// Reads where a part of the root begins. No two may be the same, or tiles could overlap.
VdbIndex readRootKey(VdbBytes& bytes, std::set<VdbIndex>& seen)
{
    VdbIndex low;
    for (std::int64_t& index : low)
    {
        index = bytes.number<std::int32_t>();
        if (index % kRootSide != 0) throw VdbError("a node is at a place where none can be");
    }
    if (!seen.insert(low).second) throw VdbError("two nodes are at one place");
    return low;
}

} // namespace

std::uint64_t VdbTree::visit(VdbVisitor& visitor)
{
    VdbBytes bytes = _bytes;
    if (bytes.number<std::int32_t>() != 1) throw VdbError("its tree has several values a voxel");
    _background = _values.single(bytes);
    _values.setBackground(_background);
    const auto tiles = bytes.number<std::uint32_t>(), children = bytes.number<std::uint32_t>();
    std::set<VdbIndex> seen;
    for (std::uint32_t i = 0; i < tiles; ++i)
    {
        const VdbIndex low = readRootKey(bytes, seen);
        const float value = _values.single(bytes);
        visitor.tile(low, kRootSide, value, bytes.number<std::uint8_t>() != 0);
    }
    for (std::uint32_t i = 0; i < children; ++i)
    {
        const VdbIndex low = readRootKey(bytes, seen);
        visitNode(bytes, low, 0, visitor);
    }
    return bytes.place();
}

void VdbTree::visitNode(VdbBytes& bytes, const VdbIndex& low, int level, VdbVisitor& visitor)
{
    if (level == kLeafLevel)
    {
        visitor.leaf(low, VdbMask(bytes, kLeafVoxels));
        return;
    }
    const auto [log2Parts, log2Side] = kLevels[level];
    const unsigned int parts = 1u << 3 * log2Parts, last = (1u << log2Parts) - 1;
    const VdbMask isChild(bytes, parts), isActive(bytes, parts);
    std::vector<float> values;
    _values.read(bytes, isActive, values);
    const auto lowOf = [&, log2Parts = log2Parts, log2Side = log2Side](unsigned int i)
    {
        const auto index = [&](unsigned int part)
        { return static_cast<std::int64_t>(part) << log2Side; };
        return VdbIndex{low[0] + index(i >> 2 * log2Parts), low[1] + index(i >> log2Parts & last),
                        low[2] + index(i & last)};
    };
    for (unsigned int i = 0; i < parts; ++i)
        if (!isChild[i]) visitor.tile(lowOf(i), 1 << log2Side, values[i], isActive[i]);
    for (unsigned int i = 0; i < parts; ++i)
        if (isChild[i]) visitNode(bytes, lowOf(i), level + 1, visitor);
}

const std::vector<float>& VdbLeafReader::next()
{
    const VdbMask active(_bytes, kLeafVoxels);
    _values.read(_bytes, active, _leaf);
    return _leaf;
}

} // namespace osgRayTrace::vdb
