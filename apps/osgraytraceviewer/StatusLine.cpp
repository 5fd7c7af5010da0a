// StatusLine.cpp - the text, its place and its plate. Layer: apps.
// SPDX-License-Identifier: MIT
#include "StatusLine.h"

#include "apps/common/ErrorText.h"

#include <osg/Geode>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace osgRayTrace::app
{

namespace
{

constexpr double kMargin = 10.0;        // pixels
constexpr float kCharacterSize = 18.0f; // pixels
constexpr float kPlateMargin = 5.0f;    // pixels

osg::ref_ptr<osgText::Text> createText()
{
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setDataVariance(osg::Object::DYNAMIC);
    text->setCharacterSize(kCharacterSize);
    text->setPosition(osg::Vec3(kMargin, kMargin, 0.0f));
    // The plate is dark: outlines would close over decimal points.
    text->setDrawMode(osgText::Text::TEXT | osgText::Text::FILLEDBOUNDINGBOX);
    text->setBoundingBoxColor(osg::Vec4(0.0f, 0.0f, 0.0f, 0.75f));
    text->setBoundingBoxMargin(kPlateMargin);
    return text;
}

/// Returns a camera that draws over everything, in pixels, and is no part of the scene's depth
/// range.
osg::ref_ptr<osg::Camera> createOverlay(osg::Drawable* drawable)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setRenderOrder(osg::Camera::POST_RENDER);
    camera->setClearMask(0);
    camera->setAllowEventFocus(false);
    camera->setProjectionMatrixAsOrtho2D(0.0, 1280.0, 0.0, 1024.0);
    osg::StateSet* stateSet = camera->getOrCreateStateSet();
    const auto off = osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED;
    stateSet->setMode(GL_LIGHTING, off);
    stateSet->setMode(GL_DEPTH_TEST, off);
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(drawable);
    camera->addChild(geode.get());
    return camera;
}

template <class... Values> std::string format(const char* pattern, Values... values)
{
    char text[160];
    std::snprintf(text, sizeof(text), pattern, values...);
    return text;
}

} // namespace

StatusLine::StatusLine(RayTracedScene* scene, const KeyHandler* keys)
    : _scene(scene), _keys(keys), _text(createText())
{
    _camera = createOverlay(_text.get());
}

bool StatusLine::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter&)
{
    if (event.getEventType() == osgGA::GUIEventAdapter::RESIZE)
    {
        _camera->setProjectionMatrixAsOrtho2D(0.0, event.getWindowWidth(), 0.0,
                                              event.getWindowHeight());
        return false;
    }
    if (event.getEventType() != osgGA::GUIEventAdapter::FRAME) return false;
    const std::string text = statusText(*_scene, _keys->isFrozen());
    if (text != _shown) _text->setText(text);
    _shown = text;
    return false;
}

std::string statusText(const RayTracedScene& scene, bool frozen)
{
    if (!scene.getEnabled()) return frozen ? "rasterizer   frozen" : "rasterizer";
    const Statistics statistics = scene.getDrawable()->getStatistics();
    if (!statistics.ok) return statistics.message;

    const RayTraceSettings& settings = *scene.getSettings();
    const int most = settings.getMaxPasses();
    std::string text = format("%s   %d of %d passes", statistics.integrator.c_str(),
                              std::min(statistics.passes, most), most);
    if (statistics.passes >= most) text += ", done";
    const double rays = static_cast<double>(statistics.cameraRays + statistics.shadowRays +
                                            statistics.secondaryRays + statistics.photonRays);
    if (statistics.renderSeconds > 0.0)
        text += format("   %.1f M rays/s", 1e-6 * rays / statistics.renderSeconds);
    if (std::isfinite(statistics.relativeError))
        text += "   error " + errorText(statistics.relativeError) + ", median " +
                errorText(statistics.medianError);
    if (statistics.resolutionDivider > 1)
        text += format("   1/%d resolution", statistics.resolutionDivider);
    if (settings.getExposure() != 0.0f)
        text += format("   exposure %+g EV", double(settings.getExposure()));
    if (settings.getToneCurve() != RayTraceSettings::SRGB)
        text += "   " + settings.get("tone-curve") + " tones";
    if (settings.getDenoise() != RayTraceSettings::OFF && !statistics.denoiser.empty())
        text += format("   denoised by %s in %.1f ms", statistics.denoiser.c_str(),
                       statistics.denoiseMilliseconds);
    if (frozen) text += "   frozen";
    if (scene.getDrawable()->getPaused()) text += "   paused";
    return text;
}

} // namespace osgRayTrace::app
