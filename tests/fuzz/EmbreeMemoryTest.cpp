// EmbreeMemoryTest.cpp - Embree is refused memory while it builds. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgRayTrace/accel/Embree.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/base/Status.h"

#include <atomic>
#include <deque>
#include <string>
#include <utility>

using namespace osgRayTrace::engine;

namespace
{

std::atomic<int64_t> untilRefused{-1}; ///< requests that are granted; negative: all
std::atomic<bool> refused{false};

/// The monitor that the engine asked for. It is kept because Embree calls it as long as a device
/// lives.
struct EngineMonitor
{
    RTCMemoryMonitorFunction function;
    void* data;
};
std::deque<EngineMonitor> engineMonitors;

bool refusingMonitor(void* self, ssize_t bytes, bool post)
{
    if (bytes > 0 && !post && untilRefused >= 0 && untilRefused.fetch_sub(1) == 0)
    {
        refused = true;
        return false;
    }
    const auto& monitor = *static_cast<const EngineMonitor*>(self);
    return !monitor.function || monitor.function(monitor.data, bytes, post);
}

/// Returns a scene with meshes of one instance each, and one with several instances.
std::shared_ptr<const Scene> meshes()
{
    auto scene = std::make_shared<Scene>();
    scene->materials.emplace_back();
    for (int m = 0; m < 3; ++m)
    {
        auto mesh = std::make_shared<Mesh>();
        std::vector<Vec3> positions;
        std::vector<UVec3> triangles;
        positions.reserve(3001);
        for (uint32_t i = 0; i < 1000; ++i)
        {
            const Vec3 corner(float(i % 10), float(i / 10 % 10), float(i / 100));
            for (const Vec3& offset : {Vec3(0.0f), Vec3(0.5f, 0.0f, 0.1f), Vec3(0.0f, 0.5f, 0.2f)})
                positions.push_back(corner + offset + Vec3(20.0f * float(m)));
            triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
        }
        mesh->positions = std::move(positions);
        mesh->triangles = std::move(triangles);
        scene->meshes.push_back(mesh);
    }
    for (uint32_t i = 0; i < 5; ++i)
    {
        Instance instance;
        instance.mesh = std::min(i, 2u);
        instance.placed = i >= 2;
        instance.engineFromLocal.translation = Vec3(float(i), 0.0f, 0.0f);
        scene->instances.push_back(instance);
    }
    return scene;
}

} // namespace

extern "C"
{
    void __real_rtcSetDeviceMemoryMonitorFunction(RTCDevice, RTCMemoryMonitorFunction, void*);

    // The function has default visibility, because the library, which is not wrapped, refers to
    // Embree's function, too.
    __attribute__((visibility("default"))) void
    __wrap_rtcSetDeviceMemoryMonitorFunction(RTCDevice device, RTCMemoryMonitorFunction function,
                                             void* data)
    {
        engineMonitors.push_back({function, data});
        __real_rtcSetDeviceMemoryMonitorFunction(device, refusingMonitor, &engineMonitors.back());
    }
}

TEST_CASE("stability 52: memory that Embree does not get is an error of the build, and no crash",
          "[stability][fuzz]")
{
    const auto scene = meshes();
    const auto workers = std::make_shared<Workers>(2);
    const auto built = TracedScene::build(scene, workers);
    int failures = 0;
    for (int n = 0;; ++n)
    {
        CAPTURE(n);
        refused = false;
        untilRefused = n;
        bool thrown = false;
        try
        {
            TracedScene::build(scene, workers);
        }
        catch (const EngineError& error)
        {
            thrown = true;
            REQUIRE(error.code() == StatusCode::OutOfMemory);
            REQUIRE(std::string(error.what()).find("memory") != std::string::npos);
        }
        untilRefused = -1;
        REQUIRE(thrown == refused);
        if (!refused) break;
        ++failures;
        REQUIRE(TracedScene::build(scene, workers)->statistics().builtMeshes == 3);
    }
    CHECK(failures > 3);
    // The scene that was built before is intact.
    CHECK(built->statistics().builtMeshes == 3);
}
