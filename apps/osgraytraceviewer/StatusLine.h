// StatusLine.h - one line over the picture: what the ray tracer does. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "KeyHandler.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/Camera>
#include <osgGA/GUIEventHandler>
#include <osgText/Text>

#include <string>

namespace osgRayTrace::app
{

/// Shows statusText at the lower left of the window.
class StatusLine : public osgGA::GUIEventHandler
{
public:
    StatusLine(RayTracedScene* scene, const KeyHandler* keys);

    /// Returns the camera that has to be put into the graph, beside the scene.
    osg::Camera* camera() { return _camera.get(); }

    /// Renews the text once a frame, and follows the window's size.
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;

private:
    osg::ref_ptr<RayTracedScene> _scene;
    osg::ref_ptr<const KeyHandler> _keys;
    osg::ref_ptr<osg::Camera> _camera;
    osg::ref_ptr<osgText::Text> _text;
    std::string _shown;
};

/// Returns "path   37 of 1024 passes   12.4 M rays/s   error 1.8 %, median 1.1 %" and all that is
/// not as usual: a reduced resolution, an exposure, a denoiser, a view that is frozen or paused. If
/// there is no picture, it returns why.
std::string statusText(const RayTracedScene& scene, bool frozen);

/// Returns the text with line ends in place of some of its gaps of three blanks, so that lines have
/// no more columns if they can.
std::string wrapped(const std::string& text, double columns);

} // namespace osgRayTrace::app
