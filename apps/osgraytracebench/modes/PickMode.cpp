// PickMode.cpp - times picks of RayIntersector and of osgUtil. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/PickMode.h"

#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/scenes/BenchScenes.h"
#include "apps/osgraytracebench/scenes/ObjectField.h"
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/bridge/update/SceneUpdater.h"

#include <osgRayTrace/RayIntersector>
#include <osgRayTrace/RayTracedScene>

#include <osg/KdTree>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <random>
#include <string>

namespace osgRayTrace::bench
{

namespace
{

struct Line
{
    osg::Vec3d start, end;
};

/// Returns lines from side to side of the bound, through its middle.
std::vector<Line> linesThrough(const osg::BoundingSphere& bound, int count)
{
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const auto direction = [&]
    {
        osg::Vec3d d(normal(random), normal(random), normal(random));
        d.normalize();
        return d;
    };
    std::vector<Line> lines;
    for (int i = 0; i < count; ++i)
    {
        const osg::Vec3d through =
            osg::Vec3d(bound.center()) + direction() * (0.5 * bound.radius());
        const osg::Vec3d along = direction() * (2.0 * bound.radius());
        lines.push_back({through - along, through + along});
    }
    return lines;
}

/// Culls once, as an application does: frames find the changes, and picks do not look for them.
void cullOnce(osg::Node& scene)
{
    osg::ref_ptr<osgUtil::CullVisitor> cull = new osgUtil::CullVisitor;
    cull->setStateGraph(new osgUtil::StateGraph);
    cull->setRenderStage(new osgUtil::RenderStage);
    cull->pushViewport(new osg::Viewport(0, 0, 64, 64));
    cull->pushProjectionMatrix(new osg::RefMatrix(osg::Matrixd::perspective(30.0, 1.0, 1.0, 1e4)));
    cull->pushModelViewMatrix(new osg::RefMatrix(osg::Matrixd::translate(0.0, 0.0, -100.0)),
                              osg::Transform::ABSOLUTE_RF);
    scene.accept(*cull);
}

/// Returns the seconds of a pick: the mean over the first count lines.
template <class Picker>
double secondsAPick(osg::Node& root, const std::vector<Line>& lines, int count, bool useKdTrees)
{
    std::size_t hits = 0;
    const double seconds = threadSecondsOf(
        [&]
        {
            for (int i = 0; i < count; ++i)
            {
                const osg::ref_ptr<Picker> picker = new Picker(lines[i].start, lines[i].end);
                picker->setIntersectionLimit(osgUtil::Intersector::LIMIT_NEAREST);
                osgUtil::IntersectionVisitor visitor(picker.get());
                visitor.setUseKdTreeWhenAvailable(useKdTrees);
                root.accept(visitor);
                hits += picker->containsIntersections();
            }
        });
    return hits == 0 ? 0.0 : seconds / count; // a row of 0: no pick hit anything
}

/// Returns the seconds of a ray along the lines in the engine, without any visitor.
double secondsARay(const engine::TracedScene& scene, const std::vector<Line>& lines)
{
    const auto vector = [](const osg::Vec3d& v)
    { return engine::Vec3(float(v.x()), float(v.y()), float(v.z())); };
    const double seconds = threadSecondsOf(
        [&]
        {
            for (const Line& line : lines)
            {
                osg::Vec3d along = line.end - line.start;
                const auto length = static_cast<float>(along.normalize());
                scene.intersector().closestHit(vector(line.start), vector(along), 0.0f, length);
            }
        });
    return seconds / static_cast<double>(lines.size());
}

void measure(Rows& rows, const std::string& name, osg::Node* content, int slowPicks)
{
    constexpr int kPicks = 20000, kTurns = 5;
    osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->addChild(content);
    const std::vector<Line> lines = linesThrough(content->getBound(), kPicks);
    osg::ref_ptr<osg::KdTreeBuilder> builder = new osg::KdTreeBuilder;
    rows.push_back({name + ": osg::KdTree built",
                    1e3 * threadSecondsOf([&] { content->accept(*builder); }), "ms"});

    cullOnce(*scene);
    rows.push_back({name + ": the first pick",
                    1e3 * secondsAPick<RayIntersector>(*scene, lines, 1, false), "ms"});
    secondsAPick<RayIntersector>(*scene, lines, 1, false);
    engine::SceneUpdater updater;
    updater.recordView(nullptr, nullptr, engine::ViewingConditions());
    updater.update(content, *scene->getSettings(), nullptr);
    const auto traced = updater.version().inputs.scene;

    std::vector<double> ours, plain, trees, rays, perPlain, perTree, perRay;
    for (int i = 0; i < kTurns; ++i)
    {
        ours.push_back(secondsAPick<RayIntersector>(*scene, lines, kPicks, false));
        plain.push_back(
            secondsAPick<osgUtil::LineSegmentIntersector>(*scene, lines, slowPicks, false));
        trees.push_back(
            secondsAPick<osgUtil::LineSegmentIntersector>(*scene, lines, kPicks / 10, true));
        rays.push_back(secondsARay(*traced, lines));
        perPlain.push_back(plain.back() / ours.back());
        perTree.push_back(trees.back() / ours.back());
        perRay.push_back(ours.back() / rays.back());
    }
    rows.push_back({name + ": RayIntersector", 1e6 * median(ours), "us/pick"});
    rows.push_back({name + ": osgUtil", 1e6 * median(plain), "us/pick"});
    rows.push_back({name + ": osgUtil with osg::KdTree", 1e6 * median(trees), "us/pick"});
    rows.push_back({name + ": the ray alone", 1e6 * median(rays), "us/ray"});
    rows.push_back(
        {name + ": osgUtil / RayIntersector", median(perPlain), "times", Goal::AtLeast, 20.0});
    rows.push_back(
        {name + ": osgUtil with osg::KdTree / RayIntersector", median(perTree), "times"});
    rows.push_back({name + ": RayIntersector / the ray alone", median(perRay), "times"});
}

} // namespace

void measurePicks(Rows& rows)
{
    measure(rows, "a million triangles", displacedSphereGeometry().get(), 20);
    const ObjectField field(false);
    measure(rows, "10,000 objects", field.root.get(), 50);
}

} // namespace osgRayTrace::bench
