// InstanceRays.cpp - ten thousand instances in the engine and in bare Embree. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/InstanceRays.h"

#include "apps/osgraytracebench/Timing.h"
#include "osgRayTrace/accel/Embree.h"
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstring>
#include <random>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kRuns = 15;
constexpr uint32_t kCount = 10000, kSide = 100;
constexpr int kPixels = 256; ///< pixels along a side; in squares of 4 x 4

/// Returns a ball with waves, of 1,000 triangles.
std::shared_ptr<const Mesh> wavyBall()
{
    constexpr uint32_t kColumns = 25, kRows = 20;
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;
    for (uint32_t j = 0; j <= kRows; ++j)
        for (uint32_t i = 0; i <= kColumns; ++i)
        {
            const float theta = kPi * float(j) / kRows, phi = 2.0f * kPi * float(i) / kColumns;
            const float radius = 0.5f + 0.05f * std::sin(5.0f * phi) * std::sin(4.0f * theta);
            positions.push_back(radius * Vec3(std::sin(theta) * std::cos(phi),
                                              std::sin(theta) * std::sin(phi), std::cos(theta)));
        }
    for (uint32_t j = 0; j < kRows; ++j)
        for (uint32_t i = 0; i < kColumns; ++i)
        {
            const uint32_t a = j * (kColumns + 1) + i, c = a + kColumns + 1;
            triangles.emplace_back(a, a + 1, c + 1);
            triangles.emplace_back(a, c + 1, c);
        }
    auto mesh = std::make_shared<Mesh>();
    positions.reserve(positions.size() + 1); // Embree reads past the last one
    mesh->positions = std::move(positions);
    mesh->triangles = std::move(triangles);
    return mesh;
}

std::shared_ptr<const Scene> instances(bool turned, std::mt19937& random)
{
    auto scene = std::make_shared<Scene>();
    scene->materials.emplace_back();
    scene->meshes.push_back(wavyBall());
    const auto number = [&random] { return float(random() >> 8) * 0x1p-24f; };
    for (uint32_t i = 0; i < kCount; ++i)
    {
        Instance instance;
        instance.placed = true;
        Affine& m = instance.engineFromLocal;
        if (turned)
        {
            const Vec3 axis(number() - 0.5f, number() - 0.5f, number() + 0.1f);
            m.linear =
                Mat3(glm::rotate(Mat4(1.0f), 6.0f * number(), axis)) * (0.7f + 0.6f * number());
            m.translation = 21.5f * Vec3(number(), number(), number());
        }
        else
            m.translation = 1.25f * Vec3(float(i % kSide), float(i / kSide), 0.0f);
        scene->instances.push_back(instance);
    }
    return scene;
}

/// Holds the field in Embree's own instances.
class BareInstances
{
public:
    explicit BareInstances(const Scene& scene) : _device(rtcNewDevice(nullptr))
    {
        const Mesh& mesh = *scene.meshes[0];
        _part = rtcNewScene(_device);
        rtcSetSceneFlags(_part, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry triangles = rtcNewGeometry(_device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   mesh.positions.data(), 0, sizeof(Vec3), mesh.positions.size());
        rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.triangles.data(), 0, sizeof(UVec3), mesh.triangles.size());
        add(_part, triangles, 0);
        rtcCommitScene(_part);
        _top = rtcNewScene(_device);
        rtcSetSceneFlags(_top, RTC_SCENE_FLAG_ROBUST);
        for (uint32_t i = 0; i < scene.instances.size(); ++i)
        {
            const Affine& m = scene.instances[i].engineFromLocal;
            float columns[12];
            std::memcpy(columns, &m.linear, 9 * sizeof(float));
            std::memcpy(columns + 9, &m.translation, 3 * sizeof(float));
            const RTCGeometry instance = rtcNewGeometry(_device, RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(instance, _part);
            rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
            add(_top, instance, i);
        }
        rtcCommitScene(_top);
    }
    ~BareInstances()
    {
        rtcReleaseScene(_top);
        rtcReleaseScene(_part);
        rtcReleaseDevice(_device);
    }
    BareInstances(const BareInstances&) = delete;
    BareInstances& operator=(const BareInstances&) = delete;

    RTCScene top() const { return _top; }

private:
    static void add(RTCScene scene, RTCGeometry geometry, uint32_t id)
    {
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
    }

    RTCDevice _device;
    RTCScene _part, _top;
};

using Packets = std::vector<RayBlock>;

void setRay(RayBlock& block, int lane, Vec3 origin, Vec3 direction)
{
    engine::setRay(block, lane, plainOf(origin), plainOf(direction), 1e-4f, kInfinity);
}

Packets cameraRays(bool turned)
{
    const Vec3 eye = turned ? Vec3(10.75f, -25.0f, 10.75f) : Vec3(62.0f, -12.0f, 30.0f);
    Packets packets;
    for (int y = 0; y < kPixels; y += 4)
        for (int x = 0; x < kPixels; x += 4)
        {
            RayBlock& block = packets.emplace_back();
            for (int i = 0; i < kLanes; ++i)
            {
                const float u = (float(x + i % 4) + 0.5f) / kPixels - 0.5f;
                const float v = (float(y + i / 4) + 0.5f) / kPixels - 0.5f;
                setRay(block, i, eye,
                       glm::normalize(turned ? Vec3(u, 1.0f, v) : Vec3(u, 1.0f, v - 0.45f)));
            }
        }
    return packets;
}

/// Returns rays in random directions from the ends of camera rays.
Packets scatteredRays(const TracedScene& traced, const Packets& camera, std::mt19937& random)
{
    Packets packets = camera;
    for (RayBlock& block : packets)
        for (int i = 0; i < kLanes; ++i)
        {
            const Vec3 origin(block.originX[i], block.originY[i], block.originZ[i]);
            const Vec3 d(block.directionX[i], block.directionY[i], block.directionZ[i]);
            const auto hit = traced.intersector().closestHit(origin, d, 0.0f, kInfinity);
            const float z = 2.0f * float(random() >> 8) * 0x1p-24f - 1.0f;
            const float phi = 2.0f * kPi * float(random() >> 8) * 0x1p-24f;
            const float r = std::sqrt(1.0f - z * z);
            setRay(block, i, origin + d * (hit ? 0.999f * hit->t : 20.0f),
                   Vec3(r * std::cos(phi), r * std::sin(phi), z));
        }
    return packets;
}

alignas(64) const
    int kAllValid[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

void traceBare(RTCScene scene, const Packets& packets, bool coherent)
{
    QueryArguments query(coherent, nullptr);
    RayHitBlock block;
    for (const RayBlock& rays : packets)
    {
        block.ray = rays;
        std::memset(&block.geometry, 0xff, sizeof(block.geometry));
        std::memset(&block.instance, 0xff, sizeof(block.instance));
        query.intersect(kAllValid, scene, reinterpret_cast<RTCRayHit16*>(&block));
    }
}

void traceOurs(const Intersector& intersector, const Packets& packets, Coherence coherence)
{
    RayHitBlock block;
    for (const RayBlock& rays : packets)
    {
        block.ray = rays;
        intersector.closestHits(block, kAllLanes, coherence);
    }
}

void traceBareSingly(RTCScene scene, const Packets& packets)
{
    QueryArguments query(false, nullptr);
    for (const RayBlock& rays : packets)
        for (int i = 0; i < kLanes; ++i)
        {
            RTCRayHit ray = {};
            ray.ray = {rays.originX[i],
                       rays.originY[i],
                       rays.originZ[i],
                       rays.tNear[i],
                       rays.directionX[i],
                       rays.directionY[i],
                       rays.directionZ[i],
                       0.0f,
                       rays.tFar[i],
                       0xffffffffu,
                       0,
                       0};
            ray.hit.geomID = ray.hit.instID[0] = kInvalid;
            query.intersect(scene, &ray);
        }
}

void traceOursSingly(const Intersector& intersector, const Packets& packets)
{
    for (const RayBlock& rays : packets)
        for (int i = 0; i < kLanes; ++i)
            intersector.closestHit({rays.originX[i], rays.originY[i], rays.originZ[i]},
                                   {rays.directionX[i], rays.directionY[i], rays.directionZ[i]},
                                   rays.tNear[i], rays.tFar[i]);
}

void shadowBare(RTCScene scene, const Packets& packets)
{
    QueryArguments query(false, nullptr);
    for (RayBlock block : packets)
        query.occluded(kAllValid, scene, reinterpret_cast<RTCRay16*>(&block));
}

void shadowOurs(const Intersector& intersector, const Packets& packets)
{
    for (RayBlock block : packets)
        intersector.occlusion(block, kAllLanes);
}

void measure(const std::string& name, bool turned, Rows& rows)
{
    std::mt19937 random(1);
    const auto scene = instances(turned, random);
    const auto traced = TracedScene::build(scene, std::make_shared<Workers>(1));
    const BareInstances bare(*scene);
    const Intersector& ours = traced->intersector();
    const Packets camera = cameraRays(turned);
    const Packets scattered = scatteredRays(*traced, camera, random);
    const auto add = [&](const char* kind, const std::function<void()>& first,
                         const std::function<void()>& second)
    {
        const PairedTimes times = timePair(kRuns, first, second, threadSecondsOf);
        rows.push_back({name + ": " + kind + " / Embree's instances", times.ratio, "times",
                        Goal::AtMost, 1.02});
    };
    add(
        "camera rays", [&] { traceOurs(ours, camera, Coherence::Coherent); },
        [&] { traceBare(bare.top(), camera, true); });
    add(
        "scattered rays", [&] { traceOurs(ours, scattered, Coherence::Incoherent); },
        [&] { traceBare(bare.top(), scattered, false); });
    add(
        "scattered rays singly", [&] { traceOursSingly(ours, scattered); },
        [&] { traceBareSingly(bare.top(), scattered); });
    add(
        "shadow rays", [&] { shadowOurs(ours, scattered); },
        [&] { shadowBare(bare.top(), scattered); });
}

} // namespace

void measureInstanceRays(Rows& rows)
{
    measure("10,000 instances apart", false, rows);
    measure("10,000 instances turned", true, rows);
}

} // namespace osgRayTrace::bench
