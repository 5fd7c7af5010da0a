// ZmqKeys.h - keys of ZeroMQ's CURVE in files. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <string>

namespace osgRayTrace::engine
{

/// A key is 40 characters in the first line of its file (Z85).
constexpr std::size_t kKeyLength = 40;

/// Returns the key in a file; empty if there is none.
inline std::string readKey(const std::string& file)
{
    std::ifstream stream(file);
    std::string key;
    std::getline(stream, key);
    return key.size() == kKeyLength ? key : std::string();
}

} // namespace osgRayTrace::engine
