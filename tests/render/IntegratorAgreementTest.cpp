// IntegratorAgreementTest.cpp - different estimators of the same light give the same image.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSize = 32, kTile = 8, kTiles = kSize / kTile;

/// Returns the mean radiance of each tile and channel, with one value for each seed.
std::vector<Estimate> tileMeans(const std::shared_ptr<const TracedScene>& traced, const View& view,
                                RenderOptions options, int passes)
{
    std::vector<Estimate> means(kTiles * kTiles * 3);
    for (uint32_t seed = 0; seed < 16; ++seed)
    {
        options.seed = seed + 1000 * static_cast<uint32_t>(options.integrator);
        const Picture picture = render(traced, view, options, passes);
        REQUIRE(picture.progress.droppedSamples == 0);
        for (int tile = 0; tile < kTiles * kTiles; ++tile)
        {
            Vec3d sum(0.0);
            for (int i = 0; i < kTile * kTile; ++i)
                sum += Vec3d(picture.at(tile % kTiles * kTile + i % kTile,
                                        tile / kTiles * kTile + i / kTile));
            for (int c = 0; c < 3; ++c)
                means[static_cast<std::size_t>(3 * tile + c)].add(sum[c] / (kTile * kTile));
        }
    }
    return means;
}

/// Checks that no tile differs by more than 4 standard errors (Welch) and rounding. With 30 degrees
/// of freedom a tile does so by chance with a probability of 4e-4.
void checkEqual(const std::vector<Estimate>& a, const std::vector<Estimate>& b)
{
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        const double spread = std::hypot(a[i].standardError(), b[i].standardError());
        CAPTURE(i, a[i].mean(), b[i].mean(), spread);
        CHECK(std::abs(a[i].mean() - b[i].mean()) <= 4.0 * spread + 1e-5 * std::abs(a[i].mean()));
    }
}

} // namespace

TEST_CASE("agreement: direct light in the Cornell box, Whitted against one bounce of path tracing",
          "[render][statistics]")
{
    const auto traced = cornellBox().build();
    const View view = cornellView(kSize, kSize);
    const auto path = tileMeans(traced, view, optionsOf(IntegratorKind::Path, 1), 32);
    const auto whitted = tileMeans(traced, view, optionsOf(IntegratorKind::Whitted), 32);
    checkEqual(path, whitted);
    double light = 0.0;
    for (const Estimate& tile : path)
        light += tile.mean();
    CHECK(light > 1.0);
}

TEST_CASE("agreement: all light strategies give the same image", "[render][statistics]")
{
    const auto traced = cornellBox().build();
    const View view = cornellView(kSize, kSize);
    RenderOptions options = optionsOf(IntegratorKind::Whitted);
    const auto sobol = tileMeans(traced, view, options, 16);
    for (const LightSampling strategy :
         {LightSampling::Random, LightSampling::UniformJitter, LightSampling::Stratified})
    {
        options.lightSampling = strategy;
        checkEqual(sobol, tileMeans(traced, view, options, 16));
    }
}

TEST_CASE("agreement: a parallelogram light and the same quad as an emissive mesh",
          "[render][statistics]")
{
    const View view = perspectiveView({0.5, -3, 2}, {0, 0, 0.2}, {0, 0, 1}, 40.0, kSize, kSize);
    const auto scene = [](bool mesh)
    {
        SceneBuilder builder;
        builder.add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.7f, 0.5f, 0.3f)));
        builder.add(boxMesh({-0.3f, -0.2f, 0}, {0.2f, 0.3f, 0.4f}), lambert(Vec3(0.5f)));
        const Vec3 corner(-0.5f, -0.5f, 1.5f), u(0, 0.7f, 0), v(0.7f, 0, 0.2f);
        if (mesh)
            builder.addEmissive(quadMesh(corner, u, v), lamp(Vec3(4.0f)));
        else
            builder.addQuadLight(corner, u, v, Vec3(4.0f), true);
        return builder.build();
    };
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
        checkEqual(tileMeans(scene(false), view, optionsOf(kind, 3), 16),
                   tileMeans(scene(true), view, optionsOf(kind, 3), 16));
}

TEST_CASE("agreement: a placed and mirrored scene shows what the scene moved beforehand shows",
          "[render][statistics]")
{
    // The scene has glass seen from inside and outside, smooth normals, an emissive mesh and a
    // diffuse floor.
    Affine transform;
    transform.linear = Mat3(0, 1.5f, 0, 1, 0, 0, 0, 0, 1.2f); // swaps x and y: mirrored
    transform.translation = Vec3(0.1f, 0.2f, 0.0f);
    const auto scene = [&](bool placed)
    {
        SceneBuilder builder;
        const auto add =
            [&](const std::shared_ptr<Mesh>& mesh, const Material& material, bool emits)
        {
            std::vector<Vec3> positions(mesh->positions.begin(), mesh->positions.end());
            std::vector<UVec3> triangles(mesh->triangles.begin(), mesh->triangles.end());
            if (!placed)
            {
                for (Vec3& p : positions)
                    p = transformPoint(transform, p);
                for (UVec3& t : triangles)
                    std::swap(t.y, t.z); // the front stays the front
            }
            const auto copy = newMesh(std::move(positions), std::move(triangles));
            const uint32_t index =
                emits ? builder.addEmissive(copy, material) : builder.add(copy, material);
            Instance& instance = builder.scene->instances[index];
            instance.placed = instance.mirrored = placed;
            if (!placed) return;
            instance.engineFromLocal = transform;
        };
        add(quadMesh({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.7f, 0.5f, 0.3f)), false);
        add(sphereMesh({0, 0, 0.5f}, 0.4f, 16), glass(1.5f), false);
        add(boxMesh({-0.8f, 0.3f, 0}, {-0.5f, 0.6f, 0.7f}), lambert(Vec3(0.2f, 0.6f, 0.3f)), false);
        add(quadMesh({-0.5f, -0.5f, 1.5f}, {0, 0.7f, 0}, {0.7f, 0, 0.2f}), lamp(Vec3(4.0f)), true);
        return builder.build();
    };
    const View view = perspectiveView({0.5, -3, 2}, {0, 0, 0.4}, {0, 0, 1}, 45.0, kSize, kSize);
    checkEqual(tileMeans(scene(false), view, optionsOf(IntegratorKind::Path, 8), 16),
               tileMeans(scene(true), view, optionsOf(IntegratorKind::Path, 8), 16));
    checkEqual(tileMeans(scene(false), view, optionsOf(IntegratorKind::Whitted, 8), 8),
               tileMeans(scene(true), view, optionsOf(IntegratorKind::Whitted, 8), 8));
}
