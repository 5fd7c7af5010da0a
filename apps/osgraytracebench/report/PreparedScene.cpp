// PreparedScene.cpp - graph to session, the public way. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/PreparedScene.h"

#include "apps/osgraytracebench/Timing.h"
#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/common/ViewFromMatrices.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"
#include "osgRayTrace/scene/SceneDigest.h"

#include <osg/Light>
#include <osg/MatrixTransform>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

osg::ref_ptr<osg::Light> headlight()
{
    osg::ref_ptr<osg::Light> light = new osg::Light(0);
    light->setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    light->setDiffuse(osg::Vec4(0.8f, 0.8f, 0.8f, 1.0f));
    light->setSpecular(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    return light;
}

} // namespace

int heightOf(const ReportScene& scene, int width)
{
    return std::max(1, static_cast<int>(std::lround(width / scene.aspect)));
}

PreparedScene prepare(const ReportScene& scene, const Placement& placement, int width,
                      std::shared_ptr<Workers> workers)
{
    osg::ref_ptr<osg::MatrixTransform> world = new osg::MatrixTransform(placement.worldFromScene);
    world->addChild(scene.graph.get());
    const osg::Matrixd viewFromWorld = osg::Matrixd::inverse(placement.worldFromScene) * scene.view;

    PreparedScene result;
    result.workers = std::move(workers);
    result.view = viewFromMatrices(viewFromWorld, scene.projection, width, heightOf(scene, width));
    ConversionInput input;
    input.root = world.get();
    input.eye = osg::Matrixd::inverse(viewFromWorld).getTrans();
    input.origin = input.eye;
    input.clearColor = scene.clearColor;
    input.lightSizes = scene.lightSizes;
    if (scene.headlight) input.viewLight = headlight();
    result.buildSeconds = secondsOf(
        [&] {
            result.traced =
                TracedScene::build(SceneConverter().convert(input).scene, result.workers);
        });
    return result;
}

uint64_t hashOf(const PreparedScene& prepared, const Method& method)
{
    uint64_t value = sceneDigest(prepared.traced->scene());
    const auto add = [&value](const auto&... items)
    { ((value = fold(value, memoryHash(&items, sizeof items))), ...); };
    RenderOptions options = method.options;
    options.seed = 0; // the caller's part
    add(prepared.view.viewFromWorld, prepared.view.clipFromView, prepared.view.width,
        prepared.view.height);
    std::apply(add, options.restarting());
    return value;
}

std::unique_ptr<RenderSession> newSession(const PreparedScene& scene, const Method& method,
                                          uint32_t seed)
{
    auto session = std::make_unique<RenderSession>(scene.workers);
    RenderOptions options = method.options;
    options.seed = seed;
    options.still = true;
    session->setScene(scene.traced);
    session->setView(scene.view);
    session->setOptions(options);
    return session;
}

RenderProgress renderOn(RenderSession& session, const StopRule& rule)
{
    const RenderProgress progress = session.render(rule);
    if (!progress.status.ok()) throw EngineError(progress.status.code, progress.status.message);
    return progress;
}

Pixels pixelsOf(const RenderSession& session)
{
    const std::vector<float> rgba = session.resolveRadiance();
    Pixels pixels{session.width(), session.height(), {}};
    pixels.rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        pixels.rgb.insert(pixels.rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
    return pixels;
}

} // namespace osgRayTrace::bench
