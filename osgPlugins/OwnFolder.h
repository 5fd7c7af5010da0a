// OwnFolder.h - our plugins are found before OSG's of the same names. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/Registry>

#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace osgRayTrace::engine
{

/// Puts a folder of libraries first in OSG's list, in which it looks for osgPlugins-<version>/. OSG
/// has plugins of its own for .exr and .hdr; the order of folders alone decides which plugin is
/// taken. The registry asks every plugin of a name for a file that one has refused, so that OSG's
/// plugin must not be found at all for a damaged file. Where we share OSG's folder, as packages of
/// distributions do, plugins that OSG has, too, are in the folder osgRayTrace beneath it.
inline void preferFolder(const std::filesystem::path& libraries)
{
    osgDB::FilePathList& folders = osgDB::Registry::instance()->getLibraryFilePathList();
    const auto prefer = [&folders](const std::string& folder)
    {
        if (folders.empty() || folders.front() != folder) folders.push_front(folder);
    };
    std::error_code error;
    const std::filesystem::path apart = libraries / "osgRayTrace";
    const bool isApart = std::filesystem::is_directory(apart, error);
    // Only the first one is compared, so that an order that is right stays as it is.
    if (isApart && !folders.empty() && folders.front() == apart.string()) return;
    prefer(libraries.string());
    if (isApart) prefer(apart.string());
}

/// Returns the absolute folder of the library that holds an address; empty if that is not known.
inline std::filesystem::path folderOf(const void* address)
{
    Dl_info info{};
    if (!dladdr(address, &info) || !info.dli_fname) return {};
    const std::filesystem::path folder = std::filesystem::path(info.dli_fname).parent_path();
    return folder.is_absolute() ? folder : std::filesystem::path();
}

/// Prefers the library folder that this plugin was loaded from.
inline void preferOwnFolder()
{
    static const int ours = 0;
    std::filesystem::path plugins = folderOf(&ours); // <folder>/osgPlugins-<version>
    if (plugins.empty()) return;
    const std::filesystem::path libraries = plugins.parent_path();
    preferFolder(libraries.filename() == "osgRayTrace" ? libraries.parent_path() : libraries);
}

} // namespace osgRayTrace::engine
