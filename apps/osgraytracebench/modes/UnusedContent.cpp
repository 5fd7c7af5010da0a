// UnusedContent.cpp - paired updates with and without a cull visitor. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/modes/UnusedContent.h"

#include "apps/osgraytracebench/modes/LiveScene.h"
#include "apps/osgraytracebench/scenes/ObjectField.h"

#include <osgUtil/RenderStage>

namespace osgRayTrace::bench
{

namespace
{

constexpr int kPairs = 61;

void addRatio(Rows& rows, const std::string& what, const PairedTimes& times)
{
    rows.push_back(
        {"captures, none in the scene: " + what, times.ratio, "of time", Goal::AtMost, 1.01});
}

} // namespace

void measureUnusedContent(Rows& rows)
{
    const ObjectField field(true);
    const osg::ref_ptr<osgUtil::CullVisitor> visitor = new osgUtil::CullVisitor;
    const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
    visitor->setRenderStage(stage);
    LiveScene with(field.root, visitor), without(field.root);
    addRatio(rows, "update at rest",
             timePair(
                 kPairs, [&] { with.update(); }, [&] { without.update(); }, threadSecondsOf));
    const auto convert = [](LiveScene& live)
    {
        live.setDirty();
        live.update();
    };
    addRatio(rows, "conversion",
             timePair(
                 kPairs, [&] { convert(with); }, [&] { convert(without); }, threadSecondsOf));
}

} // namespace osgRayTrace::bench
