// MaterialConverter.h - converts inherited OpenGL state to materials. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/SurfaceInputs.h"
#include "osgRayTrace/bridge/appearance/textures/TextureUnits.h"
#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/scene/Scene.h"

namespace osgRayTrace::engine
{

/// The rules hold for all materials of a scene.
struct MaterialRules
{
    bool linear = false;      ///< fixed-function colours decoded from sRGB
    bool cullAllRays = false; ///< see RayTraceSettings
    bool setsColor = false;   ///< setsCurrentColor of any state of the scene
};

/// Returns whether the osg::Material of a state makes another colour current than OSG's default
/// material. If no state of a scene does, colour materials of the default colour keep the default
/// ambient colour: see applyColor.
bool setsCurrentColor(const GraphState& state);

/// Converts state to materials.
class MaterialConverter
{
public:
    /// textures must have begun its snapshot.
    MaterialConverter(const MaterialRules& rules, TextureConverter& textures,
                      ConversionReport& report)
        : _rules(rules), _textures(textures), _report(report)
    {
    }

    /// Returns the material of a state. Each call counts what of the state is only approximated.
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

/// Returns the material of a lamp that reflects nothing, for an area light.
Material lampMaterial(const Vec3& radiance);

/// Returns a visible material, for a scene without any.
Material fallbackMaterial();

} // namespace osgRayTrace::engine
