// PathImages.cpp - renders a scene in pairs of images, and compares the two. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/PathImages.h"

#include "apps/osgraytracebench/Timing.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/RenderSession.h"

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

struct Rendered
{
    int width = 0, height = 0;
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
    options.still = true;
    session.setOptions(options);
    StopRule rule;
    rule.passes = kImagePasses;
    Rendered rendered;
    rendered.width = bench.view.width;
    rendered.height = bench.view.height;
    rendered.seconds = threadSecondsOf([&] { session.render(rule); });
    const std::vector<float> rgba = session.resolveRadiance();
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        rendered.luminance.push_back(luminance(Vec3(rgba[i], rgba[i + 1], rgba[i + 2])));
    return rendered;
}

/// Returns the mean of both images over 17 x 17 pixels around a pixel.
double meanAround(const Rendered& a, const Rendered& b, int x, int y)
{
    double sum = 0.0;
    int count = 0;
    for (int j = std::max(0, y - 8); j <= std::min(a.height - 1, y + 8); ++j)
        for (int i = std::max(0, x - 8); i <= std::min(a.width - 1, x + 8); ++i, ++count)
        {
            const auto at = static_cast<std::size_t>(j * a.width + i);
            sum += 0.5 * (double(a.luminance[at]) + b.luminance[at]);
        }
    return sum / count;
}

/// Returns the relative mean square error of either of two independent images.
double relativeError(const Rendered& a, const Rendered& b)
{
    const auto count = static_cast<double>(a.luminance.size());
    double mean = 0.0;
    for (std::size_t i = 0; i < a.luminance.size(); ++i)
        mean += 0.5 * (double(a.luminance[i]) + b.luminance[i]) / count;
    std::vector<double> errors;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
        {
            const auto at = static_cast<std::size_t>(y * a.width + x);
            const double d = double(a.luminance[at]) - b.luminance[at];
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

} // namespace

ImageFigures measureImage(const std::string& name, const BenchScene& bench, double goal, Rows& rows,
                          int pairs)
{
    const auto traced = TracedScene::build(bench.scene, std::make_shared<Workers>(1));
    ImageFigures figures;
    for (int pair = 0; pair < pairs; ++pair)
    {
        const auto seed = static_cast<uint32_t>(2 * pair + 1);
        const Rendered a = render(bench, traced, seed), b = render(bench, traced, seed + 1);
        figures.seconds += 0.5 * (a.seconds + b.seconds) / pairs;
        figures.error += relativeError(a, b) / pairs;
    }
    const double pixels = 512.0 * 512.0 / (bench.view.width * bench.view.height);
    figures.product = figures.error * figures.seconds * pixels / 2;
    rows.push_back({name + ": relMSE of 16 passes", figures.error, ""});
    rows.push_back({name + ": one thread", figures.seconds, "s"});
    rows.push_back({name + ": relMSE x s, 512 x 512, two threads", figures.product, "s",
                    goal > 0.0 ? Goal::AtMost : Goal::None, goal});
    return figures;
}

} // namespace osgRayTrace::bench
