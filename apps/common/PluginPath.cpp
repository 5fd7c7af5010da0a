// PluginPath.cpp - finds the library folder by the program's own path. Layer: apps.
// SPDX-License-Identifier: MIT
#include "PluginPath.h"

#include "osgPlugins/OwnFolder.h"

#include <filesystem>
#include <system_error>

namespace osgRayTrace::app
{

void addPluginPath()
{
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) return;
    // The second folder is the first again, unless the installer splits lib by architecture.
    for (const char* fromProgram : {"../lib", OSGRAYTRACE_LIBRARIES_FROM_PROGRAMS})
    {
        engine::preferFolder((program.parent_path() / fromProgram).lexically_normal());
    }
}

} // namespace osgRayTrace::app
