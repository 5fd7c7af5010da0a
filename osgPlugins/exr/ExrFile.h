// ExrFile.h - a file that OpenEXR writes, with the system's reason if that fails. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

namespace osgRayTrace::engine
{

/// Writes a file by write(stream). Throws an exception with the system's reason where there is one:
/// OpenEXR's own words do not tell why a write failed, and only the stream knows whether the table
/// of offsets, which OpenEXR writes last, got there.
template <class Write> void writeExrFile(const std::string& path, const Write& write)
{
    errno = 0;
    std::ofstream stream(path, std::ios::binary);
    const auto check = [&stream]
    {
        if (stream) return;
        throw std::runtime_error(errno ? std::strerror(errno) : "the file cannot be written");
    };
    check();
    try
    {
        write(stream);
    }
    catch (const std::exception&)
    {
        check();
        throw;
    }
    stream.close();
    check();
}

} // namespace osgRayTrace::engine
