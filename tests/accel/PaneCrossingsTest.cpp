// PaneCrossingsTest.cpp - shadow rays pass panes within one query and keep where. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Rays.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/PaneCrossings.h"

#include <algorithm>
#include <limits>
#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

std::shared_ptr<Mesh> squareAt(float z)
{
    return quadMesh({-1, -1, z}, {2, 0, 0}, {0, 2, 0});
}

Material pane()
{
    Material material = glass(1.5f);
    MaterialDetail thin;
    thin.thinWalled = true;
    material.detail = std::make_shared<MaterialDetail>(thin);
    return material;
}

/// Rays downwards from z = 5; that of lane i is at x = 0.05 i + first.
RayBlock raysDown(float first)
{
    RayBlock rays;
    for (int i = 0; i < kLanes; ++i)
        setRay(rays, i, Vec3(first + 0.05f * float(i), 0.3f, 5.0f), Vec3(0, 0, -1));
    return rays;
}

/// Returns the distances at which lane i passes panes, in ascending order; Embree's round by a few
/// units of the last place, on some CPUs.
std::vector<float> distances(const PaneCrossings& crossings, const RayBlock& rays, int i)
{
    std::vector<float> found;
    for (int k = 0; k < kMostCrossings && ((crossings.beyond(k) >> i) & 1u); ++k)
    {
        RayHitBlock hits;
        crossings.hits(k, rays, hits);
        found.push_back(hits.ray.tFar[i]);
    }
    std::sort(found.begin(), found.end());
    return found;
}

/// All, few enough for single rays, and enough to be filled up with copies.
constexpr LaneMask kSomeLanes[] = {kAllLanes, 0x0810u, 0x7ffeu};

} // namespace

TEST_CASE("pane crossings: one query finds all panes of a ray, also of placed instances", "[accel]")
{
    SceneBuilder builder;
    for (const float z : {1.0f, 0.0f})
        builder.add(squareAt(z), pane());
    Instance placed = builder.scene->instances.back();
    placed.placed = true;
    placed.engineFromLocal.translation = Vec3(0.0f, 0.0f, -1.0f);
    builder.scene->instances.push_back(placed);
    builder.add(quadMesh({0, -1, -2}, {2, 0, 0}, {0, 2, 0}), lambert(Vec3(0.5f)));
    const auto traced = builder.build();

    for (const LaneMask active : kSomeLanes)
        for (const Coherence coherence : {Coherence::Coherent, Coherence::Incoherent})
        {
            RayBlock rays = raysDown(-0.425f); // of lanes 9 to 15 x > 0: they meet the wall
            PaneCrossings crossings;
            CHECK(traced->intersector().occlusion(rays, active, coherence, &crossings) == 0);
            CHECK(crossings.full() == 0);
            for (const int i : lanesIn(active))
            {
                CAPTURE(active, int(coherence), i);
                CHECK((rays.tFar[i] < 0.0f) == (i >= 9));
                if (i >= 9) continue;
                const std::vector<float> found = distances(crossings, rays, i);
                REQUIRE(found.size() == 3);
                for (std::size_t k = 0; k < 3; ++k)
                    CHECK(found[k] == Approx(4.0 + double(k)).epsilon(1e-6));
            }
            for (int k = 0; k < kMostCrossings; ++k)
                CHECK((crossings.beyond(k) & ~active) == 0);

            RayBlock stopped = raysDown(-0.425f);
            traced->intersector().occlusion(stopped, active, coherence);
            for (const int i : lanesIn(active))
                CHECK(stopped.tFar[i] < 0.0f); // without crossings the panes stop them
        }
}

TEST_CASE("pane crossings: rays that meet too many panes are told, the others are not touched",
          "[accel]")
{
    SceneBuilder builder;
    for (int i = 0; i < kMostCrossings; ++i)
        builder.add(squareAt(float(-i)), pane());
    builder.add(quadMesh({0, -1, 1}, {2, 0, 0}, {0, 2, 0}), pane());
    const auto traced = builder.build();
    RayBlock rays = raysDown(-0.425f);
    PaneCrossings crossings;
    traced->intersector().occlusion(rays, kAllLanes, Coherence::Incoherent, &crossings);
    CHECK(crossings.full() == 0xfe00u); // x > 0
    CHECK(crossings.beyond(kMostCrossings - 1) == kAllLanes);
    for (int i = 0; i < kLanes; ++i)
        CHECK((rays.tFar[i] < 0.0f) == (i >= 9));
}

TEST_CASE("pane crossings: rays through the common edge of two triangles pass once", "[accel]")
{
    SceneBuilder builder;
    builder.add(squareAt(0.0f), pane());
    const auto traced = builder.build();
    RayBlock rays;
    for (int i = 0; i < kLanes; ++i)
    {
        const float x = -0.75f + 0.09375f * float(i); // both diagonals of the square, exactly
        setRay(rays, i, Vec3(x, i % 2 ? x : -x, 5.0f), Vec3(0, 0, -1));
    }
    PaneCrossings crossings;
    traced->intersector().occlusion(rays, kAllLanes, Coherence::Incoherent, &crossings);
    CHECK(crossings.beyond(0) == kAllLanes);
    CHECK(crossings.beyond(1) == 0);
}

TEST_CASE("pane crossings: refused rays count as occluded", "[accel]")
{
    SceneBuilder builder;
    builder.add(squareAt(0.0f), pane());
    const auto traced = builder.build();
    RayBlock rays = raysDown(-0.425f);
    rays.directionZ[3] = std::numeric_limits<float>::quiet_NaN();
    PaneCrossings crossings;
    CHECK(traced->intersector().occlusion(rays, kAllLanes, Coherence::Incoherent, &crossings) ==
          1u << 3);
    CHECK(rays.tFar[3] < 0.0f);
    CHECK(crossings.beyond(0) == (kAllLanes & ~(1u << 3)));
}
