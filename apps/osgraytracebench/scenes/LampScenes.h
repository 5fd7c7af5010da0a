// LampScenes.h - a hall and rooms under any number of lamps, made by formula. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/scenes/BenchScenes.h"

namespace osgRayTrace::bench
{

enum class LampKind
{
    Parallelogram,
    Point,
    Triangles, ///< two emitting triangles, a mesh for each lamp
};

/// Returns a hall of 100 x 100 x 6 m with 200 boxes on its floor, under lamps that send out the
/// same power together for any number of them.
BenchScene hall(int lamps, int width, int height, LampKind kind = LampKind::Parallelogram);

/// Returns 10 x 10 rooms of 10 x 10 x 3 m that are joined by doors, with the lamps in random rooms.
BenchScene rooms(int lamps, int width, int height);

/// Returns a sphere of about so many triangles, all of which shine, moved by offset.
std::shared_ptr<engine::Scene> shiningSphere(int triangles, engine::Vec3 offset);

} // namespace osgRayTrace::bench
