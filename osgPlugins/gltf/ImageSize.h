// ImageSize.h - the size that an encoded image says it has. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

namespace osgRayTrace::gltf
{

/// Returns the number of pixels that the header of a PNG or JPEG image says, for which a decoder
/// takes memory before it looks at the data; 0 for other images.
std::uint64_t pixelsOf(const std::string& bytes);

} // namespace osgRayTrace::gltf
