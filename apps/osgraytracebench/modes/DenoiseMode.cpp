// DenoiseMode.cpp - error and time of denoisers on three boxes. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/DenoiseMode.h"

#include "apps/common/ErrorMeasures.h"
#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/scenes/DenoiseScenes.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/denoise/Denoiser.h"

#include <cmath>
#include <memory>
#include <string>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kWidth = 320, kHeight = 180;
constexpr int kReferencePasses = 384;
constexpr uint32_t kReferenceSeed = 99;

/// Holds a scene, and renders pictures of it.
class Box
{
public:
    explicit Box(const BenchScene& box)
        : _view(box.view), _traced(TracedScene::build(box.scene, _workers))
    {
    }

    std::unique_ptr<RenderSession> render(int passes, uint32_t seed, int maxBounces = 8) const
    {
        auto session = std::make_unique<RenderSession>(_workers);
        RenderOptions options;
        options.integrator = IntegratorKind::Path;
        options.maxBounces = maxBounces;
        options.seed = seed;
        session->setScene(_traced);
        session->setView(_view);
        session->setOptions(options);
        StopRule rule;
        rule.passes = passes;
        session->render(rule);
        return session;
    }

    const Workers& workers() const { return *_workers; }

private:
    std::shared_ptr<Workers> _workers = std::make_shared<Workers>();
    View _view;
    std::shared_ptr<const TracedScene> _traced;
};

double relMse(const std::vector<float>& image, const std::vector<float>& reference)
{
    app::ErrorSum sum;
    for (std::size_t i = 0; i < image.size(); ++i)
        if (i % 4 != 3) sum.add(static_cast<double>(image[i]), static_cast<double>(reference[i]));
    return sum.measures().relMse;
}

/// Returns the function through which a denoiser asks for surfaces.
Denoiser::Surfaces surfacesOf(const RenderSession& session)
{
    return [&session]() -> const std::vector<SurfaceSample>& { return session.surfaceSamples(); };
}

void measureError(Rows& rows, const std::string& name, const BenchScene& scene)
{
    constexpr uint32_t kSeeds = 3;
    const Box box(scene);
    const std::vector<float> reference =
        box.render(kReferencePasses, kReferenceSeed)->resolveRadiance();
    for (const int passes : {1, 4})
    {
        double before = 0.0, after = 0.0, byOidn = 0.0;
        for (uint32_t seed = 1; seed <= kSeeds; ++seed)
        {
            const auto session = box.render(passes, seed);
            const ResolvedImage image = session->resolvedImage();
            before += relMse(image.radiance, reference) / kSeeds;
            const auto denoised = [&](DenoiseKind kind)
            {
                ResolvedImage copy = image;
                Denoiser denoiser;
                denoiser.denoise(copy, kind, surfacesOf(*session), box.workers());
                // A denoiser that took the place of kind does not count.
                return denoiser.report().by == kind ? relMse(copy.radiance, reference) : NAN;
            };
            after += denoised(DenoiseKind::Filter) / kSeeds;
            if (DenoiseOidn::isBuiltIn()) byOidn += denoised(DenoiseKind::Oidn) / kSeeds;
        }
        const std::string row =
            name + ", " + std::to_string(passes) + (passes == 1 ? " pass: " : " passes: ");
        rows.push_back({row + "relMSE", before, ""});
        rows.push_back({row + "relMSE, filtered", after, ""});
        rows.push_back({row + "relMSE / filtered", before / after, "times", Goal::AtLeast, 4.0});
        if (!DenoiseOidn::isBuiltIn()) continue;
        rows.push_back({row + "relMSE, Open Image Denoise", byOidn, ""});
        rows.push_back({row + "relMSE / Open Image Denoise", before / byOidn, "times"});
    }
}

/// Measures wall clock time: Open Image Denoise has threads of its own.
void measureOidnTime(Rows& rows)
{
    const Box box(cornellBox(1920, 1080));
    const auto session = box.render(1, 1, 1);
    const ResolvedImage image = session->resolvedImage();
    Denoiser denoiser;
    std::vector<double> times;
    for (int run = 0; run < 6; ++run)
    {
        ResolvedImage copy = image;
        const double time = secondsOf(
            [&]
            { denoiser.denoise(copy, DenoiseKind::Oidn, surfacesOf(*session), box.workers()); });
        if (run > 0) times.push_back(time); // the first run builds the network
    }
    const bool failed = denoiser.report().by != DenoiseKind::Oidn;
    rows.push_back(
        {"1920 x 1080, all threads: Open Image Denoise", failed ? NAN : 1e3 * median(times), "ms"});
}

/// Measures one thread's own time, which other programs on the machine hardly change, and the wall
/// clock time of two threads.
void measureTime(Rows& rows)
{
    constexpr int kRuns = 15;
    const Box box(cornellBox(1920, 1080));
    for (const int passes : {1, 2})
    {
        const auto session = box.render(passes, 1, 1);
        const std::vector<SurfaceSample> surfaces = session->surfaceSamples();
        const ResolvedImage image = session->resolvedImage();
        for (const int threads : {1, 2})
        {
            const Workers workers(threads);
            const Stopwatch stopwatch = stopwatchFor(threads);
            DenoiseFilter denoise;
            denoise.setSurfaces(surfaces, image.width, image.height, workers);
            std::vector<double> guides, filters;
            for (int run = 0; run < kRuns; ++run)
            {
                ResolvedImage copy = image;
                guides.push_back(stopwatch(
                    [&] { denoise.setSurfaces(surfaces, image.width, image.height, workers); }));
                filters.push_back(stopwatch([&] { denoise.filter(copy, workers); }));
            }
            const std::string row =
                "1920 x 1080, " + std::to_string(passes) + (passes == 1 ? " pass, " : " passes, ") +
                std::to_string(threads) + (threads == 1 ? " thread: " : " threads: ");
            rows.push_back({row + "the filter", 1e3 * median(filters), "ms"});
            if (passes == 1)
                rows.push_back({row + "guides of a new view", 1e3 * median(guides), "ms"});
        }
    }
}

} // namespace

void measureDenoise(Rows& rows)
{
    measureTime(rows);
    if (DenoiseOidn::isBuiltIn()) measureOidnTime(rows);
    measureError(rows, "diffuse", cornellBox(kWidth, kHeight));
    measureError(rows, "glossy", glossyBox(kWidth, kHeight));
    measureError(rows, "textured", texturedBox(kWidth, kHeight));
}

} // namespace osgRayTrace::bench
