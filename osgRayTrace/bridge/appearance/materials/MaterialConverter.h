// MaterialConverter.h - from inherited OpenGL state to materials. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/TextureUnits.h"
#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/scene/Scene.h"

#include <osg/Geometry>

namespace osgRayTrace::engine
{

/// What of a geometry decides on its material.
struct SurfaceInputs
{
    bool hasVertexColors = false;       ///< colours that vary over it
    bool hasOverallColor = false;       ///< one colour for all of it
    Vec4 overallColor{1.0f};            ///< as OpenGL gets it, not decoded
    bool hasTextureCoordinates = false; ///< of unit 0
};

SurfaceInputs surfaceInputs(const osg::Geometry& geometry);

/// What all materials of a scene have in common.
struct MaterialRules
{
    bool linear = false;      ///< fixed-function colours are decoded from sRGB
    bool cullAllRays = false; ///< see RayTraceSettings
    bool setsColor = false;   ///< see setsCurrentColor: some material of the scene does
};

/// Whether the osg::Material of a state makes another colour current than OSG's default material.
/// Where none of a scene does, colour materials of that colour keep the default ambient colour: see
/// applyColor.
bool setsCurrentColor(const GraphState& state);

/// From state to materials.
class MaterialConverter
{
public:
    /// textures has begun its snapshot.
    MaterialConverter(const MaterialRules& rules, TextureConverter& textures,
                      ConversionReport& report)
        : _rules(rules), _textures(textures), _report(report)
    {
    }

    /// Counts what of the state is only approximated, for each call.
    Material material(const GraphState& state, const SurfaceInputs& inputs,
                      const SurfacePlacement& placement = {});

private:
    Material fixedFunction(const GraphState& state, const SurfaceInputs& inputs) const;
    Material physical(const GraphState& state, const SurfaceInputs& inputs);
    void applyColor(Material& material, const GraphState& state, const SurfaceInputs& inputs) const;
    void applyOpacity(Material& material, const GraphState& state) const;
    void applyFaces(Material& material, const GraphState& state,
                    const SurfacePlacement& placement) const;
    void decode(Material& material) const;

    MaterialRules _rules;
    TextureConverter& _textures;
    ConversionReport& _report;
};

/// A lamp that reflects nothing, for an area light.
Material lampMaterial(const Vec3& radiance);

/// A visible one, for a scene without any.
Material fallbackMaterial();

} // namespace osgRayTrace::engine
