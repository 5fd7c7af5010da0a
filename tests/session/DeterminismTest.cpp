// DeterminismTest.cpp - images do not depend on threads, on the order of tiles or on the place of
// the scene in the world.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/Resolve.h"
#include "osgRayTrace/integrators/IntegratorFactory.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <numeric>
#include <random>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the Cornell box with a surface of each kind in it.
SceneBuilder mixedBox(Vec3 offset = Vec3(0.0f))
{
    SceneBuilder builder = cornellBox(offset);
    builder.add(sphereMesh(Vec3(400, 120, 120) + offset, 60.0f, 24), glass(1.5f));
    builder.add(sphereMesh(Vec3(100, 300, 300) + offset, 60.0f, 24), mirror(Vec3(0.9f)));
    Material plastic = lambert(Vec3(0.2f, 0.3f, 0.8f));
    plastic.ior = 1.5f;
    plastic.roughness = 0.3f;
    builder.add(sphereMesh(Vec3(250, 240, 180) + offset, 50.0f, 24), plastic);
    builder.addEmissive(boxMesh(Vec3(480, 400, 400) + offset, Vec3(520, 440, 440) + offset),
                        lamp(Vec3(2.0f, 3.0f, 8.0f)));
    Light lamp = pointLight(Vec3(278, 273, 100) + offset, Vec3(20000.0f));
    builder.addLight(lamp);
    return builder;
}

} // namespace

TEST_CASE("determinism: equal images for 1, 2, 3 and 16 threads and in every run, bit by bit",
          "[session][stability 50]")
{
    // Without this limit TBB has no more threads than the machine has cores.
    const tbb::global_control sixteen(tbb::global_control::max_allowed_parallelism, 16);
    const auto traced = mixedBox().build();
    for (const IntegratorKind kind :
         {IntegratorKind::Path, IntegratorKind::Whitted, IntegratorKind::Ppm, IntegratorKind::Sppm,
          IntegratorKind::PhotonCaustics})
    {
        RenderOptions options = optionsOf(kind);
        options.photons = 20000; // some for each thread
        const Picture one = render(traced, cornellView(70, 50), options, 6, 1);
        CHECK(one.progress.droppedSamples == 0);
        CHECK(one.mean().y > 0.01f);
        for (const int threads : {1, 2, 3, 16})
        {
            const Picture many =
                render(mixedBox().build(threads), cornellView(70, 50), options, 6, threads);
            CAPTURE(int(kind), threads);
            CHECK(many.rgba == one.rgba);
            CHECK(many.progress.rays.total() == one.progress.rays.total());
        }
    }
}

TEST_CASE("determinism: equal images for any order of tiles", "[session]")
{
    const auto traced = mixedBox().build();
    const View view = cornellView(70, 50);
    const std::vector<Light> lights = traced->scene().lights;
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Picture expected = render(traced, view, optionsOf(kind), 2);
        PassContext context;
        context.traced = traced.get();
        context.lights = &lights;
        context.camera = *cameraRays(view, traced->scene().origin);
        context.options = optionsOf(kind);
        const auto integrator = newIntegrator(kind);
        Film film;
        film.reset(view.width, view.height);
        std::vector<int> order(static_cast<std::size_t>(film.tileCount()));
        std::iota(order.begin(), order.end(), 0);
        for (int pass = 0; pass < 2; ++pass)
        {
            std::shuffle(order.begin(), order.end(), std::mt19937(static_cast<unsigned>(pass)));
            context.key = context.pathKey = passKey(0, pass);
            film.beginPass();
            for (const int tile : order)
            {
                TileRgba rgba;
                TileResult result;
                result.rgba = rgba;
                integrator->renderTile(context, film.tileX(tile), film.tileY(tile), result);
                film.addPass(tile, film.tilePasses(tile), result.rgba);
            }
        }
        std::vector<float> image(expected.rgba.size());
        for (const int tile : order)
            resolveTileRadiance(film, tile, false, image.data());
        CHECK(image == expected.rgba);
    }
}

TEST_CASE("determinism: a scene at the radius of the earth looks as it does at the origin",
          "[session]")
{
    SceneBuilder near = mixedBox();
    SceneBuilder far = near;
    far.scene = std::make_shared<Scene>(*near.scene);
    far.scene->origin = Vec3d(6378137.0, -4510000.0, 4510000.0);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        // Along the axes the matrices are exact, and so is the image.
        View view = cornellView(48, 48);
        const Picture here = render(near.build(), view, optionsOf(kind), 2);
        view.viewFromWorld = glm::translate(view.viewFromWorld, -far.scene->origin);
        const Picture there = render(far.build(), view, optionsOf(kind), 2);
        CHECK(there.rgba == here.rgba);

        // In a turned view the eye moves by 1e-9: a handful of paths may meet an edge from its
        // other side.
        View turned =
            perspectiveView({150, 300, -700}, {290, 250, 10}, {0.1, 1, 0.05}, 37.0, 48, 48);
        const Picture hereTurned = render(near.build(), turned, optionsOf(kind), 2);
        turned.viewFromWorld = glm::translate(turned.viewFromWorld, -far.scene->origin);
        const Picture thereTurned = render(far.build(), turned, optionsOf(kind), 2);
        int different = 0;
        for (int y = 0; y < 48; ++y)
        {
            for (int x = 0; x < 48; ++x)
            {
                const float difference = glm::length(hereTurned.at(x, y) - thereTurned.at(x, y));
                different += difference > 1e-3f * (0.01f + glm::length(hereTurned.at(x, y)));
            }
        }
        CAPTURE(int(kind), different);
        CHECK(different <= (kind == IntegratorKind::Whitted ? 10 : 30)); // of 2304
    }
}

TEST_CASE("determinism: a scene scaled by powers of two looks the same", "[session]")
{
    const auto scaled = [](float scale)
    {
        SceneBuilder builder;
        builder.add(quadMesh(Vec3(-1, -1, 0) * scale, Vec3(2, 0, 0) * scale, Vec3(0, 2, 0) * scale),
                    lambert(Vec3(0.7f)));
        builder.add(boxMesh(Vec3(-0.3f, -0.2f, 0) * scale, Vec3(0.2f, 0.3f, 0.4f) * scale),
                    lambert(Vec3(0.5f)));
        builder.addQuadLight(Vec3(-0.5f, -0.5f, 1.5f) * scale, Vec3(0, 0.7f, 0) * scale,
                             Vec3(0.7f, 0, 0) * scale, Vec3(4.0f));
        View view =
            perspectiveView(Vec3d(0.5, -3, 2) * double(scale), Vec3d(0.0), {0, 0, 1}, 40.0, 32, 32);
        view.clipFromView =
            glm::perspective(0.7, 1.0, 0.125 * double(scale), 100.0 * double(scale));
        return render(builder.build(), view, optionsOf(IntegratorKind::Path, 3), 4);
    };
    const Picture reference = scaled(1.0f);
    CHECK(reference.mean().y > 0.02f);
    for (const float scale : {0x1p-20f, 0x1p-10f, 0x1p20f, 0x1p30f})
    {
        const Picture picture = scaled(scale);
        double sum = 0.0;
        for (std::size_t i = 0; i < picture.rgba.size(); ++i)
        {
            const double d = picture.rgba[i] - reference.rgba[i], r = reference.rgba[i] + 0.01;
            sum += d * d / (r * r);
        }
        CAPTURE(scale);
        CHECK(picture.progress.droppedSamples == 0);
        CHECK(sum / static_cast<double>(picture.rgba.size()) < 1e-8);
    }
}
