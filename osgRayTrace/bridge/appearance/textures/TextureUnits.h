// TextureUnits.h - converts the state of texture units 0 and 1 for a material. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/scene/Material.h"

#include <osg/Matrixd>
#include <osg/TexGen>

#include <array>

namespace osgRayTrace::engine
{

/// Holds the texture generation that a TexGenNode places, for all parts of the graph that use
/// generated coordinates and have no osg::TexGen of their own.
struct PlacedTexGen
{
    osg::ref_ptr<const osg::TexGen> texGen;
    osg::Matrixd engineFromLocal;
};
using PlacedTexGens = std::array<PlacedTexGen, kUnits>;

/// Tells where a surface is.
struct SurfacePlacement
{
    osg::Matrixd engineFromLocal;
    const PlacedTexGens* texGens = nullptr; ///< null: none
};

/// Returns whether an enabled unit has a texture that only OpenGL has. A texture that textures
/// converted before its image was given up does not count.
bool looksIntoOpenGL(const GraphState& state, const TextureConverter& textures);

/// Returns whether an enabled unit has a texture combiner, for which the engine has no counterpart.
bool combinesTextures(const GraphState& state);

/// Sets textures, their environments and the way to their coordinates. Counts the omissions: units
/// whose coordinates nobody generates, and texture combiners.
void applyTextureUnits(Material& material, const GraphState& state,
                       const SurfacePlacement& placement, TextureConverter& textures,
                       ConversionReport& report);

} // namespace osgRayTrace::engine
