// SceneClock.cpp - traversals of a viewer without a window. Layer: apps.
// SPDX-License-Identifier: MIT
#include "SceneClock.h"

#include <osgGA/EventVisitor>

namespace osgRayTrace::app
{

SceneClock::SceneClock(osg::Node& scene)
{
    _viewer.setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
    _viewer.setSceneData(&scene);
    update(0.0);
}

void SceneClock::goTo(double seconds)
{
    if (seconds != _seconds) update(seconds);
}

void SceneClock::update(double seconds)
{
    _seconds = seconds;
    _viewer.advance(seconds);
    _viewer.getFrameStamp()->setReferenceTime(seconds); // equal pictures for any speed

    // Viewer::eventTraversal does nothing without a window.
    const osg::ref_ptr<osgGA::GUIEventAdapter> frame = new osgGA::GUIEventAdapter;
    frame->setEventType(osgGA::GUIEventAdapter::FRAME);
    frame->setTime(seconds);
    const osg::ref_ptr<osgGA::EventVisitor> events = new osgGA::EventVisitor;
    events->setActionAdapter(&_viewer);
    events->setFrameStamp(_viewer.getFrameStamp());
    events->setTraversalNumber(_viewer.getFrameStamp()->getFrameNumber());
    events->addEvent(frame);
    _viewer.getSceneData()->accept(*events);
    _viewer.updateTraversal();
}

} // namespace osgRayTrace::app
