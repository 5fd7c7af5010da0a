// VdbOptions.h - what is asked for, and which grid it is. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/vdb/VdbFile.h"

#include <optional>

namespace osgRayTrace::vdb
{

/// The plugin's options. The constructor throws a VdbError for a number that cannot be used.
struct VdbOptions
{
    std::string grid; ///< empty: chosenEntry() chooses
    std::uint64_t mostVoxels = std::uint64_t(1) << 27;
    std::optional<double> extinction; ///< [1/length]
    bool yUp = false;

    explicit VdbOptions(const std::string& words);
};

/// Returns the grid of a name; without a name the one called density, else the first one that can
/// be read. Throws a VdbError if there is none.
const VdbEntry& chosenEntry(const std::vector<VdbEntry>& entries, const std::string& name);

/// Returns the names and types of all grids but one; of many, the first ones and a count.
std::string otherNames(const std::vector<VdbEntry>& entries, const VdbEntry& chosen);

/// Returns a text of a file without control characters, and not longer than a line.
std::string printable(const std::string& text);

} // namespace osgRayTrace::vdb
