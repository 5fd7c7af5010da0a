// Destination.cpp - follows links to files that need not exist. Layer: base.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/Destination.h"

#include <cerrno>
#include <system_error>

namespace osgRayTrace::engine
{

namespace fs = std::filesystem;

namespace
{

constexpr int kMostLinks = 40; ///< the longest chain of links, as in Linux

/// Returns the path at the end of a chain of links; no file needs to exist there.
fs::path endOfLinks(fs::path path)
{
    std::error_code error;
    for (int i = 0; i < kMostLinks && fs::is_symlink(fs::symlink_status(path, error)); ++i)
    {
        const fs::path target = fs::read_symlink(path, error);
        if (error) break;
        path = path.parent_path() / target;
    }
    return path;
}

} // namespace

bool isSame(const struct stat& a, const struct stat& b)
{
    return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

fs::path folderOf(const fs::path& file)
{
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

Destination destinationOf(const std::string& path)
{
    Destination destination;
    struct stat found;
    if (stat(path.c_str(), &found) == 0)
    {
        destination.found = found;
        std::error_code error;
        destination.file = fs::canonical(path, error);
        if (error) destination.file = path;
        return destination;
    }
    destination.file = endOfLinks(path);
    if (errno != ENOENT) destination.error = errno;
    return destination;
}

} // namespace osgRayTrace::engine
