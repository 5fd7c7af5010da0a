// TracedScene.h - a Scene with the Embree structures that trace it. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/base/Status.h"
#include "osgRayTrace/media/GridTable.h"
#include "osgRayTrace/media/MediumTable.h"
#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/scene/SceneTraits.h"
#include "osgRayTrace/shading/LightTable.h"
#include "osgRayTrace/shading/MaterialTable.h"

#include <cstdint>
#include <memory>

namespace osgRayTrace::engine
{

class Intersector;
struct VertexTangents;
class Workers;

/// How a TracedScene was built.
struct BuildStatistics
{
    double seconds = 0.0;
    uint64_t embreeBytes = 0;    ///< value of embreeBytes() after the build
    size_t builtMeshes = 0;      ///< meshes built into a BVH now; others: reused or refitted
    size_t refitMeshes = 0;      ///< mesh BVHs adapted to other positions
    size_t staticBuilds = 0;     ///< builds of the static BVH: 0 or 1
    size_t commits = 0;          ///< calls of rtcCommitScene, for meshes and top level
    size_t builtVolumes = 0;     ///< volumes whose blocks were found now; others: taken over
    size_t invalidInstances = 0; ///< left out: transform singular, not finite, or out of range
};

/// A snapshot prepared for rays. It is immutable once built, and sessions share it. Meshes that no
/// transform places are in one static BVH. If there are placed meshes as well, the static BVH is
/// one of the instances of the top level.
class TracedScene
{
public:
    /// Returns the scene prepared for rays. Reuses the unchanged parts of `previous`, which may be
    /// null, and modifies structures that neither `previous` nor any other scene uses any more.
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
    /// Returns the media that rays travel through; empty without SceneTraits::media.
    const MediumTable& media() const;
    /// Returns the irradiance of the ground by the environment, with nothing in its way, as a
    /// luminance [W/m^2]; 0 without SceneTraits::ground.
    float groundSky() const;
    /// Returns the volumes that rays travel through; empty without SceneTraits::volumes.
    const GridTable& grids() const;
    /// Returns the tangents that were made for the mesh of an instance by the texture coordinates
    /// of a set; null if its material needs none, or if it has tangents of its own, no
    /// normals or no coordinates.
    const VertexTangents* vertexTangents(uint32_t instance, uint32_t uvSet) const;
    const BuildStatistics& statistics() const;

    /// Returns the bytes that the device holds now, as Embree reports them: those of this scene, of
    /// scenes made from it, of scenes that it was made from, and of spare parts for later scenes.
    /// Any thread may call this function.
    uint64_t embreeBytes() const;

private:
    TracedScene();
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

} // namespace osgRayTrace::engine
