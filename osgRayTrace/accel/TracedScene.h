// TracedScene.h - a Scene with the Embree structures that trace it. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/base/Status.h"
#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/scene/SceneTraits.h"
#include "osgRayTrace/shading/LightTable.h"
#include "osgRayTrace/shading/MaterialTable.h"

#include <cstdint>
#include <memory>

namespace osgRayTrace::engine
{

class Intersector;
class Workers;

/// How a TracedScene was built.
struct BuildStatistics
{
    double seconds = 0.0;
    uint64_t embreeBytes = 0;    ///< as embreeBytes() was then
    size_t builtMeshes = 0;      ///< built now; the rest was taken from the previous one
    size_t refitMeshes = 0;      ///< BVHs that were adapted to other positions
    size_t staticBuilds = 0;     ///< of the one BVH over all meshes that are not placed: 0 or 1
    size_t commits = 0;          ///< rtcCommitScene, of meshes and of the top level
    size_t invalidInstances = 0; ///< left out: transform singular, not finite, or out of range
};

/// Immutable once built; sessions share it. Reuses from previous what did not change (may be null),
/// and changes what neither previous nor anybody else uses any more. Meshes that are not placed are
/// in one static BVH; where there are others, it is one of the instances of the top level.
class TracedScene
{
public:
    /// Throws EngineError (OutOfMemory, DeviceFailure).
    static std::shared_ptr<const TracedScene>
    build(std::shared_ptr<const Scene> scene, std::shared_ptr<Workers> workers,
          std::shared_ptr<const TracedScene> previous = {});
    ~TracedScene();

    const Scene& scene() const;
    const SceneTraits& traits() const;
    const Intersector& intersector() const;
    const SurfaceTable& surfaces() const;
    const MaterialTable& materials() const;
    const LightTable& lights() const;
    const BuildStatistics& statistics() const;

    /// What the device holds now, as Embree reports it: for this scene, for others made from it or
    /// that it was made from, and spare parts for the next ones. Any thread.
    uint64_t embreeBytes() const;

private:
    TracedScene();
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace osgRayTrace::engine
