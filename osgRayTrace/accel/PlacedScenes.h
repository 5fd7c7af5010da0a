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
    uint64_t hash = 0;                       ///< of all the rest: two alike hardly ever differ
    const Outline* outline = nullptr;        ///< null: the scene's bounds
    const Affine* engineFromLocal = nullptr; ///< null: in place
    uint32_t instance = kInvalid;            ///< that its hits are on; used if there is a transform
};

/// What a ray needs of a placement, one cache line.
struct alignas(64) PlacedScene
{
    float localFromEngine[12]; ///< columns
    RTCScene scene;
    uint32_t instance; ///< kInvalid: in place, its geometries are known by their own indices
};

/// Embree's own instances take 300 bytes more each, and their bounds are wider: see Outline. Here
/// each is a primitive of one user geometry, whose callbacks take rays into its space and on to
/// its scene. The scenes are not kept alive.
class PlacedScenes
{
public:
    explicit PlacedScenes(RTCDevice device);
    PlacedScenes(const PlacedScenes&) = delete;
    PlacedScenes& operator=(const PlacedScenes&) = delete;

    RTCGeometry geometry() const { return _geometry.get(); }

    bool holds(const std::vector<Placement>& placements) const;

    /// Redoes what differs and commits the geometry, unless nothing differs: then false. The
    /// placements are read once more when the scene is committed that has the geometry.
    bool set(const std::vector<Placement>& placements);

    const PlacedScene& operator[](std::size_t i) const { return _scenes[i]; }

    /// While placements are there.
    Box bounds(std::size_t i) const;

private:
    void put(std::size_t i, const Placement& placement);

    GeometryHandle _geometry;
    const Placement* _placements = nullptr;
    // By primitive:
    std::vector<PlacedScene> _scenes;
    std::vector<uint64_t> _hashes;
};

/// Of a scene that is committed.
Box boundsOf(RTCScene scene);

/// Inverse, in double until it is rounded.
Affine inverse(const Affine& m);

/// Has the geometry, of which user data are PlacedScenes, traced: see PlacedRays.cpp.
void setPlacedQueries(RTCGeometry geometry);

} // namespace osgRayTrace::engine
