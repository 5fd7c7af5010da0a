// StatusLine.h - one line over the picture: what the ray tracer does. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTracedScene>

#include <osg/Camera>
#include <osgGA/GUIEventHandler>
#include <osgText/Text>

#include <string>

namespace osgRayTrace::app
{

/// Integrator, passes, rays a second and estimated error, at the lower left of the window.
class StatusLine : public osgGA::GUIEventHandler
{
public:
    explicit StatusLine(RayTracedScene* scene);

    /// To be put into the graph, beside the scene.
    osg::Camera* camera() { return _camera.get(); }

    /// Renews the text once a frame, and follows the window's size.
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;

private:
    osg::ref_ptr<RayTracedScene> _scene;
    osg::ref_ptr<osg::Camera> _camera;
    osg::ref_ptr<osgText::Text> _text;
    std::string _shown;
};

/// "path   37 passes   12.4 Mrays/s   error 1.8 %", or why there is no picture.
std::string statusText(const RayTracedScene& scene);

} // namespace osgRayTrace::app
