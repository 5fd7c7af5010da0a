// HitFilterTest.cpp - surfaces of opacity a stop a share a of all rays, and culled faces stop no
// camera rays.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Rays.h"

#include "osgRayTrace/accel/Intersector.h"

#include <random>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kRays = 40000;

Material blendedMaterial(float alpha)
{
    Material material;
    material.alpha = alpha;
    material.blended = true;
    return material;
}

std::shared_ptr<Mesh> paneAt(float z)
{
    return quadMesh({-1, -1, z}, {2, 0, 0}, {0, 2, 0});
}

/// Produces rays downwards through the square [-0.9, 0.9]^2.
struct RaySource
{
    std::mt19937 random{7};
    Vec3 origin()
    {
        std::uniform_real_distribution<float> uniform(-0.9f, 0.9f);
        const float x = uniform(random), y = uniform(random);
        return Vec3(x, y, 5.0f);
    }
};

/// The rays that were stopped, counted for each kind of query.
struct Stopped
{
    int single = 0, singleOccluded = 0, packets = 0, packetsOccluded = 0;
    bool agree = true; ///< all kinds of query gave the same answer for each ray
};

Stopped stopped(const TracedScene& traced, HitRule rule = {})
{
    Stopped result;
    RaySource source;
    const Intersector& intersector = traced.intersector();
    for (int k = 0; k < kRays; k += kLanes)
    {
        RayHitBlock closest;
        RayBlock shadow;
        bool single[kLanes];
        for (int i = 0; i < kLanes; ++i)
        {
            const Vec3 origin = source.origin();
            setRay(closest.ray, i, origin, {0, 0, -1});
            setRay(shadow, i, origin, {0, 0, -1});
            single[i] = intersector.closestHit(origin, {0, 0, -1}, 0.0f, kInfinity).has_value();
            result.single += single[i];
            result.singleOccluded += intersector.occluded(origin, {0, 0, -1}, 0.0f, kInfinity);
        }
        intersector.closestHits(closest, kAllLanes, Coherence::Coherent, rule);
        intersector.occlusion(shadow, kAllLanes);
        for (int i = 0; i < kLanes; ++i)
        {
            const bool hit = closest.geometry[i] != kInvalid;
            result.packets += hit;
            result.packetsOccluded += shadow.tFar[i] < 0.0f;
            if (!rule.culls && !rule.keepsBlended && !rule.fromLight)
                result.agree = result.agree && hit == single[i] && (shadow.tFar[i] < 0.0f) == hit;
        }
    }
    return result;
}

/// The count may be off by five standard deviations of the binomial distribution: a false alarm has
/// a probability of 6e-7.
bool isShare(int count, double share)
{
    return std::abs(count - kRays * share) <= 5.0 * std::sqrt(kRays * share * (1.0 - share));
}

} // namespace

TEST_CASE("filter: opacity is the share of the rays that stop, alike in packets and alone",
          "[accel]")
{
    for (const float alpha : {0.0f, 0.1f, 0.5f, 0.9f})
    {
        SceneBuilder builder;
        builder.add(paneAt(0.0f), blendedMaterial(alpha));
        const Stopped count = stopped(*builder.build());
        CAPTURE(alpha, count.single);
        CHECK(isShare(count.single, alpha));
        CHECK(count.single == count.singleOccluded);
        CHECK(count.agree);
    }
}

TEST_CASE("filter: surfaces behind each other decide apart, also instances of one mesh", "[accel]")
{
    SceneBuilder panes;
    for (const float z : {0.0f, -1.0f, -2.0f})
        panes.add(paneAt(z), blendedMaterial(0.3f));
    const Stopped apart = stopped(*panes.build());
    CAPTURE(apart.single);
    CHECK(isShare(apart.single, 1.0 - 0.7 * 0.7 * 0.7));

    SceneBuilder builder;
    const auto pane = paneAt(0.0f);
    builder.add(pane, blendedMaterial(0.3f));
    for (int i = 0; i < 2; ++i)
    {
        Instance instance = builder.scene->instances.front();
        instance.placed = true;
        instance.engineFromLocal.translation = Vec3(0.0f, 0.0f, -1.0f - float(i));
        builder.scene->instances.push_back(instance);
    }
    const Stopped count = stopped(*builder.build());
    CAPTURE(count.single);
    CHECK(isShare(count.single, 1.0 - 0.7 * 0.7 * 0.7));
    CHECK(count.agree);
}

TEST_CASE("filter: the alpha test has all of OpenGL's functions", "[accel]")
{
    const std::pair<AlphaTest, int> expected[] = {
        {AlphaTest::Never, 0},          {AlphaTest::Less, 1},    {AlphaTest::Equal, 2},
        {AlphaTest::LessOrEqual, 3},    {AlphaTest::Greater, 4}, {AlphaTest::NotEqual, 5},
        {AlphaTest::GreaterOrEqual, 6}, {AlphaTest::Always, 7}}; // bits: below, equal, above
    for (const auto& [test, bits] : expected)
        for (int k = 0; k < 3; ++k)
        {
            Material material;
            material.alphaTest = test;
            material.alphaReference = 0.5f;
            material.alpha = 0.25f * float(k + 1);
            SceneBuilder builder;
            builder.add(paneAt(0.0f), material);
            CAPTURE(int(test), k);
            CHECK(stopped(*builder.build()).single == ((bits >> k & 1) ? kRays : 0));
        }
}

TEST_CASE("filter: camera rays pass culled faces, other rays meet them unless told otherwise",
          "[accel]")
{
    struct Case
    {
        FaceCulling culling;
        bool passes;
    };
    for (const bool forAll : {false, true})
        for (const bool clockwise : {false, true})
            for (const auto& [culling, passes] :
                 {Case{FaceCulling::None, false}, Case{FaceCulling::Back, clockwise},
                  Case{FaceCulling::Front, !clockwise}, Case{FaceCulling::FrontAndBack, true}})
            {
                Material material;
                material.culling = culling;
                material.clockwise = clockwise;
                material.cullsAllRays = forAll;
                SceneBuilder builder;
                builder.add(paneAt(0.0f), material); // its counter-clockwise side faces the rays
                const auto traced = builder.build();
                const Stopped count = stopped(*traced, kCameraRays);
                CAPTURE(int(culling), clockwise, forAll);
                const int others = passes && forAll ? 0 : kRays;
                CHECK(count.packets == (passes ? 0 : kRays));
                CHECK(count.packetsOccluded == others);
                CHECK(count.single == others);
                CHECK(count.singleOccluded == others);
                // Photons meet both sides of a one-sided face: the photon tracer decides what the
                // face does.
                const bool isThere = !forAll || culling != FaceCulling::FrontAndBack;
                CHECK(stopped(*traced, kPhotonRays).packets == (isThere ? kRays : 0));
            }
}

TEST_CASE("filter: what is hidden from the camera stops all other rays, whatever is edited",
          "[accel]")
{
    // A second instance of the mesh, which the rays do not meet, is never hidden.
    for (const bool placed : {false, true})
        for (const float alpha : {1.0f, 0.5f})
        {
            CAPTURE(placed, alpha);
            SceneBuilder builder;
            builder.add(paneAt(0.0f), alpha < 1.0f ? blendedMaterial(alpha) : Material());
            Instance instance = builder.scene->instances.front();
            instance.placed = placed;
            Instance other = instance;
            other.material = static_cast<uint32_t>(builder.scene->materials.size());
            builder.scene->materials.push_back(Material());
            other.placed = true;
            other.engineFromLocal.translation = Vec3(5.0f, 0.0f, 0.0f);
            builder.scene->instances = {instance, other};

            const auto workers = std::make_shared<Workers>(1);
            std::shared_ptr<const TracedScene> traced;
            for (const bool hidden : {true, false, true})
            {
                auto edited = std::make_shared<Scene>(*builder.scene);
                edited->materials[instance.material].culling =
                    hidden ? FaceCulling::FrontAndBack : FaceCulling::None;
                traced = TracedScene::build(edited, workers, traced);
                const Stopped camera = stopped(*traced, kCameraRays);
                CAPTURE(hidden);
                CHECK(isShare(camera.packets, hidden ? 0.0 : alpha));
                CHECK(isShare(camera.single, alpha)); // rays of no camera
                CHECK(isShare(camera.packetsOccluded, alpha));
                CHECK(isShare(camera.singleOccluded, alpha));
                HitRule solid = kCameraRays;
                solid.solid = true;
                CHECK(stopped(*traced, solid).packets == kRays);
                CHECK(traced->intersector()
                          .closestHit({5.0f, 0.0f, 1.0f}, {0, 0, -1}, 0.0f, kInfinity, kCameraRays)
                          .has_value());
            }
        }
}

TEST_CASE("filter: rays that keep blended surfaces meet them all, but not what cannot be seen",
          "[accel]")
{
    for (const float alpha : {0.0f, 0.01f, 0.5f})
    {
        SceneBuilder builder;
        builder.add(paneAt(0.0f), blendedMaterial(alpha));
        CHECK(stopped(*builder.build(), {false, true}).packets == (alpha > 0.0f ? kRays : 0));
    }
}

TEST_CASE("filter: what became opaque stops everything, though its mesh was filtered before",
          "[accel]")
{
    SceneBuilder builder;
    builder.add(paneAt(0.0f), blendedMaterial(0.5f));
    Instance instance = builder.scene->instances.front();
    instance.placed = true;
    builder.scene->instances = {instance, instance};
    builder.scene->instances[1].engineFromLocal.translation = Vec3(5.0f, 0.0f, 0.0f);
    const auto before = builder.build();
    CHECK(isShare(stopped(*before).single, 0.5));
    auto edited = std::make_shared<Scene>(*builder.scene);
    for (Material& material : edited->materials)
        material.alpha = 1.0f;
    const auto workers = std::make_shared<Workers>(1);
    const auto after = TracedScene::build(edited, workers, before);
    CHECK(stopped(*after).single == kRays);
    const auto again = TracedScene::build(builder.scene, workers, after);
    CHECK(isShare(stopped(*again).single, 0.5));
}
