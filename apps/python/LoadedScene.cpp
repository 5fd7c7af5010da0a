// LoadedScene.cpp - reads models, and looks for cameras and settings in them. Layer: apps.
// SPDX-License-Identifier: MIT
#include "LoadedScene.h"

#include "apps/common/Failure.h"
#include "apps/common/ModelFiles.h"
#include "apps/common/StoredScene.h"

#include <osg/ComputeBoundsVisitor>

namespace osgRayTrace::python
{

LoadedScene::LoadedScene(const osg::ref_ptr<osg::Node>& node)
    : _node(node),
      _bound(node->getBound()),
      _cameras(app::namedPlacements(*node)),
      _placement(app::storedPlacement(*node))
{
    osg::ComputeBoundsVisitor drawables; // the bounds of drawables are kept in them
    _node->accept(drawables);
    const osg::ref_ptr<RayTracedScene> stored = app::storedScene(*node);
    if (stored) _storedSettings = stored->getSettings();
}

osg::ref_ptr<RayTraceSettings> LoadedScene::settings() const
{
    return _storedSettings ? new RayTraceSettings(*_storedSettings) : new RayTraceSettings;
}

ScenePointer sceneOfFiles(const std::vector<std::string>& files)
{
    if (files.empty()) throw app::Failure(app::kCannotLoad, "there is no file to load");
    return std::make_shared<LoadedScene>(app::readScene(files));
}

ScenePointer sceneOfText(const std::string& text)
{
    return std::make_shared<LoadedScene>(app::readSceneText(text));
}

} // namespace osgRayTrace::python
