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

using Scenes = BenchScene (*)(int);

void measurePair(const std::string& name, Scenes scenes, double goal, Rows& rows)
{
    const double few = measureImage(name + ", 10 lamps", scenes(10), 0.0, rows).seconds;
    const double many = measureImage(name + ", 1,000 lamps", scenes(1000), goal, rows).seconds;
    rows.push_back({name + ": time of 1,000 lamps / 10", many / few, "", Goal::AtMost, 1.5});
}

void measureTable(Rows& rows)
{
    const auto scene = shiningSphere(1000000, Vec3(0.0f)),
               moved = shiningSphere(1000000, Vec3(1.0f));
    std::unique_ptr<const LightTable> table;
    const auto build = [&](const Scene& of, const Workers* workers)
    { table = std::make_unique<LightTable>(of, nullptr, nullptr, workers); };
    const std::string name = "million triangles: ";
    rows.push_back({name + "table of lights, one thread",
                    threadSecondsOf([&] { build(*scene, nullptr); }), "s", Goal::AtMost, 1.0});
    std::unique_ptr<const LightTable> refitted;
    const auto refit = [&](const Workers* workers)
    { refitted = std::make_unique<LightTable>(*moved, table.get(), nullptr, workers); };
    rows.push_back({name + "table after a move, one thread",
                    threadSecondsOf([&] { refit(nullptr); }) * 1e3, "ms"});
    const Workers workers;
    rows.push_back(
        {name + "table of lights, all threads", secondsOf([&] { build(*scene, &workers); }), "s"});
    refitted.reset();
    rows.push_back({name + "table after a move, all threads",
                    secondsOf([&] { refit(&workers); }) * 1e3, "ms", Goal::AtMost, 50.0});
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
