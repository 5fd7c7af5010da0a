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
    void countApproximations(const GraphState& state);

    MaterialRules _rules;
    TextureConverter& _textures;
    ConversionReport& _report;
};

/// A lamp that reflects nothing, for an area light.
Material lampMaterial(const Vec3& radiance);

} // namespace osgRayTrace::engine
