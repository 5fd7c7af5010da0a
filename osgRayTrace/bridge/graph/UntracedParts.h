// UntracedParts.h - what in a graph is not traced, and why. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osg/Camera>
#include <osg/Drawable>

namespace osgRayTrace::engine
{

/// Whether its class is one of this library.
bool isFrom(const osg::Object* object, const char* library);

/// Reasons are keys of ConversionCounts.

/// Why a drawable that is no osg::Geometry is not traced; null: it is our own.
const char* untracedDrawable(const osg::Drawable& drawable);

/// Why a node without children that is of no library of OSG's core is not traced; null: there is
/// nothing of it to see. Emitters, programs and updaters of particles move what other nodes draw.
const char* untracedLeaf(const osg::Node& node);

/// Why the content of a camera in the graph is not a part of the scene around it; null: it is.
const char* untracedCamera(const osg::Camera& camera);

/// Why triangles of this state are drawn by OpenGL where there is one; null: they are traced.
/// textures: what was converted before. poses: a program that only does what was done in software.
const char* rasterizedState(const GraphState& state, const TextureConverter& textures,
                            const osg::StateAttribute* poses);

} // namespace osgRayTrace::engine
