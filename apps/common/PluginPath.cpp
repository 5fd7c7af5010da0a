// PluginPath.cpp - finds the library folder by the program's own path. Layer: apps.
// SPDX-License-Identifier: MIT
#include "PluginPath.h"

#include <osgDB/Registry>

#include <filesystem>
#include <system_error>

namespace osgRayTrace::app
{

void addPluginPath()
{
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) return;
    osgDB::FilePathList& libraries = osgDB::Registry::instance()->getLibraryFilePathList();
    // The second folder is the first again, unless the installer splits lib by architecture.
    for (const char* fromProgram : {"../lib", OSGRAYTRACE_LIBRARIES_FROM_PROGRAMS})
    {
        libraries.push_front((program.parent_path() / fromProgram).lexically_normal().string());
    }
}

} // namespace osgRayTrace::app
