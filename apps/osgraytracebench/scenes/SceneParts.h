// SceneParts.h - materials, boxes and views of scenes that are made by formula. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/scene/View.h"

namespace osgRayTrace::bench
{

/// Adds a diffuse material, and returns its number.
uint32_t materialOf(engine::Scene& scene, engine::Vec3 albedo,
                    engine::Vec3 emission = engine::Vec3(0.0f));

/// Adds a mesh with an instance. light: the number of the light that it is, if it shines.
void addMesh(engine::Scene& scene, std::vector<engine::Vec3> positions,
             std::vector<engine::UVec3> triangles, uint32_t material,
             uint32_t light = engine::kInvalid);

/// Adds a parallelogram whose front faces cross(u, v).
void addQuad(engine::Scene& scene, engine::Vec3 corner, engine::Vec3 u, engine::Vec3 v,
             uint32_t material, uint32_t light = engine::kInvalid);

/// Adds a parallelogram that shines on its front.
void addPanel(engine::Scene& scene, engine::Vec3 corner, engine::Vec3 u, engine::Vec3 v,
              uint32_t material);

/// Adds a box from low to high.
void addBox(engine::Scene& scene, engine::Vec3 low, engine::Vec3 high, uint32_t material);

/// Returns a view with +z upwards and an angle of 60 degrees from its lower to its upper edge.
engine::View viewOf(engine::Vec3d eye, engine::Vec3d centre, int width, int height);

} // namespace osgRayTrace::bench
