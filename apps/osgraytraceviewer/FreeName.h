// FreeName.h - names of files that do not exist yet. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgDB/FileUtils>

#include <string>

namespace osgRayTrace::app
{

/// Returns "osgraytrace-N" and the ending, for the least N of which there is no file.
inline std::string freeName(const std::string& ending)
{
    std::string name;
    int number = 0;
    do
    {
        name = "osgraytrace-" + std::to_string(++number) + ending;
    } while (osgDB::fileExists(name));
    return name;
}

} // namespace osgRayTrace::app
