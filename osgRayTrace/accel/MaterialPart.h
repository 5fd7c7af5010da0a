// MaterialPart.h - a material table that outlives the scene it was made of. Layer: accel; private
// to TracedScene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/MaterialTable.h"

namespace osgRayTrace::engine
{

/// The material table with a copy of the parts of the scene that the table points to. It keeps no
/// other part of the scene alive.
struct MaterialPart
{
    explicit MaterialPart(const Scene& scene) : copy{partOf(scene)}, table(copy) {}
    static Scene partOf(const Scene& scene)
    {
        Scene part;
        part.materials = scene.materials;
        part.textures = scene.textures;
        part.displayReferred = scene.displayReferred;
        part.unit = scene.unit;
        return part;
    }

    Scene copy;
    MaterialTable table;
};

} // namespace osgRayTrace::engine
