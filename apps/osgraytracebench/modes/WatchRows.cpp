// WatchRows.cpp - paired looks at an unchanged graph. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/WatchRows.h"

#include "apps/osgraytracebench/Timing.h"
#include "osgRayTrace/bridge/changes/GraphWatch.h"

#include <osg/Geometry>
#include <osg/MatrixTransform>

#include <algorithm>
#include <random>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kRuns = 61;
constexpr unsigned int kObjects = 40000;

osg::ref_ptr<osg::Group> scatteredGraph()
{
    std::vector<osg::ref_ptr<osg::MatrixTransform>> objects;
    for (unsigned int i = 0; i < kObjects; ++i)
    {
        objects.push_back(new osg::MatrixTransform(osg::Matrixd::translate(i % 200, i / 200, 0.0)));
        objects.back()->addChild(
            osg::createTexturedQuadGeometry(osg::Vec3(), osg::Vec3(1, 0, 0), osg::Vec3(0, 1, 0)));
    }
    std::shuffle(objects.begin(), objects.end(), std::mt19937(1));
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    for (const osg::ref_ptr<osg::MatrixTransform>& object : objects)
        root->addChild(object);
    return root;
}

} // namespace

void measureWatch(Rows& rows)
{
    const osg::ref_ptr<osg::Group> root = scatteredGraph();
    const ViewingConditions conditions;
    GraphWatch ahead, plain(false);
    ahead.record(*root, conditions);
    plain.record(*root, conditions);
    const PairedTimes times = timePair(
        kRuns, [&] { ahead.look(*root, conditions); }, [&] { plain.look(*root, conditions); },
        threadSecondsOf);
    const std::string name = "look at 40,000 scattered drawables";
    rows.push_back({name, times.first * 1e3, "ms"});
    rows.push_back({name + ": nothing fetched ahead", times.second * 1e3, "ms"});
    rows.push_back({name + " / nothing fetched ahead", times.ratio, "times", Goal::AtMost, 0.97});
}

} // namespace osgRayTrace::bench
