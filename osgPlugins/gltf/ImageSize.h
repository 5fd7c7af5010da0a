// ImageSize.h - the size that an encoded image says it has. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace osgRayTrace::gltf
{

/// Returns whether the header of a PNG or JPEG image says more than 2^26 pixels, for which a
/// decoder would take memory before it looks at the data.
bool isTooLargeImage(const std::string& bytes);

} // namespace osgRayTrace::gltf
