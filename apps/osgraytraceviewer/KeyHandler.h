// KeyHandler.h - the keys that steer the ray tracer. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "WindowPicture.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/ApplicationUsage>
#include <osgGA/CameraManipulator>
#include <osgGA/GUIEventHandler>
#include <osgViewer/View>

#include <set>

namespace osgRayTrace::app
{

/// Changes the scene's settings in the event traversal, that is between frames.
class KeyHandler : public osgGA::GUIEventHandler
{
public:
    explicit KeyHandler(RayTracedScene* scene) : _scene(scene), _windowPicture(new WindowPicture) {}

    /// Returns what has to be a final draw callback of the view's camera.
    WindowPicture* windowPicture() { return _windowPicture.get(); }

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;

    /// Adds the keys to the on-screen help and --help.
    void getUsage(osg::ApplicationUsage& usage) const override;

    /// Returns whether the view has to stay where it is, so that its image converges. The
    /// manipulator has been taken from the view; whoever else moves the view asks here.
    bool isFrozen() const { return _frozen; }

private:
    bool press(const osgGA::GUIEventAdapter& event, osgViewer::View* view);
    void freeze(osgViewer::View* view);
    void writeScreenshot() const;
    static void writeView(const osgViewer::View* view);
    void showNextCamera(osgViewer::View* view);
    static void printObject(const osgGA::GUIEventAdapter& event, osgViewer::View* view);

    osg::ref_ptr<RayTracedScene> _scene;
    osg::ref_ptr<WindowPicture> _windowPicture;
    bool _frozen = false;
    std::size_t _camera = 0; ///< number of the model's camera that is shown next
    std::set<int>
        _held; ///< keys whose press was handled here, in lower case: their release is, too
    osg::ref_ptr<osgGA::CameraManipulator> _manipulator; ///< taken from the view while it is frozen
};

} // namespace osgRayTrace::app
