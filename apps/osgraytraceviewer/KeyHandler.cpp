// KeyHandler.cpp - reacts to the keys, and lists them. Layer: apps.
// SPDX-License-Identifier: MIT
#include "KeyHandler.h"

#include "FreeName.h"
#include "SettingSteps.h"
#include "ShownPlacement.h"

#include "apps/common/DrawnParts.h"
#include "apps/common/Failure.h"
#include "apps/common/ImageFile.h"
#include "apps/common/Output.h"
#include "apps/common/SceneNames.h"
#include "apps/common/ViewText.h"

#include <osgRayTrace/RayIntersector>

#include <osg/Notify>
#include <osgUtil/IntersectionVisitor>

#include <string>

namespace osgRayTrace::app
{

namespace
{

int lowerCase(int key)
{
    return key >= 'A' && key <= 'Z' ? key - 'A' + 'a' : key;
}

} // namespace

bool KeyHandler::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    if (event.getHandled()) return false;
    // Other handlers act on releases. If Shift is let go before F, the release is that of f, which
    // is osgViewer's key for full screen.
    if (event.getEventType() == osgGA::GUIEventAdapter::KEYUP)
        return _held.erase(lowerCase(event.getKey())) > 0;
    if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN) return false;
    if (!press(event, dynamic_cast<osgViewer::View*>(&action))) return false;
    _held.insert(lowerCase(event.getKey()));
    action.requestRedraw();
    return true;
}

bool KeyHandler::press(const osgGA::GUIEventAdapter& event, osgViewer::View* view)
{
    RayTraceSettings& settings = *_scene->getSettings();
    RayTraceDrawable& drawable = *_scene->getDrawable();
    switch (event.getKey())
    {
    case 'i':
        stepSetting(settings, "integrator", true);
        return true;
    case 'n':
        stepSetting(settings, "light-sampling", true);
        return true;
    case 'T':
        stepSetting(settings, "tone-curve", true);
        return true;
    case '+':
    case '=':
        stepSetting(settings, "exposure", true);
        return true;
    case '-':
        stepSetting(settings, "exposure", false);
        return true;
    case 'x':
        stepSetting(settings, "auto-exposure", true);
        return true;
    case 'g':
        stepSetting(settings, "ground", true);
        return true;
    case 'F':
        freeze(view);
        return true;
    case 'p':
        drawable.setPaused(!drawable.getPaused());
        return true;
    case 'r':
        _scene->setEnabled(!_scene->getEnabled());
        return true;
    case 'R':
        OSG_NOTICE << _scene->getConversionReport() << std::flush;
        return true;
    case 'c':
        writeScreenshot();
        return true;
    case 'C':
        _windowPicture->want();
        return true;
    case 'E':
        writeView(view);
        return true;
    case 'o':
        printObject(event, view);
        return true;
    case 'v':
        showNextCamera(view);
        return true;
    default:
        return false;
    }
}

/// Freezes or frees the view; a view without a manipulator keeps its matrices.
void KeyHandler::freeze(osgViewer::View* view)
{
    _frozen = !_frozen;
    if (!view) return;
    if (_frozen)
    {
        _manipulator = view->getCameraManipulator();
        view->setCameraManipulator(nullptr, false);
        return;
    }
    if (_manipulator) view->setCameraManipulator(_manipulator.get(), false);
    _manipulator = nullptr;
}

void KeyHandler::writeScreenshot() const
{
    const osg::ref_ptr<osg::Image> image = _scene->getDrawable()->getColorImage();
    if (!image)
    {
        OSG_WARN << "osgraytraceviewer: there is no ray traced picture yet" << std::endl;
        return;
    }
    const std::string name = freeName(".exr");
    try
    {
        writeImageFile(name, *image);
        OSG_NOTICE << "osgraytraceviewer: wrote " << name;
        if (const auto parts = partsDrawnByOsg(_scene->getDrawable()->getStatistics()))
            OSG_NOTICE << ", which lacks " << parts << " parts of the scene that OpenGL draws";
        OSG_NOTICE << std::endl;
    }
    catch (const Failure& failure)
    {
        OSG_WARN << "osgraytraceviewer: " << failure.what() << std::endl;
    }
}

/// Prints the view as options of osgraytrace and of this viewer, and writes it to a file.
void KeyHandler::writeView(const osgViewer::View* view)
{
    if (!view) return;
    const osg::Camera& camera = *view->getCamera();
    const std::string text = viewText(camera.getViewMatrix(), camera.getProjectionMatrix());
    const std::string name = freeName(".view");
    OSG_NOTICE << "osgraytraceviewer: " << text << std::endl;
    try
    {
        writeText(name, text + '\n');
        OSG_NOTICE << "osgraytraceviewer: wrote " << name << ", for --camera" << std::endl;
    }
    catch (const Failure& failure)
    {
        OSG_WARN << "osgraytraceviewer: " << failure.what() << std::endl;
    }
}

/// Goes to the next of the cameras that the model brings with it.
void KeyHandler::showNextCamera(osgViewer::View* view)
{
    if (!view || _frozen) return;
    const std::vector<NamedPlacement> cameras = namedPlacements(*_scene);
    if (cameras.empty())
    {
        OSG_NOTICE << "osgraytraceviewer: the model has no cameras" << std::endl;
        return;
    }
    const NamedPlacement& camera = cameras[_camera++ % cameras.size()];
    OSG_NOTICE << "osgraytraceviewer: camera " << camera.name << std::endl;
    showPlacement(camera.placement, *_scene, *view);
}

/// Prints the names of what is under the mouse, as a material file can use them.
void KeyHandler::printObject(const osgGA::GUIEventAdapter& event, osgViewer::View* view)
{
    if (!view) return;
    const osg::ref_ptr<RayIntersector> ray = new RayIntersector(
        osgUtil::Intersector::PROJECTION, event.getXnormalized(), event.getYnormalized());
    osgUtil::IntersectionVisitor visitor(ray);
    view->getCamera()->accept(visitor);
    OSG_NOTICE << (ray->containsIntersections() ? namesAlong(ray->getFirstIntersection().nodePath)
                                                : "nothing is under the mouse\n")
               << std::flush;
}

void KeyHandler::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("i", "Next integrator");
    usage.addKeyboardMouseBinding("n", "Next light sampling strategy");
    usage.addKeyboardMouseBinding("T", "Next tone curve");
    usage.addKeyboardMouseBinding("+", "Exposure half a stop up");
    usage.addKeyboardMouseBinding("-", "Exposure half a stop down");
    usage.addKeyboardMouseBinding("x", "Exposure by the mean of the picture, or as it is set");
    usage.addKeyboardMouseBinding("g", "Ground that shows shadows below the model, or none");
    usage.addKeyboardMouseBinding("p", "Pause and continue ray tracing");
    usage.addKeyboardMouseBinding("F",
                                  "Freeze the view, so that its image converges, and let it go");
    usage.addKeyboardMouseBinding("r", "Switch between ray tracer and rasterizer");
    usage.addKeyboardMouseBinding("R", "Print what is ray traced, and what is not");
    usage.addKeyboardMouseBinding("o", "Print the names of what is under the mouse");
    usage.addKeyboardMouseBinding("v", "Next camera of the model");
    usage.addKeyboardMouseBinding("c", "Write the picture's radiance to osgraytrace-N.exr");
    usage.addKeyboardMouseBinding("C", "Write what the window shows to osgraytrace-N.png");
    usage.addKeyboardMouseBinding(
        "E", "Print the view as options, and write it to osgraytrace-N.view for --camera");
}

} // namespace osgRayTrace::app
