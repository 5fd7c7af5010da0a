// SettingsPanel.cpp - rows of settings, and what arrows and clicks do to them. Layer: apps.
// SPDX-License-Identifier: MIT
#include "SettingsPanel.h"

#include "Overlay.h"
#include "SettingSteps.h"

namespace osgRayTrace::app
{

namespace
{

using Key = osgGA::GUIEventAdapter;

const char* const kRows[] = {"integrator", "light-sampling", "light-samples", "max-bounces",
                             "max-passes", "denoise",        "exposure",      "auto-exposure",
                             "tone-curve", "ground"};
constexpr std::size_t kRowCount = sizeof kRows / sizeof kRows[0];
constexpr std::size_t kNameWidth = 17;
constexpr float kLineHeight = kOverlayCharacter; ///< of osgText with its default spacing
constexpr float kWidth = 340.0f;                 ///< of the part that takes clicks [pixels]
const char* const kTitle = "Settings: arrows or clicks change them, Tab closes";

} // namespace

SettingsPanel::SettingsPanel(RayTracedScene* scene) : _scene(scene), _text(newOverlayText())
{
    _text->setAlignment(osgText::Text::LEFT_TOP);
    _camera = newOverlay(_text.get());
    _camera->setNodeMask(0u);
}

std::vector<std::string> SettingsPanel::lines() const
{
    std::vector<std::string> lines{kTitle};
    for (std::size_t row = 0; row < kRowCount; ++row)
    {
        const std::string name = kRows[row];
        const std::string gap(kNameWidth - name.size(), ' ');
        lines.push_back((row == _row ? "> " : "  ") + name + gap + "< " +
                        _scene->getSettings()->get(name) + " >");
    }
    return lines;
}

bool SettingsPanel::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    switch (event.getEventType())
    {
    case Key::FRAME:
        _height = static_cast<float>(fitOverlay(*_camera, action, _height));
        show(); // other keys change settings, too
        return false;
    case Key::KEYDOWN:
        if (event.getHandled() || !press(event.getKey())) return false;
        action.requestRedraw();
        return true;
    case Key::PUSH:
        if (event.getHandled() || !_open || !click(event)) return false;
        action.requestRedraw();
        return true;
    default:
        return false;
    }
}

bool SettingsPanel::press(int key)
{
    if (key == Key::KEY_Tab)
    {
        _open = !_open;
        _camera->setNodeMask(_open ? ~0u : 0u);
        return true;
    }
    if (!_open) return false;
    switch (key)
    {
    case Key::KEY_Up:
        _row = (_row + kRowCount - 1) % kRowCount;
        return true;
    case Key::KEY_Down:
        _row = (_row + 1) % kRowCount;
        return true;
    case Key::KEY_Left:
    case Key::KEY_Right:
        change(_row, key == Key::KEY_Right);
        return true;
    default:
        return false;
    }
}

bool SettingsPanel::click(const osgGA::GUIEventAdapter& event)
{
    const bool fromBottom = event.getMouseYOrientation() == Key::Y_INCREASING_UPWARDS;
    const float y = event.getY() - event.getYmin();
    const float fromTop = fromBottom ? event.getYmax() - event.getYmin() - y : y;
    const float x = event.getX() - event.getXmin() - kOverlayMargin;
    const float line = (fromTop - kOverlayMargin) / kLineHeight - 1.0f; // below the title
    if (x < 0.0f || x > kWidth || line < 0.0f || line >= static_cast<float>(kRowCount))
        return false;
    _row = static_cast<std::size_t>(line);
    change(_row, x > 0.5f * kWidth);
    return true;
}

void SettingsPanel::change(std::size_t row, bool up)
{
    stepSetting(*_scene->getSettings(), kRows[row], up);
}

void SettingsPanel::show()
{
    if (!_open) return;
    std::string text;
    for (const std::string& line : lines())
        text += line + '\n';
    _text->setPosition(osg::Vec3(kOverlayMargin, _height - kOverlayMargin, 0.0f));
    if (text != _shown) _text->setText(text);
    _shown = text;
}

void SettingsPanel::getUsage(osg::ApplicationUsage& usage) const
{
    usage.addKeyboardMouseBinding("Tab",
                                  "Open and close the settings: arrows or clicks change them");
}

} // namespace osgRayTrace::app
