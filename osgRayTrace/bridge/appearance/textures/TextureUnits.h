// TextureUnits.h - what the state of texture units 0 and 1 makes of a material. Layer: bridge.
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

/// The texture generation that a TexGenNode places, for all that uses generated coordinates and has
/// no osg::TexGen of its own.
struct PlacedTexGen
{
    osg::ref_ptr<const osg::TexGen> texGen;
    osg::Matrixd engineFromLocal;
};
using PlacedTexGens = std::array<PlacedTexGen, kUnits>;

/// Where a surface is.
struct SurfacePlacement
{
    osg::Matrixd engineFromLocal;
    const PlacedTexGens* texGens = nullptr; ///< null: none
};

/// True if a unit that is enabled has a texture that only OpenGL has; not so what textures has
/// converted before its image was given up.
bool looksIntoOpenGL(const GraphState& state, const TextureConverter& textures);

/// True if a unit that is enabled has a texture combiner, which we have no counterpart of.
bool combinesTextures(const GraphState& state);

/// Sets textures, their environments and the way to their coordinates. Counts what is left out:
/// units whose coordinates nobody generates, texture combiners.
void applyTextureUnits(Material& material, const GraphState& state,
                       const SurfacePlacement& placement, TextureConverter& textures,
                       ConversionReport& report);

} // namespace osgRayTrace::engine
