// KeyHandler.h - the keys that steer the ray tracer. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTracedScene>

#include <osg/ApplicationUsage>
#include <osgGA/GUIEventHandler>

namespace osgRayTrace::app
{

/// Changes the scene's settings in the event traversal, that is between frames.
class KeyHandler : public osgGA::GUIEventHandler
{
public:
    explicit KeyHandler(RayTracedScene* scene) : _scene(scene) {}

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;

    /// The keys, for the on-screen help and --help.
    void getUsage(osg::ApplicationUsage& usage) const override;

private:
    bool press(int key);
    void writeScreenshot() const;

    osg::ref_ptr<RayTracedScene> _scene;
};

} // namespace osgRayTrace::app
