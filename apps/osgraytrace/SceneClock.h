// SceneClock.h - brings a scene to a time, as a viewer does. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgViewer/Viewer>

namespace osgRayTrace::app
{

/// Runs the event and update traversals of a viewer without a window. The scene goes from time to
/// time without the frames between them: what moves by the time alone, as animations do, is where
/// a viewer shows it then.
class SceneClock
{
public:
    /// Brings the scene to the state of osgviewer's first frame before it is drawn, at time 0:
    /// slides are chosen, skeletons are posed, clocks are set.
    explicit SceneClock(osg::Node& scene);

    /// Brings the scene to another time [s]. Equal times change nothing.
    void goTo(double seconds);

private:
    void update(double seconds);

    osgViewer::Viewer _viewer;
    double _seconds = 0.0;
};

} // namespace osgRayTrace::app
