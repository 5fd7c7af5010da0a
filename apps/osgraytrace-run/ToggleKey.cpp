// ToggleKey.cpp - names of keys, and the switch. Layer: apps.
// SPDX-License-Identifier: MIT
#include "ToggleKey.h"

#include <osg/Notify>

namespace osgRayTrace::app
{

std::optional<int> keyFromName(const std::string& name)
{
    if (name.size() == 1) return static_cast<unsigned char>(name[0]);
    for (int number = 1; number <= 12; ++number)
        if (name == "F" + std::to_string(number))
            return osgGA::GUIEventAdapter::KEY_F1 + number - 1;
    return std::nullopt;
}

bool ToggleKey::handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action)
{
    if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN || event.getKey() != _key)
        return false;
    osg::ref_ptr<RayTracedScene> scene;
    if (!_scene.lock(scene)) return false;
    scene->setEnabled(!scene->getEnabled());
    OSG_NOTICE << "osgRayTrace: ray tracing is " << (scene->getEnabled() ? "on" : "off")
               << std::endl;
    action.requestRedraw();
    return true;
}

} // namespace osgRayTrace::app
