// SettingsPanel.h - settings that are changed over the picture, by keys or the mouse. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/RayTracedScene>

#include <osg/ApplicationUsage>
#include <osg/Camera>
#include <osgGA/GUIEventHandler>
#include <osgText/Text>

#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// Shows a list of settings at the upper left of the window. Tab opens and closes it. While it is
/// open, arrows choose a row and change its value, and so do clicks on the left and the right half
/// of a row; all other keys stay what they are. Settings change in the event traversal.
class SettingsPanel : public osgGA::GUIEventHandler
{
public:
    explicit SettingsPanel(RayTracedScene* scene);

    /// Returns the camera that has to be put into the graph, beside the scene.
    osg::Camera* camera() { return _camera.get(); }

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

    bool isOpen() const { return _open; }

    /// Returns the lines of the panel: names and values, the chosen one marked.
    std::vector<std::string> lines() const;

private:
    bool press(int key);
    bool click(const osgGA::GUIEventAdapter& event);
    void change(std::size_t row, bool up);
    void show();

    osg::ref_ptr<RayTracedScene> _scene;
    osg::ref_ptr<osg::Camera> _camera;
    osg::ref_ptr<osgText::Text> _text;
    bool _open = false;
    std::size_t _row = 0;
    float _height = 1024.0f; ///< of the window [pixels]
    std::string _shown;
};

} // namespace osgRayTrace::app
