// RuleSources.h - looks up what the rules of a material file ask for. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/ShaderRule.h"
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osg/Node>
#include <osg/Texture2D>
#include <osg/Texture2DArray>

#include <optional>

namespace osgRayTrace::engine
{

// The states of these functions follow shaders: GraphState::shader is not null.

/// Returns whether all conditions of the rule hold for a geometry at the end of the path with this
/// state.
bool fits(const ShaderRule& rule, const osg::NodePath& path, const GraphState& state);

/// Returns the numbers of a parameter, in its range; nothing if they are not there or not finite.
std::optional<Values> numbersOf(const ValueSource& source, const Parameter& parameter,
                                const osg::NodePath& path, const GraphState& state);

/// Returns the unit that a source names; nothing if the source is not there.
std::optional<unsigned int> unitOf(const TextureSource& source, const osg::NodePath& path,
                                   const GraphState& state);

/// Returns the texture that is bound to a unit; null: none, or none of two dimensions.
const osg::Texture2D* textureAt(unsigned int unit, const GraphState& state);

/// Returns the texture array that is bound to a unit; null: none.
const osg::Texture2DArray* arrayAt(unsigned int unit, const GraphState& state);

} // namespace osgRayTrace::engine
