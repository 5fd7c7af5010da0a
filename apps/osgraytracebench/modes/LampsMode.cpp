// LampsMode.cpp - error and cost of scenes with many lamps. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/LampsMode.h"

#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/scenes/LampScenes.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/shading/LightTable.h"

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kWidth = 256, kHeight = 160;
constexpr int kPasses = 16;

struct Rendered
{
    std::vector<float> luminance;
    double seconds = 0.0; ///< of one thread
};

Rendered render(const BenchScene& bench, const std::shared_ptr<const TracedScene>& traced,
                uint32_t seed)
{
    RenderSession session(std::make_shared<Workers>(1));
    session.setScene(traced);
    session.setView(bench.view);
    RenderOptions options;
    options.integrator = IntegratorKind::Path;
    options.seed = seed;
    session.setOptions(options);
    StopRule rule;
    rule.passes = kPasses;
    Rendered rendered;
    rendered.seconds = threadSecondsOf([&] { session.render(rule); });
    const std::vector<float> rgba = session.resolveRadiance();
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        rendered.luminance.push_back(luminance(Vec3(rgba[i], rgba[i + 1], rgba[i + 2])));
    return rendered;
}

/// Returns the mean of both images over 17 x 17 pixels around a pixel.
double meanAround(const std::vector<float>& a, const std::vector<float>& b, int x, int y)
{
    double sum = 0.0;
    int count = 0;
    for (int j = std::max(0, y - 8); j <= std::min(kHeight - 1, y + 8); ++j)
        for (int i = std::max(0, x - 8); i <= std::min(kWidth - 1, x + 8); ++i, ++count)
        {
            const auto at = static_cast<std::size_t>(j * kWidth + i);
            sum += 0.5 * (double(a[at]) + b[at]);
        }
    return sum / count;
}

/// Returns the relative mean square error of either of two independent images, without the worst
/// thousandth of the pixels. An error is relative to the mean around the pixel, or to a tenth of
/// the image's mean if that is more.
double relativeError(const std::vector<float>& a, const std::vector<float>& b)
{
    double mean = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        mean += 0.5 * (double(a[i]) + b[i]) / static_cast<double>(a.size());
    std::vector<double> errors;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
        {
            const auto at = static_cast<std::size_t>(y * kWidth + x);
            const double d = double(a[at]) - b[at];
            const double scale = std::max(meanAround(a, b, x, y), 0.1 * mean);
            errors.push_back(0.5 * d * d / (scale * scale));
        }
    std::sort(errors.begin(), errors.end());
    errors.resize(errors.size() - errors.size() / 1000);
    double sum = 0.0;
    for (const double e : errors)
        sum += e;
    return sum / static_cast<double>(errors.size());
}

/// Returns the seconds of one pass-for-pass image.
double measureImage(const std::string& name, const BenchScene& bench, double goal, Rows& rows)
{
    const auto traced = TracedScene::build(bench.scene, std::make_shared<Workers>(1));
    const Rendered a = render(bench, traced, 1), b = render(bench, traced, 2);
    const double seconds = 0.5 * (a.seconds + b.seconds);
    const double error = relativeError(a.luminance, b.luminance);
    rows.push_back({name + ": relMSE of 16 passes", error, ""});
    rows.push_back({name + ": one thread", seconds, "s"});
    const double pixels = 512.0 * 512.0 / (kWidth * kHeight);
    rows.push_back({name + ": relMSE x s, 512 x 512, two threads", error * seconds * pixels / 2,
                    "s", goal > 0.0 ? Goal::AtMost : Goal::None, goal});
    return seconds;
}

using Scenes = BenchScene (*)(int);

void measurePair(const std::string& name, Scenes scenes, double goal, Rows& rows)
{
    const double few = measureImage(name + ", 10 lamps", scenes(10), 0.0, rows);
    const double many = measureImage(name + ", 1,000 lamps", scenes(1000), goal, rows);
    rows.push_back({name + ": time of 1,000 lamps / 10", many / few, "", Goal::AtMost, 1.5});
}

void measureTable(Rows& rows)
{
    const auto scene = shiningSphere(1000000, Vec3(0.0f)),
               moved = shiningSphere(1000000, Vec3(1.0f));
    std::unique_ptr<const LightTable> built;
    rows.push_back({"million triangles: table of lights",
                    threadSecondsOf([&] { built = std::make_unique<LightTable>(*scene); }), "s",
                    Goal::AtMost, 1.0});
    std::unique_ptr<const LightTable> refitted;
    rows.push_back(
        {"million triangles: table after a move",
         threadSecondsOf([&] { refitted = std::make_unique<LightTable>(*moved, built.get()); }) *
             1e3,
         "ms", Goal::AtMost, 50.0});
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
