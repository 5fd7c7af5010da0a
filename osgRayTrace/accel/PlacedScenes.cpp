// PlacedScenes.cpp - all that a scene places, as one geometry of Embree. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/PlacedScenes.h"

#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

void giveBounds(const RTCBoundsFunctionArguments* args)
{
    const auto& placed = *static_cast<const PlacedScenes*>(args->geometryUserPtr);
    const Box box = placed.bounds(args->primID);
    RTCBounds& bounds = *args->bounds_o;
    bounds.lower_x = box.low.x;
    bounds.lower_y = box.low.y;
    bounds.lower_z = box.low.z;
    bounds.upper_x = box.high.x;
    bounds.upper_y = box.high.y;
    bounds.upper_z = box.high.z;
}

} // namespace

Box boundsOf(RTCScene scene)
{
    RTCBounds b;
    rtcGetSceneBounds(scene, &b);
    return {Vec3(b.lower_x, b.lower_y, b.lower_z), Vec3(b.upper_x, b.upper_y, b.upper_z)};
}

Affine inverse(const Affine& m)
{
    const glm::dmat3 linear = glm::inverse(glm::dmat3(m.linear));
    return {Mat3(linear), Vec3(-(linear * Vec3d(m.translation)))};
}

PlacedScenes::PlacedScenes(RTCDevice device)
    : _geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER))
{
    rtcSetGeometryUserData(_geometry.get(), this);
    rtcSetGeometryMask(_geometry.get(), kEveryMask);
    rtcSetGeometryBoundsFunction(_geometry.get(), giveBounds, nullptr);
    setPlacedQueries(_geometry.get());
    rtcCommitGeometry(_geometry.get()); // there may never be any placements
}

bool PlacedScenes::holds(const std::vector<Placement>& placements) const
{
    if (placements.size() != _hashes.size()) return false;
    for (std::size_t i = 0; i < placements.size(); ++i)
        if (placements[i].hash != _hashes[i]) return false;
    return true;
}

bool PlacedScenes::set(const std::vector<Placement>& placements)
{
    const std::size_t before = _hashes.size(), count = placements.size();
    bool changed = before != count;
    if (changed)
    {
        _scenes.reserve(count); // the exact size, without room to grow
        _scenes.resize(count);
        _hashes.reserve(count);
        _hashes.resize(count);
    }
    for (std::size_t i = 0; i < count; ++i)
    {
        if (i < before && _hashes[i] == placements[i].hash) continue;
        put(i, placements[i]);
        changed = true;
    }
    if (!changed) return false;
    _placements = placements.data();
    rtcSetGeometryUserPrimitiveCount(_geometry.get(), static_cast<unsigned int>(count));
    rtcCommitGeometry(_geometry.get());
    return true;
}

Box PlacedScenes::bounds(std::size_t i) const
{
    const Placement& placement = _placements[i];
    if (!placement.engineFromLocal) return boundsOf(placement.scene);
    if (placement.outline) return placement.outline->placedBounds(*placement.engineFromLocal);
    return Outline(boundsOf(placement.scene)).placedBounds(*placement.engineFromLocal);
}

void PlacedScenes::put(std::size_t i, const Placement& placement)
{
    PlacedScene& placed = _scenes[i];
    placed.scene = placement.scene;
    placed.instance = placement.engineFromLocal ? placement.instance : kInvalid;
    placed.mask = placement.mask;
    const Affine m = placement.engineFromLocal ? inverse(*placement.engineFromLocal) : Affine();
    std::memcpy(placed.localFromEngine, &m.linear, 9 * sizeof(float));
    std::memcpy(placed.localFromEngine + 9, &m.translation, 3 * sizeof(float));
    _hashes[i] = placement.hash;
}

} // namespace osgRayTrace::engine
