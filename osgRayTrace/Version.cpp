// Version.cpp - the library's name and version, which CMake's project() states. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/Version>

const char* osgRayTraceGetVersion()
{
    return OSGRAYTRACE_PROJECT_VERSION;
}

const char* osgRayTraceGetLibraryName()
{
    return "osgRayTrace Library";
}
