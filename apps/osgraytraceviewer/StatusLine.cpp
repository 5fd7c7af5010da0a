// StatusLine.cpp - the text, its place and its plate. Layer: apps.
// SPDX-License-Identifier: MIT
#include "StatusLine.h"

#include "Overlay.h"

#include "apps/common/ErrorText.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace osgRayTrace::app
{

namespace
{

constexpr double kCharacterWidth = 0.66 * double(kOverlayCharacter); ///< of osgText's own font

template <class... Values> std::string format(const char* pattern, Values... values)
{
    char text[160];
    std::snprintf(text, sizeof(text), pattern, values...);
    return text;
}

} // namespace

StatusLine::StatusLine(RayTracedScene* scene, const KeyHandler* keys)
    : _scene(scene), _keys(keys), _text(newOverlayText())
{
    _text->setAlignment(osgText::Text::LEFT_BOTTOM_BASE_LINE);
    _camera = newOverlay(_text.get());
}

bool StatusLine::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    if (event.getEventType() != osgGA::GUIEventAdapter::FRAME) return false;
    fitOverlay(*_camera, action, 0.0);
    const auto* view = dynamic_cast<osgViewer::View*>(&action);
    const osg::Viewport* viewport = view ? view->getCamera()->getViewport() : nullptr;
    const double width = viewport ? viewport->width() - 2.0 * double(kOverlayMargin) : HUGE_VAL;
    const std::string text =
        wrapped(statusText(*_scene, _keys->isFrozen()), width / kCharacterWidth);
    if (text != _shown) _text->setText(text);
    _shown = text;
    return false;
}

std::string wrapped(const std::string& text, double columns)
{
    const std::string gap = "   ";
    std::string lines, line;
    for (std::size_t begin = 0; begin <= text.size();)
    {
        const std::size_t end = std::min(text.find(gap, begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        const std::string longer = line.empty() ? part : line + gap + part;
        const bool fits = static_cast<double>(longer.size()) <= columns;
        if (!fits && !line.empty()) lines += line + '\n';
        line = fits || line.empty() ? longer : part;
        begin = end + gap.size();
    }
    return lines + line;
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
        text +=
            format("   %.1f passes/s, %.1f M rays/s", statistics.passes / statistics.renderSeconds,
                   1e-6 * rays / statistics.renderSeconds);
    if (std::isfinite(statistics.relativeError))
        text += "   error " + errorText(statistics.relativeError) + ", median " +
                errorText(statistics.medianError);
    if (statistics.resolutionDivider > 1)
        text += format("   1/%d resolution", statistics.resolutionDivider);
    if (settings.getAutoExposure())
        text += format("   exposure %+.1f EV, automatic",
                       double(settings.getExposure()) + statistics.autoExposure);
    else if (settings.getExposure() != 0.0f)
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
