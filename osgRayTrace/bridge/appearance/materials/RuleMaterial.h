// RuleMaterial.h - the material that a shader rule makes of a state. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/ShaderRule.h"
#include "osgRayTrace/bridge/appearance/textures/DerivedTextures.h"
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Node>

#include <optional>
#include <string>

namespace osgRayTrace::engine
{

struct RuleMaterial
{
    osg::ref_ptr<PhysicalMaterial> material;
    std::optional<float> alphaReference;
    unsigned int unit = 0; ///< unit of the first texture, whose coordinates are looked up
    std::string missing; ///< first value that the rule asks for and that is not there; empty: none
};

/// Returns the material of a rule that fits. A parameter whose value or texture is not there keeps
/// the default of PhysicalMaterial. Without a base colour in the rule, that of the osg::Material
/// holds; without its texture as well, that of unit 0.
RuleMaterial materialOf(const ShaderRule& rule, const osg::NodePath& path, const GraphState& state,
                        DerivedTextures& derived);

/// Sets the diffuse colour of the state's osg::Material as base colour.
void takeDiffuse(const GraphState& state, PhysicalMaterial& material);

/// Returns the 2-D texture that is enabled on unit 0; null: none.
const osg::Texture2D* textureOf(const GraphState& state);

} // namespace osgRayTrace::engine
