// ToggleKey.h - a key that switches ray tracing in a foreign program. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTracedScene>

#include <osgGA/GUIEventHandler>

#include <optional>
#include <string>

namespace osgRayTrace::app
{

/// Returns osgGA's key: "F1" to "F12" or one character; nothing for other names.
std::optional<int> keyFromName(const std::string& name);

/// Switches ray tracing with one key; the program's own handlers see every other key.
class ToggleKey : public osgGA::GUIEventHandler
{
public:
    ToggleKey(RayTracedScene* scene, int key) : _scene(scene), _key(key) {}

    /// Returns whether the key is for this scene: two keys for one scene in a view would undo each
    /// other.
    bool isFor(const RayTracedScene* scene) const { return _scene.get() == scene; }

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;

private:
    osg::observer_ptr<RayTracedScene> _scene;
    int _key;
};

} // namespace osgRayTrace::app
