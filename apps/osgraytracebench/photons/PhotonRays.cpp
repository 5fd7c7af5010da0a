// PhotonRays.cpp - tracing photons against Embree alone on the same rays. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/Failure.h"
#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/photons/PhotonsMode.h"
#include "apps/osgraytracebench/report/BoxScenes.h"
#include "apps/osgraytracebench/report/PreparedScene.h"
#include "apps/osgraytracebench/yardsticks/BareEmbree.h"
#include "osgRayTrace/photons/PhotonTracer.h"

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr double kGoal = 0.60;
constexpr float kGuidedShare = 0.9f; ///< share of PhotonPasses for caustics

double millions(std::size_t rays, double seconds)
{
    return static_cast<double>(rays) / seconds * 1e-6;
}

void measureTracing(const std::string& name, CornellKind kind, PhotonUse use,
                    const PhotonsOptions& benchOptions, Rows& rows)
{
    const auto one = std::make_shared<Workers>(1);
    const auto all = std::make_shared<Workers>();
    const PreparedScene prepared = prepare(cornellScene(kind), atOrigin(), 16, one);
    const std::vector<Light>& lights = prepared.traced->scene().lights;
    const PhotonEmitter emitter(*prepared.traced, lights,
                                use == PhotonUse::Caustics ? kGuidedShare : 0.0f);
    PhotonPassOptions options;
    options.use = use;
    options.photons = 1u + static_cast<uint32_t>(benchOptions.photons) / 4;
    PhotonMemory memory; // passes share it, as those of a scene do
    const auto trace = [&](const Workers& workers)
    { return tracePhotons(*prepared.traced, lights, emitter, options, 1, workers, memory); };

    RecordedRays recorded;
    {
        RayRecorder recorder(recorded);
        trace(*one);
    }
    if (recorded.secondary.empty() && recorded.camera.empty())
        throw app::Failure(app::kCannotRender, "no photon was traced");
    const BarePackets packets(recorded);
    const PairedTimes modes = timePair(
        benchOptions.runs, [&] { packets.trace(*one); }, [&] { traceSingly(recorded, *one); },
        threadSecondsOf);
    const bool singly = modes.ratio > 1.0;
    const std::size_t rays =
        recorded.camera.size() + recorded.secondary.size() + recorded.shadow.size();
    rows.push_back({name + ": rays of a pass", static_cast<double>(rays) * 1e-6, "M"});
    for (const auto& workers : {one, all})
    {
        const PairedTimes times = timePair(
            benchOptions.runs,
            [&]
            {
                if (singly)
                    traceSingly(recorded, *workers);
                else
                    packets.trace(*workers);
            },
            [&] { trace(*workers); }, stopwatchFor(workers->threads()));
        const std::string threads = name + ", " + std::to_string(workers->threads()) + " threads";
        rows.push_back({threads + (singly ? ": bare single rays" : ": bare packets"),
                        millions(rays, times.first), "Mrays/s"});
        rows.push_back({threads + ": photons", millions(rays, times.second), "Mrays/s"});
        rows.push_back(
            {threads + ": photons / bare", times.ratio, "of bare rate", Goal::AtLeast, kGoal});
    }
}

} // namespace

void measurePhotonRays(const PhotonsOptions& options, Rows& rows)
{
    measureTracing("tracing, box", CornellKind::Diffuse, PhotonUse::Indirect, options, rows);
    measureTracing("tracing, box with mirror", CornellKind::Mirror, PhotonUse::Indirect, options,
                   rows);
    measureTracing("tracing, box with glass", CornellKind::Glass, PhotonUse::Indirect, options,
                   rows);
    measureTracing("tracing, caustics of glass", CornellKind::Glass, PhotonUse::Caustics, options,
                   rows);
}

} // namespace osgRayTrace::bench
