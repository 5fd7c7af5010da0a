// TracedSceneTest.cpp - scenes become traceable whatever they hold, and unchanged parts are reused.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Affine scaled(float x, float y, float z, Vec3 translation = Vec3(0.0f))
{
    Affine m;
    m.linear = Mat3(x, 0, 0, 0, y, 0, 0, 0, z);
    m.translation = translation;
    return m;
}

/// Returns a unit box placed by the transform.
SceneBuilder placedBox(const Affine& transform)
{
    SceneBuilder builder;
    const uint32_t index = builder.add(boxMesh(Vec3(-1.0f), Vec3(1.0f)), lambert(Vec3(0.5f)));
    Instance& instance = builder.scene->instances[index];
    instance.placed = true;
    instance.engineFromLocal = transform;
    return builder;
}

std::optional<Hit> shoot(const TracedScene& traced, Vec3 origin, Vec3 direction)
{
    return traced.intersector().closestHit(origin, direction, 0.0f, kInfinity);
}

} // namespace

TEST_CASE("traced scene: an empty one is hit by nothing", "[accel]")
{
    const auto traced = SceneBuilder().build();
    CHECK_FALSE(shoot(*traced, Vec3(0.0f), Vec3(0, 0, -1)));
    CHECK_FALSE(traced->intersector().occluded(Vec3(0.0f), Vec3(0, 0, -1), 0.0f, kInfinity));
    RayHitBlock block = {};
    for (int i = 0; i < kLanes; ++i)
    {
        block.ray.directionZ[i] = 1.0f;
        block.ray.tFar[i] = kInfinity;
    }
    CHECK(traced->intersector().closestHits(block, kAllLanes, Coherence::Coherent) == 0);
    SurfaceLanes surface;
    surfacesOf(traced->surfaces(), block, kAllLanes, surface);
    CHECK(surface.hits == 0);
    CHECK(traced->statistics().builtMeshes == 0);
}

TEST_CASE("traced scene: transforms that Embree cannot invert are left out and counted",
          "[accel][stability 15]")
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Affine sheared = scaled(1, 1, 1);
    sheared.linear[2] = sheared.linear[0] + sheared.linear[1]; // the columns lie in a plane
    Affine nearlyFlat = sheared;
    nearlyFlat.linear[2].z = 1e-7f;
    const std::vector<Affine> bad{scaled(1, 1, 0),
                                  scaled(0, 0, 0),
                                  scaled(nan, 1, 1),
                                  scaled(1, 1, kInfinity),
                                  scaled(1e-20f, 1e-20f, 1e-20f),
                                  scaled(1, 1, 1e-29f),
                                  scaled(1e12f, 1e-20f, 1e-20f),
                                  scaled(1e30f, 1e30f, 1e30f),
                                  scaled(1, 1, 1, Vec3(nan, 0, 0)),
                                  scaled(1, 1, 1, Vec3(0, kInfinity, 0)),
                                  scaled(1, 1, 1, Vec3(1e30f, 0, 0)),
                                  sheared,
                                  nearlyFlat};
    for (std::size_t i = 0; i < bad.size(); ++i)
    {
        CAPTURE(i);
        SceneBuilder builder = placedBox(bad[i]);
        builder.add(boxMesh(Vec3(-1, -1, -9), Vec3(1, 1, -8)), lambert(Vec3(0.5f)));
        const auto traced = builder.build();
        CHECK(traced->statistics().invalidInstances == 1);
        for (const Vec3& direction :
             {Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0.3f, 0.4f, -0.866f), Vec3(0, 0, -9e5f)})
        {
            const auto hit = shoot(*traced, Vec3(0.1f, 0.2f, 5.0f), direction);
            if (hit) CHECK(hit->instance == 1); // the rest of the scene is still traced
        }
        CHECK(shoot(*traced, Vec3(0.1f, 0.2f, 5.0f), Vec3(0, 0, -1)));
    }
}

TEST_CASE("traced scene: small and far instances are safe for any ray", "[accel]")
{
    for (const Affine& transform :
         {scaled(1e-9f, 1e-9f, 1e-9f), scaled(1e-6f, 1e-6f, 1e-6f, Vec3(1e3f)),
          scaled(1e11f, 1e11f, 1e11f), scaled(1, 1, 1, Vec3(1e17f)), scaled(1e-4f, 1.0f, 1e4f),
          scaled(1, 1, 1e-9f, Vec3(-1e8f))})
    {
        const auto traced = placedBox(transform).build();
        CHECK(traced->statistics().invalidInstances == 0);
        // The origins go up to Embree's limit in engine space: rays that would exceed this limit in
        // local space are refused, and none aborts.
        for (const float distance : {0.0f, 5.0f, 1e6f, 1e9f, 1e12f, 1e15f, 5e17f, 2e18f})
        {
            for (const float length : {1.0f, 1e-5f, 9e5f})
            {
                shoot(*traced, Vec3(0.0f, 0.0f, distance), Vec3(0, 0, -length));
                traced->intersector().occluded(Vec3(distance), Vec3(-length), 0.0f, kInfinity);
            }
        }
        const Vec3 centre = transform.translation;
        const float size = transform.linear[2].z;
        if (glm::length(centre) < 1.0f)
        {
            const auto hit = shoot(*traced,
                                   centre + Vec3(0.1f * transform.linear[0].x,
                                                 0.2f * transform.linear[1].y, 5.0f * size),
                                   Vec3(0, 0, -1));
            REQUIRE(hit);
            CHECK(hit->t == Approx(4.0f * size));
        }
    }
}

TEST_CASE("traced scene: an instance is hit where its transform puts it, mirrored or not",
          "[accel]")
{
    Affine rotated;
    rotated.linear = Mat3(0, 2, 0, -1, 0, 0, 0, 0, 3);
    rotated.translation = Vec3(1, 2, 3);
    for (const Affine& transform :
         {scaled(2, 3, 4, Vec3(1, 2, 3)), scaled(-1, 1, 1), scaled(1, -1e-4f, 1e4f), rotated})
    {
        const auto placed = placedBox(transform).build();
        // This scene has the same triangles, transformed beforehand.
        SceneBuilder builder;
        const auto box = boxMesh(Vec3(-1.0f), Vec3(1.0f));
        std::vector<Vec3> positions;
        for (const Vec3& p : box->positions)
            positions.push_back(transformPoint(transform, p));
        builder.add(newMesh(positions, {box->triangles.begin(), box->triangles.end()}),
                    lambert(Vec3(0.5f)));
        const auto baked = builder.build();
        for (const Vec3& local : {Vec3(0.1f, 0.2f, 0.3f), Vec3(-0.5f, 0.4f, -0.6f)})
        {
            for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)})
            {
                const Vec3 origin = transformPoint(transform, local); // inside
                const auto a = shoot(*placed, origin, direction),
                           b = shoot(*baked, origin, direction);
                REQUIRE((a && b));
                CHECK(a->primitive == b->primitive);
                CHECK(a->t == Approx(b->t).epsilon(1e-5));
            }
        }
    }
}

TEST_CASE("traced scene: meshes without area, or empty, are harmless", "[accel]")
{
    const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    SceneBuilder builder;
    builder.add(newMesh(corners, {{0, 0, 0}}), lambert(Vec3(0.5f)));            // a point
    builder.add(newMesh(corners, {{0, 1, 3}, {0, 1, 1}}), lambert(Vec3(0.5f))); // lines
    builder.add(newMesh({}, {}), lambert(Vec3(0.5f)));
    builder.add(newMesh(corners, {}), lambert(Vec3(0.5f)));
    const uint32_t good =
        builder.add(newMesh(corners, {{0, 1, 3}, {0, 1, 2}, {2, 2, 2}}), lambert(Vec3(0.5f)));
    const auto traced = builder.build();
    const auto hit = shoot(*traced, Vec3(0.2f, 0.2f, 1), Vec3(0, 0, -1));
    REQUIRE(hit);
    CHECK(hit->instance == good);
    CHECK(hit->primitive == 1);
    CHECK_FALSE(shoot(*traced, Vec3(0.9f, 0.9f, 1), Vec3(0, 0, -1)));
    shoot(*traced, Vec3(0.5f, 0.0f, 1), Vec3(0, 0, -1)); // along the lines: it must not crash
}

TEST_CASE("traced scene: many equal triangles are one surface", "[accel]")
{
    std::vector<UVec3> triangles(20000, UVec3(0, 1, 2));
    SceneBuilder builder;
    builder.add(newMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::move(triangles)),
                lambert(Vec3(0.5f)));
    const auto traced = builder.build();
    const auto hit = shoot(*traced, Vec3(0.2f, 0.2f, 1), Vec3(0, 0, -1));
    REQUIRE(hit);
    CHECK(hit->t == Approx(1.0));
}

TEST_CASE("traced scene: placed meshes that did not change are not built again", "[accel]")
{
    const auto workers = std::make_shared<Workers>();
    SceneBuilder builder = placedBox(scaled(1, 1, 1));
    Instance second = builder.scene->instances[0];
    second.engineFromLocal.translation = Vec3(5, 0, 0);
    builder.scene->instances.push_back(second);
    auto first = TracedScene::build(builder.scene, workers);
    CHECK(first->statistics().builtMeshes == 1); // two instances, one mesh
    CHECK(first->statistics().embreeBytes > 0);

    auto moved = std::make_shared<Scene>(*builder.scene);
    moved->instances[1].engineFromLocal.translation = Vec3(9, 0, 0);
    auto next = TracedScene::build(moved, workers, first);
    CHECK(next->statistics().builtMeshes == 0);

    // The first traced scene is unchanged, and the next one outlives it.
    CHECK(shoot(*first, Vec3(5.1f, 0.2f, 5), Vec3(0, 0, -1)));
    CHECK_FALSE(shoot(*first, Vec3(9.1f, 0.2f, 5), Vec3(0, 0, -1)));
    first.reset();
    builder = SceneBuilder();
    CHECK(shoot(*next, Vec3(9.1f, 0.2f, 5), Vec3(0, 0, -1)));
    CHECK_FALSE(shoot(*next, Vec3(5.1f, 0.2f, 5), Vec3(0, 0, -1)));

    auto changed = std::make_shared<Scene>(*moved);
    changed->meshes[0] = boxMesh(Vec3(-2.0f), Vec3(2.0f));
    const auto third = TracedScene::build(changed, workers, next);
    CHECK(third->statistics().builtMeshes == 1);
    CHECK(shoot(*third, Vec3(10.9f, 0.2f, 5), Vec3(0, 0, -1)));
}
