// LampsMode.cpp - error and cost of scenes with many lamps. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/LampsMode.h"

#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/modes/PathImages.h"
#include "apps/osgraytracebench/scenes/LampScenes.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/shading/LightTable.h"

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kWidth = 256, kHeight = 160;

/// Frames in which a mesh deforms, half of them with all threads.
constexpr int kFrames = 24;

using Scenes = BenchScene (*)(int);

/// Returns a scene whose first instance is placed by a transform.
std::shared_ptr<const Scene> placed(const std::shared_ptr<const Scene>& scene, Vec3 place)
{
    auto moved = std::make_shared<Scene>(*scene);
    moved->instances[0].placed = true;
    moved->instances[0].engineFromLocal.translation = place;
    return moved;
}

void measurePair(const std::string& name, Scenes scenes, double goal, Rows& rows)
{
    const double few = measureImage(name + ", 10 lamps", scenes(10), 0.0, rows).seconds;
    const double many = measureImage(name + ", 1,000 lamps", scenes(1000), goal, rows).seconds;
    rows.push_back({name + ": time of 1,000 lamps / 10", many / few, "", Goal::AtMost, 1.5});
}

/// Measures the table of lights of a million triangles, and what it takes after an edit: once with
/// no threads to help, in time of the processor, and once with all of them.
void measureTable(Rows& rows)
{
    const std::string name = "million triangles: ";
    const Workers workers;
    const auto build = [](const Scene& scene, const LightTable* before, const Workers* threads)
    { return std::make_unique<const LightTable>(scene, before, nullptr, threads); };
    const auto edit = [&](const std::string& what, const std::shared_ptr<const Scene>& scene,
                          const std::shared_ptr<const Scene>& edited)
    {
        std::unique_ptr<const LightTable> table = build(*scene, nullptr, &workers), next;
        const auto after = [&](const Workers* threads)
        { next = build(*edited, table.get(), threads); };
        rows.push_back(
            {name + what + ", one thread", threadSecondsOf([&] { after(nullptr); }) * 1e3, "ms"});
        next.reset();
        rows.push_back({name + what + ", all threads", secondsOf([&] { after(&workers); }) * 1e3,
                        "ms", Goal::AtMost, 50.0});
    };
    const auto deform =
        [&](const std::shared_ptr<const Scene>& scene, const std::shared_ptr<const Scene>& deformed)
    {
        const std::shared_ptr<const Scene> scenes[] = {scene, deformed};
        std::vector<double> alone, together;
        std::unique_ptr<const LightTable> table = build(*scene, nullptr, &workers);
        for (int frame = 1; frame <= kFrames; ++frame)
        {
            endIfInterrupted();
            const bool one = frame % 4 < 2;
            const Workers* const threads = one ? nullptr : &workers;
            std::unique_ptr<const LightTable> next;
            const auto refit = [&] { next = build(*scenes[frame % 2], table.get(), threads); };
            (one ? alone : together).push_back(one ? threadSecondsOf(refit) : secondsOf(refit));
            table = std::move(next);
        }
        const std::string what = name + "all corners move in each frame";
        rows.push_back({what + ", one thread", median(alone) * 1e3, "ms"});
        rows.push_back({what + ", all threads", median(together) * 1e3, "ms", Goal::AtMost, 50.0});
    };
    const auto still = shiningSphere(1000000, Vec3(0.0f));
    std::unique_ptr<const LightTable> table;
    rows.push_back({name + "table of lights, one thread",
                    threadSecondsOf([&] { table = build(*still, nullptr, nullptr); }), "s",
                    Goal::AtMost, 1.0});
    table.reset();
    rows.push_back({name + "table of lights, all threads",
                    secondsOf([&] { table = build(*still, nullptr, &workers); }), "s"});
    table.reset();
    edit("another edit", still, still);
    edit("all corners moved", still, shiningSphere(1000000, Vec3(1.0f)));
    deform(still, shiningSphere(1000000, Vec3(1.0f)));
    edit("moved by a transform", placed(still, Vec3(0.0f)), placed(still, Vec3(1.0f)));
}

} // namespace

void measureLamps(const std::string& only, Rows& rows)
{
    const auto wanted = [&](const std::string& name)
    { return name.find(only) != std::string::npos; };
    if (wanted("hall"))
        measurePair(
            "hall", [](int n) { return hall(n, kWidth, kHeight); }, 0.3, rows);
    if (wanted("rooms"))
        measurePair(
            "rooms", [](int n) { return bench::rooms(n, kWidth, kHeight); }, 0.15, rows);
    if (wanted("points"))
        measurePair(
            "hall of points", [](int n) { return hall(n, kWidth, kHeight, LampKind::Point); }, 0.3,
            rows);
    if (wanted("triangles"))
        measurePair(
            "hall of triangles",
            [](int n) { return hall(n, kWidth, kHeight, LampKind::Triangles); }, 0.3, rows);
    if (wanted("million")) measureTable(rows);
}

} // namespace osgRayTrace::bench
