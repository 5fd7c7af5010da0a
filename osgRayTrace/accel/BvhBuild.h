// BvhBuild.h - builds and refits the parts of a TracedScene. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/BvhParts.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// These functions count their work, and throw EngineError if Embree fails. They leave serials to
/// the pool.

std::unique_ptr<MeshBvh> buildMesh(const std::shared_ptr<EmbreeDevice>& device,
                                   const std::shared_ptr<const Mesh>& mesh, bool filtered,
                                   BuildCounts& counts);

/// Refits the spare BVH to the mesh. Returns false if the BVH must be built instead.
bool refitMesh(MeshBvh& spare, const std::shared_ptr<const Mesh>& mesh, bool filtered,
               BuildCounts& counts);

std::shared_ptr<StaticBvh> buildStatic(const std::shared_ptr<EmbreeDevice>& device,
                                       StaticBvh::Members members,
                                       std::vector<std::shared_ptr<const Mesh>> owners,
                                       BuildCounts& counts);

/// Returns a top level without placements, which is not committed.
std::unique_ptr<TopLevelBvh> newTopLevel(const std::shared_ptr<EmbreeDevice>& device);

/// Commits the scene. Throws EngineError if the commit or anything before it failed: Embree would
/// build a geometry that lacks a buffer for want of memory, and would read from an invalid address.
void commit(EmbreeDevice& device, RTCScene scene, BuildCounts& counts);

} // namespace osgRayTrace::engine
