// Extensions.h - which extensions of glTF are read. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/Document.h"

namespace osgRayTrace::gltf
{

/// Throws GltfError if the file requires an extension that is not known, and notes those that it
/// uses and that are not read.
void checkExtensions(Document& document);

} // namespace osgRayTrace::gltf
