// UntracedParts.h - tells the parts of a graph that are not traced, and the reasons. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osg/Camera>
#include <osg/Drawable>

namespace osgRayTrace::engine
{

/// The reasons that these functions return are keys of ConversionCounts.

/// Returns why a drawable that is no osg::Geometry is not traced; null: the drawable is our own.
const char* untracedDrawable(const osg::Drawable& drawable);

/// Returns whether a callback of osgManipulator's hides the drawable from all views: it is there
/// for the mouse alone.
bool isForTheMouse(const osg::Drawable& drawable);

/// Returns why a node without children whose class is not of OSG's core is not traced; null: the
/// node shows nothing. Emitters, programs and updaters of particles move content that other nodes
/// draw.
const char* untracedLeaf(const osg::Node& node);

/// Returns why the content of a camera in the graph does not belong to the scene around it; null:
/// it does.
const char* untracedCamera(const osg::Camera& camera);

/// Returns why OpenGL, if available, draws triangles of this state; null: they are traced. textures
/// holds the textures that were converted before. poses is a program that only repeats what was
/// computed in software.
const char* rasterizedState(const GraphState& state, const TextureConverter& textures,
                            const osg::StateAttribute* poses);

} // namespace osgRayTrace::engine
