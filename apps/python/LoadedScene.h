// LoadedScene.h - models that Python has read. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/common/PlacedCamera.h"

#include <osgRayTrace/RayTraceSettings>

#include <osg/BoundingSphere>
#include <osg/Node>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::python
{

/// Holds a scene graph, and what is asked of it besides. Nobody changes it, so that any threads may
/// read it at once: all bounds are computed when it is made.
class LoadedScene
{
public:
    explicit LoadedScene(const osg::ref_ptr<osg::Node>& node);

    osg::Node& node() const { return *_node; }
    const osg::BoundingSphere& bound() const { return _bound; }
    const std::vector<app::NamedPlacement>& cameras() const { return _cameras; }

    /// Returns the placement that the scene asks for; nothing if it asks for none.
    const std::optional<app::Placement>& placement() const { return _placement; }

    /// Returns new settings: those that a ray traced scene in the graph brings with it, or else the
    /// default ones.
    osg::ref_ptr<RayTraceSettings> settings() const;

private:
    osg::ref_ptr<osg::Node> _node;
    osg::BoundingSphere _bound;
    std::vector<app::NamedPlacement> _cameras;
    std::optional<app::Placement> _placement;
    osg::ref_ptr<RayTraceSettings> _storedSettings; ///< null: there are none
};

using ScenePointer = std::shared_ptr<const LoadedScene>;

/// Reads one model, or several into one scene. Throws app::Failure.
ScenePointer sceneOfFiles(const std::vector<std::string>& files);

/// Reads a text in the format of .osgt files. Throws app::Failure.
ScenePointer sceneOfText(const std::string& text);

} // namespace osgRayTrace::python
