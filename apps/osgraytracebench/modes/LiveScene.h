// LiveScene.h - an updater whose frames are measured, and medians of what edits cost. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Timing.h"
#include "osgRayTrace/bridge/update/SceneUpdater.h"

#include <string>

namespace osgRayTrace::bench
{

constexpr int kRuns = 21;

/// Holds an updater on one thread; update() does the work of a frame.
class LiveScene
{
public:
    /// visitor: may run nodes that draw in cull alone; null: there are no such nodes.
    explicit LiveScene(osg::Node* root, osgUtil::CullVisitor* visitor = nullptr) : _root(root)
    {
        _settings->setThreads(1);
        _updater.recordView(nullptr, nullptr, engine::ViewingConditions(), visitor);
        update();
    }

    void update() { _updater.update(_root, *_settings, nullptr); }
    void setDirty() { _updater.setDirty(); }
    Statistics statistics() const { return _updater.statistics(); }

private:
    osg::Node* _root;
    osg::ref_ptr<RayTraceSettings> _settings = new RayTraceSettings;
    engine::SceneUpdater _updater;
};

inline double medianSeconds(const std::function<void()>& body)
{
    body();
    std::vector<double> seconds;
    for (int i = 0; i < kRuns; ++i)
        seconds.push_back(threadSecondsOf(body));
    return median(seconds);
}

inline void addPair(Rows& rows, const std::string& what, const std::string& yardstick,
                    const PairedTimes& times, double goal)
{
    rows.push_back({what, times.first * 1e3, "ms"});
    rows.push_back({what + ": " + yardstick, times.second * 1e3, "ms"});
    rows.push_back({what + " / " + yardstick, times.ratio, "times", Goal::AtMost, goal});
}

} // namespace osgRayTrace::bench
