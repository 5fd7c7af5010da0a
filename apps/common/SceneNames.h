// SceneNames.h - the names in a scene that a material file can refer to. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Node>

#include <string>

namespace osgRayTrace::app
{

/// Returns a line for each name in the graph, with tabs between: kind, number of nodes or state
/// sets that have it, name, texture unit or "-", and the path to the first of them. The kinds are
/// material, node, program (of another class: the class), sampler, shader, texture (its file), user
/// (a user value) and uniform. Lines are sorted by kind and name. A node on several paths is looked
/// at once.
std::string namesOf(osg::Node& scene);

/// Returns the path, and a line for each name along it: kind, name, texture unit or "-".
std::string namesAlong(const osg::NodePath& path);

} // namespace osgRayTrace::app
