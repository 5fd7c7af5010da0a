// StatisticsFromEngine.cpp - sets the public statistics from the engine's counts. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/update/StatisticsFromEngine.h"

#include "osgRayTrace/bridge/common/WarnOnce.h"

namespace osgRayTrace::engine
{

namespace
{

const char* integratorName(IntegratorKind kind)
{
    switch (kind)
    {
    case IntegratorKind::Automatic:
        return "auto";
    case IntegratorKind::Whitted:
        return "whitted";
    case IntegratorKind::Path:
        return "path";
    case IntegratorKind::Ppm:
        return "ppm";
    case IntegratorKind::Sppm:
        return "sppm";
    case IntegratorKind::PhotonCaustics:
        return "photon-caustics";
    case IntegratorKind::Debug:
        return "debug";
    }
    return "";
}

const char* noteText(PhotonNote note)
{
    switch (note)
    {
    case PhotonNote::None:
        return "";
    case PhotonNote::NoPower:
        return "no light has any power: no photons were emitted";
    case PhotonNote::NoneStored:
        return "photons were followed, but none met a surface that they could be stored on";
    case PhotonNote::RadiusLimited:
        return "photon-radius is limited: not below the spacing of floats in this scene, and not "
               "above the scene's own radius";
    case PhotonNote::Ended:
        return "photons have ended: the first passes saw next to nothing of their light, and paths "
               "find all light";
    }
    return "";
}

const char* noteText(MediumNote note)
{
    switch (note)
    {
    case MediumNote::None:
        return "";
    case MediumNote::PathsInstead:
        return "photons do not bring the light that media emit: path replaces integrators that "
               "need them for it";
    case MediumNote::SingleOnly:
        return "whitted has single scattering alone: path has all of the light in media";
    case MediumNote::DiffuseOnly:
        return "whitted shows subsurface scattering as plain diffuse reflection: path follows the "
               "light below surfaces";
    }
    return "";
}

std::string lightNote(const SampledLightCounts& lights)
{
    std::string note;
    if (lights.treeLights > 0)
        note = "there are many lights: a point takes " + std::to_string(lights.treeSamples) +
               " samples of " + std::to_string(lights.treeLights) +
               " lights, chosen by what they may send there; more passes lessen the noise";
    if (lights.sampledDeltaLights < lights.deltaLights)
        note += (note.empty() ? "" : "; ") + std::string("a pass samples ") +
                std::to_string(lights.sampledDeltaLights) + " of " +
                std::to_string(lights.deltaLights) +
                " directional lights, chosen by power and others in each pass";
    return note;
}

const char* denoiserName(DenoiseKind kind)
{
    switch (kind)
    {
    case DenoiseKind::Off:
        return "";
    case DenoiseKind::Filter:
        return "filter";
    case DenoiseKind::Oidn:
        return "oidn";
    }
    return "";
}

} // namespace

void setSceneStatistics(Statistics& statistics, const ConversionResult& conversion,
                        const TracedScene& traced)
{
    const Scene& scene = traced.scene();
    const BuildStatistics& build = traced.statistics();

    statistics.triangles = traced.traits().triangles;
    statistics.meshes = scene.meshes.size() - conversion.emptyMeshes;
    statistics.instances = scene.instances.size() - conversion.emptyInstances;
    statistics.lights = scene.lights.size();
    statistics.convertSeconds = conversion.seconds;
    statistics.buildSeconds = build.seconds;
    statistics.embreeBytes = build.embreeBytes;
    statistics.conversion = conversion.counts;
    statistics.conversionPaths = conversion.paths;
    if (build.invalidInstances > 0)
        statistics.conversion["instance.invalid-transform"] += build.invalidInstances;
}

void setImageStatistics(Statistics& statistics, const RenderProgress& progress)
{
    const bool hasPicture = progress.status.code == StatusCode::Cancelled && progress.passes > 0;
    statistics.ok = progress.status.ok() || hasPicture;
    statistics.message = progress.status.message;
    const bool ended = progress.photonNote == PhotonNote::Ended;
    statistics.integrator = integratorName(ended ? IntegratorKind::Path : progress.integrator);
    statistics.passes = progress.passes;
    statistics.imageShare = progress.imageShare;
    statistics.lightNote = lightNote(progress.lights);
    if (!statistics.lightNote.empty()) warnOnce(statistics.lightNote);
    statistics.renderSeconds = progress.seconds;
    statistics.relativeError = progress.error.relative;
    statistics.medianError = progress.error.median;
    statistics.worstErrorShare = progress.error.worstShare;
    statistics.cameraRays = progress.rays.camera;
    statistics.shadowRays = progress.rays.shadow;
    statistics.secondaryRays = progress.rays.secondary;
    statistics.photonRays = progress.rays.photon;
    statistics.storedPhotons = progress.storedPhotons;
    statistics.storedBeams = progress.storedBeams;
    statistics.storedPoints = progress.storedPoints;
    statistics.beamRadius = static_cast<double>(progress.beamRadius);
    statistics.photonBytes = progress.photonBytes;
    statistics.hitPointBytes = progress.hitPointBytes;
    statistics.photonNote = noteText(progress.photonNote);
    if (!statistics.photonNote.empty() && !ended) warnOnce(statistics.photonNote);
    statistics.photonRadius = static_cast<double>(progress.photonRadius);
    statistics.mediumNote = noteText(progress.mediumNote);
    if (!statistics.mediumNote.empty()) warnOnce(statistics.mediumNote);
    statistics.collisions = progress.collisions;
    statistics.cutWalks = progress.cutWalks;
    statistics.openWalks = progress.openWalks;
    if (progress.openWalks > 0)
        warnOnce("light below a surface with subsurface has left its mesh through a hole: it is "
                 "reflected there as by a diffuse surface");
    statistics.droppedSamples = progress.droppedSamples;
}

void setStageStatistics(Statistics& statistics, const StageReport& report)
{
    statistics.reprojectedShare = report.reprojectedShare;
    statistics.reprojectSeconds = report.reprojectSeconds;
    statistics.autoExposure = static_cast<double>(report.autoEv);
    setDenoiseStatistics(statistics, report.denoised, report.denoiseSeconds);
}

void setDenoiseStatistics(Statistics& statistics, const DenoiseReport& report, double seconds)
{
    statistics.denoiseMilliseconds = 1e3 * seconds;
    statistics.denoiser = denoiserName(report.by);
    statistics.denoiseNote = report.note;
    if (!report.note.empty()) warnOnce(report.note);
}

} // namespace osgRayTrace::engine
