// SlitRooms.h - a lit and a dark room with a slit between them. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/EngineScenes.h"

namespace osgRayTrace::engine::test
{

constexpr float kSlit = 0.08f;

/// Returns two rooms, the first of which has a lamp. A wall at x = 4 with a slit is between them.
inline SceneBuilder rooms(float slit = kSlit)
{
    SceneBuilder builder;
    const Material white = lambert(Vec3(0.7f));
    builder.add(quadMesh({0, 0, 0}, {8, 0, 0}, {0, 4, 0}), white);
    builder.add(quadMesh({0, 0, 3}, {0, 4, 0}, {8, 0, 0}), white);
    builder.add(quadMesh({0, 0, 0}, {0, 0, 3}, {8, 0, 0}), white);
    builder.add(quadMesh({0, 4, 0}, {8, 0, 0}, {0, 0, 3}), white);
    builder.add(quadMesh({0, 0, 0}, {0, 4, 0}, {0, 0, 3}), white);
    builder.add(quadMesh({8, 0, 0}, {0, 0, 3}, {0, 4, 0}), white);
    builder.add(quadMesh({4, 0, 0}, {0, 2, 0}, {0, 0, 3}), white);
    if (slit < 2.0f) builder.add(quadMesh({4, 2 + slit, 0}, {0, 2 - slit, 0}, {0, 0, 3}), white);
    builder.addQuadLight({0.5f, 0.5f, 1.5f}, {0, 0.4f, 0}, {0.4f, 0, 0}, Vec3(100.0f), true);
    return builder;
}

/// Returns a view of a wall of the dark room, or of the room with the lamp.
inline View viewOf(bool dark, int size)
{
    const Vec3d eye = dark ? Vec3d(7.5, 0.5, 1.6) : Vec3d(3.5, 0.5, 1.6);
    return perspectiveView(eye, eye + Vec3d(-2.0, 2.5, -0.2), {0, 0, 1}, 60.0, size, size);
}

} // namespace osgRayTrace::engine::test
