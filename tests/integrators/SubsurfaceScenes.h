// SubsurfaceScenes.h - surfaces below which light walks, and a room with a ball of wax.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/integrators/MediaScenes.h"

namespace osgRayTrace::engine::test
{

/// Returns a surface below which light walks. ior: 1 for a surface without a highlight.
inline Material wax(Vec3 color, Vec3 radius, float ior = 1.0f, float weight = 1.0f)
{
    Material material;
    material.model = MaterialModel::Physical;
    material.baseColor = color;
    material.ior = ior;
    MaterialDetail detail;
    detail.subsurface = weight;
    detail.subsurfaceRadius = radius;
    material.detail = std::make_shared<MaterialDetail>(detail);
    return material;
}

inline Material changed(Material material, void (*change)(Material&, MaterialDetail&))
{
    MaterialDetail detail = *material.detail;
    change(material, detail);
    material.detail = std::make_shared<MaterialDetail>(detail);
    return material;
}

/// A ball of wax on a floor, before a wall, below a lamp.
inline SceneBuilder room(const Material& ball, const Material& floor = lambert(Vec3(0.6f)))
{
    SceneBuilder builder;
    builder.add(sphereMesh(Vec3(0.0f, 0.0f, 1.0f), 1.0f, 24), ball);
    builder.add(quadMesh({-4.0f, -4.0f, -0.01f}, {8.0f, 0.0f, 0.0f}, {0.0f, 8.0f, 0.0f}), floor);
    builder.add(quadMesh({-4.0f, 2.0f, 0.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 5.0f}),
                lambert(Vec3(0.7f, 0.5f, 0.3f)));
    builder.addQuadLight({0.5f, -0.5f, 4.0f}, {0.0f, 1.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, Vec3(10.0f));
    return builder;
}

inline View roomView(int pixels = 32)
{
    return perspectiveView({0, -6, 3}, {0, 0, 0.8}, {0, 0, 1}, 30, pixels, pixels);
}

} // namespace osgRayTrace::engine::test
