// UnusedContent.cpp - paired updates with and without a cull visitor. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/UnusedContent.h"

#include "apps/osgraytracebench/modes/LiveScene.h"
#include "apps/osgraytracebench/scenes/ObjectField.h"

#include <osgUtil/RenderStage>

#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

constexpr int kPairs = 31;

/// Adds the ratio of the work of two updaters of one graph. Each is the first one in turn, because
/// the first fetches the graph into the caches.
template <class Work>
void addRatio(Rows& rows, const std::string& what, LiveScene& with, LiveScene& without,
              const Work& work)
{
    const auto first = [&] { work(with); };
    const auto second = [&] { work(without); };
    const double there = timePair(kPairs, first, second, threadSecondsOf).ratio;
    const double back = timePair(kPairs, second, first, threadSecondsOf).ratio;
    rows.push_back({"captures, none in the scene: " + what, std::sqrt(there / back), "of time",
                    Goal::AtMost, 1.01});
}

} // namespace

void measureUnusedContent(Rows& rows)
{
    const ObjectField field(true);
    const osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
    const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
    visitor->setRenderStage(stage);
    LiveScene with(field.root, visitor), without(field.root);
    addRatio(rows, "update at rest", with, without, [](LiveScene& live) { live.update(); });
    addRatio(rows, "conversion", with, without,
             [](LiveScene& live)
             {
                 live.setDirty();
                 live.update();
             });
}

} // namespace osgRayTrace::bench
