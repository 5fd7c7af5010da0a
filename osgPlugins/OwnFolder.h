// OwnFolder.h - our plugins are found before OSG's of the same names. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/Registry>

#include <dlfcn.h>

#include <filesystem>
#include <string>

namespace osgRayTrace::engine
{

/// Puts the library folder that this plugin was loaded from first in OSG's list. OSG has plugins of
/// its own for .exr and .hdr; the order of folders alone decides which plugin is taken. The
/// registry asks every plugin of a name for a file that one has refused, so that OSG's plugin must
/// not be found at all for a damaged file.
inline void preferOwnFolder()
{
    static const int ours = 0;
    Dl_info info{};
    if (!dladdr(&ours, &info) || !info.dli_fname) return;
    // The plugin's path is <folder>/osgPlugins-<version>/<plugin>.
    const std::filesystem::path plugins = std::filesystem::path(info.dli_fname).parent_path();
    if (!plugins.is_absolute()) return;
    osgDB::FilePathList& folders = osgDB::Registry::instance()->getLibraryFilePathList();
    const std::string folder = plugins.parent_path().string();
    if (folders.empty() || folders.front() != folder) folders.push_front(folder);
}

} // namespace osgRayTrace::engine
