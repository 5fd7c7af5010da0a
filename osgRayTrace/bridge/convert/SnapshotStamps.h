// SnapshotStamps.h - gives each part of a new Scene its time stamp. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"

#include <memory>

namespace osgRayTrace::engine
{

/// Stamps instances, materials, lights and the scene itself. A part that differs from the part of
/// the same index in previous, which may be null, is stamped now; an equal part keeps the old
/// stamp. Meshes and textures carry their stamps already. Returns previous if nothing at all
/// differs, otherwise scene.
std::shared_ptr<const Scene> stampChanges(std::shared_ptr<Scene> scene,
                                          const std::shared_ptr<const Scene>& previous, Stamp now);

/// Stamps lights alone by the same rule. Returns whether one of them or their number differs.
bool stampLights(std::vector<Light>& lights, const std::vector<Light>& previous, Stamp now);

/// Returns whether the same medium fills both scenes.
bool sameAtmosphere(const Scene& a, const Scene& b);

/// Gives volumes that have changed the stamp `now`, and the others their old ones. Returns whether
/// some have changed.
bool stampVolumes(std::vector<Volume>& volumes, const std::vector<Volume>& previous, Stamp now);

} // namespace osgRayTrace::engine
