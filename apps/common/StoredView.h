// StoredView.h - the view and background that a scene asks for. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>
#include <osg/Vec3d>
#include <osg/Vec4>

#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::app
{

struct Placement
{
    osg::Vec3d eye;
    osg::Vec3d center; ///< a point on the line of sight
    osg::Vec3d up;
    double fovyDegrees = 0.0; ///< vertical [degrees]
    double height = 0.0;      ///< of what an orthographic camera shows; 0: the view is perspective
};

struct NamedPlacement
{
    std::string name;
    Placement placement;
};

/// Returns the placements of all nodes that are an osg::Camera with a name and no children, as
/// readers of models make them of the models' cameras, in the order of the graph, hidden ones as
/// well. The field of view of orthographic cameras is 0.
std::vector<NamedPlacement> namedPlacements(osg::Node& scene);

/// Returns the placement of the first osg::CameraView, in world space, with the centre at unit
/// distance; nothing if the scene has none.
std::optional<Placement> storedPlacement(osg::Node& scene);

/// Returns the colour of the first osg::ClearNode; nothing if the scene has none.
std::optional<osg::Vec4> storedClearColor(osg::Node& scene);

} // namespace osgRayTrace::app
