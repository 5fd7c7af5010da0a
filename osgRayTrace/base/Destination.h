// Destination.h - finds the file that a path to write to leads to. Layer: base.
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
    std::optional<struct stat> found; ///< the file as it is; nothing: it is to be created
    std::filesystem::path file;       ///< the path with links followed
    int error = 0;                    ///< the error number if the file cannot be looked at; else 0

    bool isRegular() const { return found && S_ISREG(found->st_mode); }
};

/// Returns whether both describe the same file.
bool isSame(const struct stat& a, const struct stat& b);

std::filesystem::path folderOf(const std::filesystem::path& file);

/// Returns the file that a path leads to, or would create.
Destination destinationOf(const std::string& path);

} // namespace osgRayTrace::engine
