// PluginPath.cpp - finds the library folder by the program's own path. Layer: apps.
// SPDX-License-Identifier: MIT
#include "PluginPath.h"

#include "osgPlugins/OwnFolder.h"
#include "osgRayTrace/base/Platform.h"

#include <filesystem>

namespace osgRayTrace::app
{

void addPluginPath()
{
    const std::filesystem::path program = engine::programPath();
    if (program.empty()) return;
    // The second folder is the first again, unless the installer splits lib by architecture.
    for (const char* fromProgram : {"../lib", OSGRAYTRACE_LIBRARIES_FROM_PROGRAMS})
    {
        engine::preferFolder((program.parent_path() / fromProgram).lexically_normal());
    }
}

} // namespace osgRayTrace::app
