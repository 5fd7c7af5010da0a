// GltfError.h - why a glTF file is refused, and at which place of the file. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace osgRayTrace::gltf
{

/// Is thrown inside the plugin and never leaves it: the reader turns it into a message.
class GltfError : public std::runtime_error
{
public:
    /// place: such as "accessors[3].count"; may be empty.
    GltfError(const std::string& place, const std::string& problem)
        : std::runtime_error(place.empty() ? problem : place + ": " + problem)
    {
    }
};

} // namespace osgRayTrace::gltf
