// VdbFile.h - the header of an OpenVDB file and of its grids. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
//
// The format is that of OpenVDB's sources [OpenVDB22], versions 222 to 225: the header, metadata,
// and for each grid a descriptor with the places of its parts. A grid has its compression,
// metadata, a transform and a tree.
#pragma once

#include "osgPlugins/vdb/VdbBytes.h"

#include <osg/Matrixd>

#include <vector>

namespace osgRayTrace::vdb
{

/// The descriptor of a grid.
struct VdbEntry
{
    std::string name;       ///< without the suffix that tells grids of one name apart
    std::string uniqueName; ///< with it
    std::string type;       ///< of the tree and its values, for example "Tree_float_5_4_3"
    std::string parent;     ///< the unique name of the grid whose tree this one shares, or empty
    bool half = false;      ///< floats are stored in 16 bits
    std::uint64_t place = 0;

    /// Returns whether the grid's values are single numbers with a fraction.
    bool isScalar() const;
};

/// How the values of a tree are stored.
struct VdbValueFormat
{
    unsigned int bytes = 4;        ///< of a value: 2, 4 or 8
    bool half = false;             ///< arrays have values of 2 bytes
    std::uint32_t compression = 0; ///< VdbCompression
};

/// Bits of VdbValueFormat::compression.
enum VdbCompression : std::uint32_t
{
    VDB_ZIP = 1,
    VDB_ACTIVE_VALUES = 2, ///< inactive values are not stored where two values are enough
    VDB_BLOSC = 4
};

/// A grid without its tree.
struct VdbGrid
{
    VdbValueFormat format;
    bool isLevelSet = false;
    osg::Matrixd worldFromIndex; ///< maps the middle of voxel (i, j, k), which is (i, j, k)
    std::uint64_t tree = 0;      ///< the place of the tree
};

/// Throws a VdbError unless the bytes begin as a file does.
void checkMagic(const std::string& file);

/// Reads the descriptors of all grids. Throws a VdbError.
std::vector<VdbEntry> readEntries(const std::string& file);

/// Reads all but the tree of a grid with isScalar(). Throws a VdbError.
VdbGrid readGrid(const std::string& file, const std::vector<VdbEntry>& entries,
                 const VdbEntry& entry);

} // namespace osgRayTrace::vdb
