// EngineScenes.h - small engine scenes, views and renders that the engine's tests share.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/RenderSession.h"

#include <glm/gtc/matrix_transform.hpp>

#include <memory>
#include <vector>

namespace osgRayTrace::engine::test
{

/// Returns a perfectly diffuse material.
Material lambert(Vec3 albedo);

/// Returns a tinted metal that reflects like a mirror.
Material mirror(Vec3 tint);

/// Returns clear glass, which is smooth by default.
Material glass(float ior, float roughness = 0.0f);

/// Returns a black material that emits the given radiance.
Material lamp(Vec3 radiance);

std::shared_ptr<Mesh> newMesh(std::vector<Vec3> positions, std::vector<UVec3> triangles);

/// Returns a quad with the corners corner, corner + u, corner + u + v, corner + v; its front is the
/// side of cross(u, v).
std::shared_ptr<Mesh> quadMesh(Vec3 corner, Vec3 u, Vec3 v);

/// Returns a closed sphere of rows x 2*rows facets, whose front is its outside.
std::shared_ptr<Mesh> sphereMesh(Vec3 centre, float radius, int rows);

/// Returns a closed axis-aligned box, whose front is its outside.
std::shared_ptr<Mesh> boxMesh(Vec3 low, Vec3 high);

/// Builds a scene of parts at given positions: each function appends a part and returns the index
/// of this part.
struct SceneBuilder
{
    SceneBuilder();

    uint32_t material(const Material& material);
    uint32_t add(std::shared_ptr<const Mesh> mesh, const Material& material);
    /// Adds a mesh that emits and is sampled as a light.
    uint32_t addEmissive(std::shared_ptr<const Mesh> mesh, const Material& material);
    /// Adds a parallelogram light and the quad that rays hit; the light shines to the side of
    /// cross(u, v).
    uint32_t addQuadLight(Vec3 corner, Vec3 u, Vec3 v, Vec3 radiance, bool twoSided = false);
    uint32_t addLight(const Light& light);

    std::shared_ptr<const TracedScene> build(int threads = 0) const;

    std::shared_ptr<Scene> scene; ///< not display referred, black background
};

/// Returns a fixed-function point light of diffuse 1 whose irradiance falls as pi/d^2.
Light pointLight(Vec3 position, Vec3 diffuse = Vec3(1.0f));

/// Returns the Cornell box with both blocks [mm], all of it diffuse, moved by offset.
SceneBuilder cornellBox(Vec3 offset = Vec3(0.0f));

View perspectiveView(Vec3d eye, Vec3d centre, Vec3d up, double fovyDegrees, int width, int height);

/// Returns the published view of the Cornell box.
View cornellView(int width, int height);

/// Returns a view along the reversed normal of a square of the given side around centre.
View patchView(Vec3d centre, Vec3d normal, double side, int pixels);

struct Picture
{
    int width = 0;
    int height = 0;
    std::vector<float> rgba; ///< linear
    RenderProgress progress;

    Vec3 at(int x, int y) const;
    Vec3 mean() const;
};

Picture render(const std::shared_ptr<const TracedScene>& scene, const View& view,
               const RenderOptions& options, int passes, int threads = 0);

RenderOptions optionsOf(IntegratorKind integrator, int maxBounces = 8, uint32_t seed = 0);

} // namespace osgRayTrace::engine::test
