// Destination.h - where a path to write to leads. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <optional>
#include <string>

namespace osgRayTrace::engine
{

struct Destination
{
    std::optional<struct stat> found; ///< nothing: a file is to be created
    std::filesystem::path file;       ///< the path with links followed
    int error = 0;                    ///< why it cannot be looked at

    bool isRegular() const { return found && S_ISREG(found->st_mode); }
};

/// Returns whether both are the same file.
bool isSame(const struct stat& a, const struct stat& b);

std::filesystem::path folderOf(const std::filesystem::path& file);

/// Looks at the file that a path leads to, or would create.
Destination destinationOf(const std::string& path);

} // namespace osgRayTrace::engine
