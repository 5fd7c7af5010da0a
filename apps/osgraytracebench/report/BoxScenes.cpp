// BoxScenes.cpp - views and methods for the scenes of data/. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/BoxScenes.h"

#include "apps/common/StoredView.h"
#include "data/generator/Scenes.h"
#include "osgRayTrace/bridge/common/HomeView.h"

namespace osgRayTrace::bench
{

namespace
{

constexpr double kFovyDegrees = 29.148431; ///< osgviewer's default
constexpr double kAspect = 4.0 / 3.0;

} // namespace

void useStoredView(ReportScene& scene)
{
    const app::Placement place = *app::storedPlacement(*scene.graph);
    const osg::BoundingSphere& bound = scene.graph->getBound();
    const double farthest =
        (place.eye - osg::Vec3d(bound.center())).length() + 2.0 * bound.radius();
    scene.view = osg::Matrixd::lookAt(place.eye, place.center, place.up);
    scene.projection =
        osg::Matrixd::perspective(place.fovyDegrees, scene.aspect, 1e-3 * farthest, farthest);
}

ReportScene cornellScene(CornellKind kind)
{
    ReportScene scene;
    switch (kind)
    {
    case CornellKind::Diffuse:
        scene.name = "cornell-diffuse";
        scene.title = "Cornell box";
        scene.graph = data::cornellBox(data::CornellVariant::Diffuse);
        break;
    case CornellKind::Mirror:
        scene.name = "cornell-mirror";
        scene.title = "Cornell box, the tall block a mirror";
        scene.graph = data::cornellBox(data::CornellVariant::TallMirror);
        break;
    case CornellKind::Glass:
        scene.name = "cornell-glass";
        scene.title = "Cornell box with a glass sphere";
        scene.graph = data::cornellBox(data::CornellVariant::GlassSphere);
        break;
    }
    useStoredView(scene);
    scene.methods = {pathMethod(100)};
    for (const Method& method : photonMethods(100, kind != CornellKind::Diffuse))
        scene.methods.push_back(method);
    scene.placements = {atOrigin(), displaced()};
    scene.reference = pathMethod(100);
    return scene;
}

ReportScene causticScene(CausticKind kind)
{
    constexpr int kBounces = 24, kMorePhotons = 4;
    ReportScene scene;
    switch (kind)
    {
    case CausticKind::Glasses:
        scene.name = "s8-glasses";
        scene.title = "S8: a glass sphere and a glass of water under a small lamp";
        scene.graph = data::glasses();
        break;
    case CausticKind::Rings:
        scene.name = "rings";
        scene.title = "Rings and their caustics in a looking-glass";
        scene.graph = data::rings();
        break;
    }
    scene.aspect = kAspect;
    useStoredView(scene);
    scene.methods = {pathMethod(kBounces)};
    for (const Method& method : photonMethods(kBounces, true))
        scene.methods.push_back(method);
    scene.placements = {atOrigin()};
    scene.reference = photonMethods(kBounces, true).back();
    scene.referencePhotons = kMorePhotons;
    scene.quick = false;
    return scene;
}

ReportScene gridsScene()
{
    ReportScene scene;
    scene.name = "grids";
    scene.title = "Lattices under an area light";
    scene.graph = data::grids();
    scene.aspect = kAspect;
    useStoredView(scene);
    scene.methods = directMethods();
    scene.placements = {atOrigin(), displaced()};
    scene.reference = whittedMethod(engine::LightSampling::Sobol, 16);
    return scene;
}

ReportScene modelScene(const std::string& name, osg::Node& graph, bool physical)
{
    ReportScene scene;
    scene.name = name;
    scene.title = name;
    scene.graph = &graph;
    scene.aspect = kAspect;
    if (app::storedPlacement(graph))
    {
        useStoredView(scene);
    }
    else
    {
        const engine::HomeView home = engine::homeView(graph, kFovyDegrees, kAspect);
        scene.view = home.view;
        scene.projection = home.projection;
    }
    scene.clearColor = app::storedClearColor(graph).value_or(osg::Vec4(0.2f, 0.2f, 0.4f, 1.0f));
    scene.headlight = true;
    scene.methods = {pathMethod(8)};
    if (!physical)
    {
        scene.methods = directMethods();
        scene.methods.pop_back(); // fixed-function surfaces have no paths
    }
    scene.placements = {atOrigin()};
    scene.reference = physical ? pathMethod(8) : whittedMethod(engine::LightSampling::Sobol, 16);
    return scene;
}

} // namespace osgRayTrace::bench
