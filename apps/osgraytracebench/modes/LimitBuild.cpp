// LimitBuild.cpp - graph to ready BVH against Embree's own build. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/ResidentBytes.h"
#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/modes/LimitMode.h"
#include "apps/osgraytracebench/scenes/BenchScenes.h"
#include "apps/osgraytracebench/yardsticks/BareTriangles.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"

#include <osg/Geode>
#include <osg/MatrixTransform>

#include <string>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kRuns = 9;

/// Copies the vertices and indices into Embree's buffers once, and builds.
void buildBare(RTCDevice device, const osg::Vec3Array& vertices,
               const osg::DrawElementsUInt& indices)
{
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = newBareTriangles(device, vertices, indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    rtcReleaseScene(scene);
}

struct Built
{
    ConversionResult conversion;
    std::shared_ptr<const TracedScene> traced;
};

Built buildGraph(osg::Node* graph, const std::shared_ptr<Workers>& workers)
{
    SceneConverter converter;
    ConversionInput input;
    input.root = graph;
    Built built;
    built.conversion = converter.convert(input);
    built.traced = TracedScene::build(built.conversion.scene, workers);
    return built;
}

} // namespace

void measureBuild(Rows& rows)
{
    const osg::ref_ptr<osg::Geometry> geometry = displacedSphereGeometry();
    const osg::ref_ptr<osg::Geode> graph = new osg::Geode;
    graph->addDrawable(geometry);
    const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry->getVertexArray());
    const auto& indices = static_cast<const osg::DrawElementsUInt&>(*geometry->getPrimitiveSet(0));
    const double triangles = static_cast<double>(indices.size() / 3);

    auto workers = std::make_shared<Workers>();
    RTCDevice device = rtcNewDevice(nullptr);
    const PairedTimes times = timePair(
        kRuns, [&] { buildGraph(graph, workers); }, [&] { buildBare(device, vertices, indices); });
    rtcReleaseDevice(device);
    rows.push_back({"1 M triangles: Embree's build and one copy", times.second * 1e3, "ms"});
    rows.push_back({"1 M triangles: graph to ready BVH", times.first * 1e3, "ms"});
    rows.push_back({"1 M triangles: graph / Embree", times.ratio, "times", Goal::AtMost, 1.5});

    // Below a transform the arrays cannot be shared: the engine has its own copy of them.
    osg::ref_ptr<osg::MatrixTransform> moved =
        new osg::MatrixTransform(osg::Matrix::translate(1, 2, 3));
    moved->addChild(graph);
    for (osg::Node* node :
         {static_cast<osg::Node*>(graph.get()), static_cast<osg::Node*>(moved.get())})
    {
        const std::string name =
            node == graph ? "1 M triangles, shared: " : "1 M triangles, moved: ";
        const double before = residentBytes();
        const Built built = buildGraph(node, workers);
        const double embree = static_cast<double>(built.traced->statistics().embreeBytes);
        rows.push_back({name + "Embree's memory", embree / triangles, "bytes/triangle"});
        rows.push_back({name + "memory beyond Embree's",
                        (residentBytes() - before - embree) / triangles, "bytes/triangle",
                        Goal::AtMost, 60.0});
    }
}

} // namespace osgRayTrace::bench
