// SceneDigest.h - a number that tells scenes apart, the same in every process. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace osgRayTrace::engine
{

struct Scene;

/// Returns a hash of all values of a scene that its images depend on. Names and stamps do not
/// count: processes that read the same model have equal digests. Time: that of reading the scene's
/// memory once.
uint64_t sceneDigest(const Scene& scene);

} // namespace osgRayTrace::engine
