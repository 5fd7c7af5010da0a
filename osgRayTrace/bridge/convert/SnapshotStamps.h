// SnapshotStamps.h - gives each part of a new Scene its time stamp. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"

#include <memory>

namespace osgRayTrace::engine
{

/// Stamps instances, materials, lights and the scene itself: now if they differ from the part of
/// the same index in previous (may be null), else that one's stamp. Meshes and textures carry
/// theirs already. Returns previous if nothing at all differs, else scene.
std::shared_ptr<const Scene> stampChanges(std::shared_ptr<Scene> scene,
                                          const std::shared_ptr<const Scene>& previous, Stamp now);

/// Stamps lights alone, likewise. True if one of them or their number differs.
bool stampLights(std::vector<Light>& lights, const std::vector<Light>& previous, Stamp now);

} // namespace osgRayTrace::engine
