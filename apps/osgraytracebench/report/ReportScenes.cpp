// ReportScenes.cpp - the list of scenes and methods. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/ReportScene.h"

#include "apps/osgraytracebench/report/BoxScenes.h"
#include "apps/osgraytracebench/report/CausticScenes.h"
#include "apps/osgraytracebench/report/ClosedScenes.h"
#include "apps/osgraytracebench/report/PlaneScenes.h"
#include "apps/osgraytracebench/report/SkyScenes.h"
#include "apps/osgraytracebench/report/SphereScenes.h"

namespace osgRayTrace::bench
{

using engine::IntegratorKind;
using engine::LightSampling;

Placement atOrigin()
{
    return {"origin", osg::Matrixd::identity()};
}

Placement displaced()
{
    return {"displaced", osg::Matrixd::translate(6378137.0, 0.0, 0.0)};
}

Method whittedMethod(LightSampling strategy, int lightSamples)
{
    Method method;
    method.options.integrator = IntegratorKind::Whitted;
    method.options.lightSampling = strategy;
    method.options.lightSamples = lightSamples;
    switch (strategy)
    {
    case LightSampling::Random:
        method.name = "WHITTED random";
        break;
    case LightSampling::UniformJitter:
        method.name = "WHITTED uniform jitter";
        break;
    case LightSampling::Stratified:
        method.name = "WHITTED stratified";
        break;
    case LightSampling::Sobol:
        method.name = "WHITTED Sobol";
        break;
    }
    return method;
}

Method pathMethod(int maxBounces)
{
    Method method;
    method.name = "PATH";
    method.options.integrator = IntegratorKind::Path;
    method.options.maxBounces = maxBounces;
    return method;
}

bool hasKernel(const Method& method)
{
    switch (method.options.integrator)
    {
    case IntegratorKind::Ppm:
    case IntegratorKind::Sppm:
    case IntegratorKind::PhotonCaustics:
        return true;
    case IntegratorKind::Automatic:
    case IntegratorKind::Whitted:
    case IntegratorKind::Path:
    case IntegratorKind::Debug:
        return false;
    }
    return false;
}

std::vector<Method> photonMethods(int maxBounces, bool caustics)
{
    Method ppm = pathMethod(maxBounces), sppm = ppm, photonCaustics = ppm;
    ppm.name = "PPM";
    ppm.options.integrator = IntegratorKind::Ppm;
    sppm.name = "SPPM";
    sppm.options.integrator = IntegratorKind::Sppm;
    photonCaustics.name = "PHOTON_CAUSTICS";
    photonCaustics.options.integrator = IntegratorKind::PhotonCaustics;
    if (!caustics) return {ppm, sppm};
    return {ppm, sppm, photonCaustics};
}

std::vector<Method> directMethods()
{
    constexpr int kSamples = 16;
    return {whittedMethod(LightSampling::Random, kSamples),
            whittedMethod(LightSampling::UniformJitter, kSamples),
            whittedMethod(LightSampling::Stratified, kSamples),
            whittedMethod(LightSampling::Sobol, kSamples), pathMethod(1)};
}

std::vector<ReportScene> reportScenes()
{
    return {squareLightScene(),
            hexagonLightScene(),
            axisEdgeScene(),
            rotatedEdgeScene(),
            roundBlockerScene(),
            sphereLightScene(),
            sunkenSphereScene(),
            furnaceScene(0.5),
            furnaceScene(0.9),
            integratingSphereScene(),
            flatMirrorScene(),
            nephroidScene(),
            sunnySkyScene(),
            cornellScene(CornellKind::Diffuse),
            cornellScene(CornellKind::Mirror),
            cornellScene(CornellKind::Glass),
            causticScene(CausticKind::Glasses),
            causticScene(CausticKind::Rings),
            gridsScene()};
}

} // namespace osgRayTrace::bench
