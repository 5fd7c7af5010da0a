// Uri.h - the URIs of a glTF file: data in the text, or files beside it. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/JsonPlace.h"

#include <string>

namespace osgRayTrace::gltf
{

bool isDataUri(const std::string& uri);

/// Returns the bytes of "data:<type>;base64,<text>". Throws GltfError with the place if the text is
/// no base64.
std::string bytesOfDataUri(const JsonPlace& place);

/// Returns the path, below the folder of the glTF file, that a URI means. Throws GltfError if the
/// URI has a scheme or is absolute, goes up by "..", or has characters that no path needs.
std::string pathOfUri(const JsonPlace& place);

} // namespace osgRayTrace::gltf
