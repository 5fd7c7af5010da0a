// IntersectorTest.cpp - only sound rays reach Embree, and packets find what single rays find.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Rays.h"
#include "tests/Statistics.h"

#include "osgRayTrace/accel/Embree.h"
#include "osgRayTrace/accel/Intersector.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

struct TestRay
{
    Vec3 origin, direction;
    float tNear = 0.0f, tFar = kInfinity;
};

void setRay(RayBlock& block, int lane, const TestRay& ray)
{
    test::setRay(block, lane, ray.origin, ray.direction, ray.tNear, ray.tFar);
}

/// Returns rays with each bad value in each field: every value for which Debian's Embree would end
/// the process, and more.
std::vector<TestRay> badRays()
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const TestRay good{Vec3(0.1f, 0.2f, 5.0f), Vec3(0, 0, -1)};
    std::vector<TestRay> rays;
    for (const float bad : {nan, kInfinity, -kInfinity, 1e20f, -1e20f, 3e38f})
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            rays.push_back(good);
            rays.back().origin[axis] = bad;
            rays.push_back(good);
            rays.back().direction[axis] = bad;
        }
    }
    for (const Vec3& direction : {Vec3(0.0f), Vec3(1e-30f), Vec3(0, 0, -1e-45f), Vec3(-0.0f)})
    {
        rays.push_back(good);
        rays.back().direction = direction;
    }
    for (const auto& [tNear, tFar] :
         {std::pair(nan, kInfinity), std::pair(0.0f, nan), std::pair(2.0f, 1.0f),
          std::pair(-1.0f, 5.0f), std::pair(0.0f, -kInfinity), std::pair(nan, nan)})
    {
        rays.push_back(good);
        rays.back().tNear = tNear;
        rays.back().tFar = tFar;
    }
    return rays;
}

/// Returns a box and an instance of it beside it, to be seen from (., ., 5) along -z.
SceneBuilder twoBoxes()
{
    SceneBuilder builder;
    builder.add(boxMesh(Vec3(-1.0f), Vec3(1.0f)), lambert(Vec3(0.5f)));
    const uint32_t placed = builder.add(boxMesh(Vec3(-1.0f), Vec3(1.0f)), lambert(Vec3(0.5f)));
    builder.scene->instances[placed].placed = true;
    builder.scene->instances[placed].engineFromLocal.translation = Vec3(3.0f, 0.0f, 0.0f);
    return builder;
}

TestRay randomRay(Uniform& random)
{
    const Vec3 origin(random.between(-3, 6), random.between(-3, 3), random.between(2, 5));
    const Vec3 target(random.between(-1.5, 4.5), random.between(-1.5, 1.5), random.between(-1, 1));
    return {origin, glm::normalize(target - origin), static_cast<float>(random.between(0, 0.5)),
            kInfinity};
}

/// A box and an instance of it beside it in an Embree scene of the test's own, so that packets of
/// all widths can be tried that Embree has for this CPU.
class EmbreeBoxes
{
public:
    EmbreeBoxes()
        : _device(rtcNewDevice(nullptr)),
          _prototype(rtcNewScene(_device)),
          _root(rtcNewScene(_device))
    {
        rtcSetSceneFlags(_prototype, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneFlags(_root, RTC_SCENE_FLAG_ROBUST);
        attachBox(_prototype);
        rtcCommitScene(_prototype);
        attachBox(_root);
        const RTCGeometry instance = rtcNewGeometry(_device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, _prototype);
        const float columns[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 0, 0};
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(instance);
        rtcAttachGeometryByID(_root, instance, 1);
        rtcReleaseGeometry(instance);
        rtcCommitScene(_root);
    }
    ~EmbreeBoxes()
    {
        rtcReleaseScene(_root);
        rtcReleaseScene(_prototype);
        rtcReleaseDevice(_device);
    }
    EmbreeBoxes(const EmbreeBoxes&) = delete;
    EmbreeBoxes& operator=(const EmbreeBoxes&) = delete;

    RTCScene root() const { return _root; }

    /// Returns the widths of which the engine hands packets to Embree, and 1. Embree without
    /// packets of sixteen traces such packets as streams, and traces their inactive lanes, too.
    std::vector<int> widths() const
    {
        std::vector<int> found{1};
        for (const auto& [width, property] :
             {std::pair(4, RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED),
              std::pair(8, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED),
              std::pair(16, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)})
            if (rtcGetDeviceProperty(_device, property)) found.push_back(width);
        return found;
    }

private:
    void attachBox(RTCScene scene) const
    {
        const RTCGeometry geometry = rtcNewGeometry(_device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   _mesh->positions.data(), 0, sizeof(Vec3),
                                   _mesh->positions.size());
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   _mesh->triangles.data(), 0, sizeof(UVec3),
                                   _mesh->triangles.size());
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, 0);
        rtcReleaseGeometry(geometry);
    }

    std::shared_ptr<Mesh> _mesh = boxMesh(Vec3(-1.0f), Vec3(1.0f));
    RTCDevice _device;
    RTCScene _prototype, _root;
};

struct Comparison
{
    int different = 0, hits = 0;
};

/// Compares the active lanes of a block of rays with the same rays traced singly.
Comparison compareHits(const Intersector& intersector, const TestRay (&rays)[kLanes], LaneMask mask,
                       Coherence coherence)
{
    RayHitBlock block;
    for (int i = 0; i < kLanes; ++i)
        setRay(block.ray, i, rays[i]);
    Comparison result;
    result.different += intersector.closestHits(block, mask, coherence) != 0;
    for (int i = 0; i < kLanes; ++i)
    {
        const auto single =
            intersector.closestHit(rays[i].origin, rays[i].direction, rays[i].tNear, rays[i].tFar);
        const bool found = block.geometry[i] != kInvalid;
        if (!((mask >> i) & 1u) || !single)
        {
            result.different += found;
            continue;
        }
        ++result.hits;
        const bool same =
            found && hitInstance(block.geometry[i], block.instance[i]) == single->instance &&
            block.primitive[i] == single->primitive &&
            std::abs(block.ray.tFar[i] - single->t) < 1e-5f &&
            std::abs(block.u[i] - single->u) < 1e-5f && std::abs(block.v[i] - single->v) < 1e-5f;
        result.different += !same;
    }
    return result;
}

/// Counts lanes whose occlusion is not that of the same ray alone, and inactive lanes whose ray has
/// changed.
int differentOcclusion(const Intersector& intersector, const TestRay (&rays)[kLanes], LaneMask mask,
                       Coherence coherence)
{
    RayBlock block;
    for (int i = 0; i < kLanes; ++i)
        setRay(block, i, rays[i]);
    int different = intersector.occlusion(block, mask, coherence) != 0;
    for (int i = 0; i < kLanes; ++i)
    {
        const TestRay& ray = rays[i];
        const bool expected = ((mask >> i) & 1u) &&
                              intersector.occluded(ray.origin, ray.direction, ray.tNear, ray.tFar);
        different += (block.tFar[i] == -kInfinity) != expected;
        different += block.originX[i] != ray.origin.x || block.directionX[i] != ray.direction.x;
    }
    return different;
}

} // namespace

TEST_CASE("intersector: rays that are not finite, zero or huge are refused, alone and in packets",
          "[accel]")
{
    const auto traced = twoBoxes().build();
    const Intersector& intersector = traced->intersector();
    const TestRay good{Vec3(0.1f, 0.2f, 5.0f), Vec3(0, 0, -1)};
    REQUIRE(intersector.closestHit(good.origin, good.direction, 0.0f, kInfinity));

    int index = 0;
    for (const TestRay& bad : badRays())
    {
        CAPTURE(index++, bad.origin.x, bad.origin.z, bad.direction.x, bad.direction.z, bad.tNear,
                bad.tFar);
        CHECK_FALSE(intersector.closestHit(bad.origin, bad.direction, bad.tNear, bad.tFar));
        CHECK(intersector.occluded(bad.origin, bad.direction, bad.tNear, bad.tFar));
        for (const Coherence coherence : {Coherence::Coherent, Coherence::Incoherent})
        {
            RayHitBlock block;
            for (int i = 0; i < kLanes; ++i)
                setRay(block.ray, i, i == 5 ? bad : good);
            CHECK(intersector.closestHits(block, kAllLanes, coherence) == 1u << 5);
            CHECK(block.geometry[5] == kInvalid);
            CHECK(block.geometry[4] == 0);
            CHECK(block.ray.tFar[6] == Approx(4.0));

            RayBlock shadow;
            for (int i = 0; i < kLanes; ++i)
                setRay(shadow, i, i == 5 ? bad : TestRay{Vec3(9, 9, 9), Vec3(0, 0, 1)});
            CHECK(intersector.occlusion(shadow, kAllLanes, coherence) == 1u << 5);
            CHECK(shadow.tFar[5] == -kInfinity);
            CHECK(shadow.tFar[4] == kInfinity);
        }
    }
}

TEST_CASE("intersector: a whole block of bad rays", "[accel]")
{
    const auto traced = twoBoxes().build();
    const std::vector<TestRay> bad = badRays();
    RayHitBlock block;
    for (int i = 0; i < kLanes; ++i)
        setRay(block.ray, i, bad[static_cast<std::size_t>(i)]);
    CHECK(traced->intersector().closestHits(block, kAllLanes, Coherence::Coherent) == kAllLanes);
    CHECK(traced->intersector().occlusion(block.ray, kAllLanes) == kAllLanes);
    CHECK(traced->intersector().occlusion(block.ray, kAllLanes, Coherence::Coherent) == kAllLanes);
}

TEST_CASE("intersector: packets of every width and mask find what single rays find", "[accel]")
{
    const EmbreeBoxes boxes;
    Uniform random(1);
    std::vector<LaneMask> masks{0u, kAllLanes, 1u, 0x8000u, 0xaaaau, 0xff00u, 0x0f0fu};
    for (int i = 0; i < 200; ++i)
        masks.push_back(static_cast<LaneMask>(random() * 65536.0f));
    for (const int width : boxes.widths())
    {
        const Intersector intersector(boxes.root(), width, 1e18f);
        int different = 0, hits = 0;
        for (const LaneMask mask : masks)
        {
            TestRay rays[kLanes];
            for (TestRay& ray : rays)
                ray = randomRay(random);
            for (const Coherence coherence : {Coherence::Coherent, Coherence::Incoherent})
            {
                const Comparison comparison = compareHits(intersector, rays, mask, coherence);
                different += comparison.different;
                hits += comparison.hits;
                different += differentOcclusion(intersector, rays, mask, coherence);
            }
        }
        CAPTURE(width);
        CHECK(different == 0);
        CHECK(hits > 1000);
    }
}

TEST_CASE("intersector: hits name the instance, tNear and tFar bound the search", "[accel]")
{
    const auto traced = twoBoxes().build();
    const Intersector& intersector = traced->intersector();
    const auto left = intersector.closestHit(Vec3(0.3f, 0.2f, 5), Vec3(0, 0, -1), 0.0f, kInfinity);
    const auto right = intersector.closestHit(Vec3(3.3f, 0.2f, 5), Vec3(0, 0, -1), 0.0f, kInfinity);
    REQUIRE((left && right));
    CHECK(left->instance == 0);
    CHECK(right->instance == 1);
    CHECK(left->t == Approx(4.0));
    CHECK(intersector.closestHit(Vec3(0.3f, 0.2f, 5), Vec3(0, 0, -1), 4.5f, kInfinity)->t ==
          Approx(6.0));
    CHECK_FALSE(intersector.closestHit(Vec3(0.3f, 0.2f, 5), Vec3(0, 0, -1), 0.0f, 3.9f));
    CHECK(intersector.occluded(Vec3(3.3f, 0.2f, 5), Vec3(0, 0, -1), 0.0f, 4.1f));
    CHECK_FALSE(intersector.occluded(Vec3(3.3f, 0.2f, 5), Vec3(0, 0, -1), 0.0f, 3.9f));
    CHECK_FALSE(intersector.occluded(Vec3(3.3f, 0.2f, 5), Vec3(0, 0, -1), 0.0f,
                                     0.0f)); // a light at the point
}
