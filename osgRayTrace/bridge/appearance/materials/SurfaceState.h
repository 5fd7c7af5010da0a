// SurfaceState.h - what OpenGL's state does to the pixels of a surface. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/scene/Material.h"

namespace osgRayTrace::engine
{

/// What GL_BLEND and the blend function do to what is behind.
enum class Blending
{
    Opaque,
    Straight, ///< source alpha and one minus it, also if no function is set
    Additive, ///< adds to what is behind
    Other,
};
Blending blendingOf(const GraphState& state);

/// The program that draws instead of OpenGL's fixed function; null: none does. Also one of a class
/// of its own, as virtual programs are, and a vertex or fragment program of ARB's.
const osg::StateAttribute* programOf(const GraphState& state);

/// A colour mask that leaves out a channel.
bool masksColor(const GraphState& state);

/// A stencil test: it compares, or it writes what others are compared with.
bool usesStencil(const GraphState& state);

/// Layers that glPolygonOffset lifts the faces by, towards the viewer. 0: none. The offset's units
/// count, or its factor if it has none.
float depthBias(const GraphState& state);

FaceCulling cullingOf(const GraphState& state);

/// Counts what of the state is only approximated, for each call.
void countApproximations(const GraphState& state, ConversionReport& report);

} // namespace osgRayTrace::engine
