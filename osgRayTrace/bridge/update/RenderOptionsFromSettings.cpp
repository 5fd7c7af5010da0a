// RenderOptionsFromSettings.cpp - the engine's options from the public settings. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/update/RenderOptionsFromSettings.h"

namespace osgRayTrace::engine
{

namespace
{

IntegratorKind integratorKind(RayTraceSettings::Integrator integrator)
{
    switch (integrator)
    {
    case RayTraceSettings::AUTOMATIC:
        return IntegratorKind::Automatic;
    case RayTraceSettings::WHITTED:
        return IntegratorKind::Whitted;
    case RayTraceSettings::PATH:
        return IntegratorKind::Path;
    case RayTraceSettings::PPM:
        return IntegratorKind::Ppm;
    case RayTraceSettings::SPPM:
        return IntegratorKind::Sppm;
    case RayTraceSettings::PHOTON_CAUSTICS:
        return IntegratorKind::PhotonCaustics;
    case RayTraceSettings::DEBUG:
        return IntegratorKind::Debug;
    }
    return IntegratorKind::Automatic;
}

LightSampling lightSampling(RayTraceSettings::LightSampling sampling)
{
    switch (sampling)
    {
    case RayTraceSettings::RANDOM:
        return LightSampling::Random;
    case RayTraceSettings::UNIFORM_JITTER:
        return LightSampling::UniformJitter;
    case RayTraceSettings::STRATIFIED:
        return LightSampling::Stratified;
    case RayTraceSettings::SOBOL:
        return LightSampling::Sobol;
    }
    return LightSampling::Sobol;
}

EnvironmentSampling environmentSampling(RayTraceSettings::EnvironmentSampling sampling)
{
    switch (sampling)
    {
    case RayTraceSettings::IMPORTANCE:
        return EnvironmentSampling::Importance;
    case RayTraceSettings::STRUCTURED:
        return EnvironmentSampling::Structured;
    case RayTraceSettings::UNIFORM:
        return EnvironmentSampling::Uniform;
    }
    return EnvironmentSampling::Importance;
}

DebugChannel debugChannel(RayTraceSettings::DebugChannel channel)
{
    switch (channel)
    {
    case RayTraceSettings::NORMAL:
        return DebugChannel::Normal;
    case RayTraceSettings::UV:
        return DebugChannel::Uv;
    case RayTraceSettings::ID:
        return DebugChannel::Id;
    case RayTraceSettings::ALBEDO:
        return DebugChannel::Albedo;
    case RayTraceSettings::DEPTH:
        return DebugChannel::Depth;
    case RayTraceSettings::DROPPED:
        return DebugChannel::Dropped;
    case RayTraceSettings::COST:
        return DebugChannel::Cost;
    }
    return DebugChannel::Normal;
}

} // namespace

ToneCurve toneCurve(RayTraceSettings::ToneCurve curve)
{
    switch (curve)
    {
    case RayTraceSettings::SRGB:
        return ToneCurve::Srgb;
    case RayTraceSettings::NEUTRAL:
        return ToneCurve::Neutral;
    case RayTraceSettings::AGX:
        return ToneCurve::Agx;
    }
    return ToneCurve::Srgb;
}

RenderOptions renderOptionsFromSettings(const RayTraceSettings& settings)
{
    RenderOptions options;
    options.integrator = integratorKind(settings.getIntegrator());
    options.lightSampling = lightSampling(settings.getLightSampling());
    options.debugChannel = debugChannel(settings.getDebugChannel());
    options.lightSamples = settings.getLightSamples();
    options.environmentSampling = environmentSampling(settings.getEnvironmentSampling());
    options.environmentSamples = settings.getEnvironmentSamples();
    options.maxBounces = settings.getMaxBounces();
    options.shadows = settings.getShadows();
    options.terminatorCorrection = settings.getTerminatorCorrection();
    options.aperture = settings.getAperture();
    options.focus = settings.getFocus();
    options.seed = settings.getSeed();
    options.photons = settings.getPhotons();
    options.photonRadius = settings.getPhotonRadius();
    options.photonAlpha = settings.getPhotonAlpha();
    options.photonBeams = settings.getPhotonBeams();
    options.radiusSchedule = settings.getRadiusSchedule() == RayTraceSettings::LOCAL
                                 ? RadiusSchedule::Local
                                 : RadiusSchedule::Global;
    options.photonGuiding = settings.getPhotonGuiding();
    return options;
}

ToneMap toneMapFromSettings(const RayTraceSettings& settings, const Scene& scene)
{
    ToneMap toneMap;
    toneMap.exposureEv = settings.getExposure();
    toneMap.displayReferred = scene.displayReferred;
    toneMap.curve = toneCurve(settings.getToneCurve());
    return toneMap;
}

void setVeiled(bool veils, const osg::Vec4& clearColor, ToneMap& toneMap)
{
    toneMap.veiled = veils && !toneMap.displayReferred && clearColor.a() >= 1.0f;
    for (int c = 0; c < 3; ++c)
        toneMap.background[c] = clearColor[c];
}

DenoiseKind denoiseKind(const RayTraceSettings& settings)
{
    if (settings.getIntegrator() == RayTraceSettings::DEBUG) return DenoiseKind::Off;
    switch (settings.getDenoise())
    {
    case RayTraceSettings::OFF:
        return DenoiseKind::Off;
    case RayTraceSettings::FILTER:
        return DenoiseKind::Filter;
    case RayTraceSettings::OIDN:
        return DenoiseKind::Oidn;
    }
    return DenoiseKind::Off;
}

void setInputs(ViewInputs& inputs, const RayTraceSettings& settings)
{
    inputs.options = renderOptionsFromSettings(settings);
    inputs.exposureEv = settings.getExposure();
    inputs.autoExposure = settings.getAutoExposure();
    inputs.toneCurve = toneCurve(settings.getToneCurve());
    inputs.denoise = denoiseKind(settings);
    // A pixel behind a lens shows more than the surface that a pinhole sees in it.
    const bool isPinhole = !(settings.getAperture() > 0.0f);
    inputs.reprojects = isPinhole && settings.getReproject();
    inputs.keepsUnchanged = isPinhole && settings.getKeepUnchanged();
    inputs.maxPasses = settings.getMaxPasses();
    inputs.passesPerFrame = settings.getPassesPerFrame();
}

} // namespace osgRayTrace::engine
