// SurfaceState.h - tells what OpenGL's state does to a surface's pixels. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/scene/Material.h"

namespace osgRayTrace::engine
{

/// The kinds of blending say what GL_BLEND and the blend function do to what is behind.
enum class Blending
{
    Opaque,
    Straight, ///< source alpha and one minus it, also if no function is set
    Additive, ///< addition to what is behind
    Other,
};
Blending blendingOf(const GraphState& state);

/// Returns the program that draws instead of OpenGL's fixed function, or null if none does. The
/// program may be of a class of its own, as virtual programs are, or a vertex or fragment program
/// of ARB's.
const osg::StateAttribute* programOf(const GraphState& state);

/// Returns whether a PhysicalMaterial stands for the program: one that was set in the same state
/// set or below it. A program that is nearer to the geometry stands for itself.
bool replacesProgram(const GraphState& state);

/// Returns whether a colour mask leaves out a channel.
bool masksColor(const GraphState& state);

/// Returns whether a stencil test compares, or writes what others are compared with.
bool usesStencil(const GraphState& state);

/// Returns whether all depths are one by the range of an osg::Depth, whatever their geometry: as
/// those of skies are, which are behind everything.
bool hasOneDepth(const GraphState& state);

/// Returns the number of layers by which glPolygonOffset lifts the faces towards the viewer, or 0
/// if it lifts none. The offset's units count, or its factor if its units are 0.
float depthBias(const GraphState& state);

FaceCulling cullingOf(const GraphState& state);

/// Counts what of the state is only approximated; each call counts anew.
void countApproximations(const GraphState& state, ConversionReport& report);

} // namespace osgRayTrace::engine
