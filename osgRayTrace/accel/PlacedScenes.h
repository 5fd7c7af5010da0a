// PlacedScenes.h - all that a scene places, as one geometry of Embree. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/EmbreeDevice.h"
#include "osgRayTrace/accel/Outline.h"

#include <type_traits>
#include <vector>

namespace osgRayTrace::engine
{

struct GeometryRelease
{
    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using GeometryHandle = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, GeometryRelease>;

/// A scene at a place.
struct Placement
{
    RTCScene scene = nullptr;
    uint64_t hash = 0;                       ///< hash of all the rest: two alike hardly ever differ
    const Outline* outline = nullptr;        ///< null: the scene's bounds
    const Affine* engineFromLocal = nullptr; ///< null: in place
    uint32_t instance = kInvalid; ///< instance that its hits are on; used with a transform
    uint32_t mask = kEveryMask;   ///< of the rays that meet it
};

/// The part of a placement that a ray needs, in one cache line.
struct alignas(64) PlacedScene
{
    float localFromEngine[12]; ///< the columns of the transform
    RTCScene scene;
    uint32_t instance; ///< kInvalid: in place; its geometries are known by their own indices
    uint32_t mask;     ///< of the rays that meet it
};

/// All placements of a scene as primitives of one user geometry, whose callbacks take rays into the
/// space of a placement and on to its scene. Embree's own instances take 300 bytes more each, and
/// have wider bounds: see Outline. The scenes are not kept alive.
class PlacedScenes
{
public:
    explicit PlacedScenes(RTCDevice device);
    PlacedScenes(const PlacedScenes&) = delete;
    PlacedScenes& operator=(const PlacedScenes&) = delete;

    RTCGeometry geometry() const { return _geometry.get(); }

    bool holds(const std::vector<Placement>& placements) const;

    /// Sets the placements that differ and commits the geometry; returns false if nothing differs.
    /// The placements are read once more when the scene that has the geometry is committed.
    bool set(const std::vector<Placement>& placements);

    const PlacedScene& operator[](std::size_t i) const { return _scenes[i]; }

    /// Returns the bounds of a placement, as long as the placements exist.
    Box bounds(std::size_t i) const;

private:
    void put(std::size_t i, const Placement& placement);

    GeometryHandle _geometry;
    const Placement* _placements = nullptr;
    // The members below are indexed by primitive.
    std::vector<PlacedScene> _scenes;
    std::vector<uint64_t> _hashes;
};

/// Returns the bounds of a committed scene.
Box boundsOf(RTCScene scene);

/// Returns the inverse, in double until the result is rounded.
Affine inverse(const Affine& m);

/// Sets the callbacks that trace the geometry, whose user data are PlacedScenes: see
/// PlacedRays.cpp.
void setPlacedQueries(RTCGeometry geometry);

} // namespace osgRayTrace::engine
