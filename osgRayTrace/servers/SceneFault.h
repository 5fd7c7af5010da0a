// SceneFault.h - why a scene that came from elsewhere cannot be traced. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"

namespace osgRayTrace::engine
{

// These functions return a sentence, or null if the part keeps what the engine relies on: sizes of
// arrays that belong together, indices in range, and finite positions.

const char* meshFault(const Mesh& mesh);
const char* textureFault(const Texture& texture);
const char* environmentFault(const EnvironmentImage& image);
const char* volumeFault(const VolumeImage& image);

/// Looks at the lists alone: meshes, textures and images have been looked at one by one.
const char* sceneFault(const Scene& scene);

} // namespace osgRayTrace::engine
