// StateStack.h - accumulates the OpenGL state that a drawable inherits. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ShaderState.h"

#include <osg/StateSet>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

constexpr unsigned int kClipPlanes = 8;

/// Names the modes that matter here, as bits of a set. Bits 0 to 31 are GL_LIGHT0 + n; lights of
/// higher numbers are in GraphState::moreLights.
enum ModeBit : unsigned int
{
    kLightingBit = 32,
    kBlendBit,
    kAlphaTestBit,
    kCullFaceBit,
    kFogBit,
    kPrimitiveRestartBit,
    kFixedRestartBit, ///< primitive restart at the largest index of the type
    kClipPlaneBit,    ///< first of kClipPlanes bits
    kClipPlaneBitEnd = kClipPlaneBit + kClipPlanes,
    kPolygonOffsetBit = kClipPlaneBitEnd,
    kStencilBit,
    kAssemblyProgramBit, ///< GL_VERTEX_PROGRAM_ARB or GL_FRAGMENT_PROGRAM_ARB
    kLogicOpBit,
    kPolygonStippleBit,
    kTextureUnitBit, ///< first bit of unit 0, see UnitBit; those of unit 1 follow
    /// Any texture target of units 2, 3, ...: up to bit 63.
    kHigherTextureBit = kTextureUnitBit + 10,
    kModeBitEnd = 64,
};

/// Names the modes of one texture unit.
enum UnitBit : unsigned int
{
    kTexture1DBit,
    kTexture2DBit,
    kTexture3DBit,
    kCubeMapBit,
    kRectangleBit,
    kUnitBits,
};

constexpr unsigned int kUnits = 2;              ///< number of texture units that are followed
constexpr unsigned int kTextureCoordinates = 4; ///< S, T, R, Q
static_assert(kTextureUnitBit + kUnits * kUnitBits == kHigherTextureBit, "bits of the units");

/// Names the attributes that matter here.
enum AttributeSlot : unsigned int
{
    kMaterialSlot,
    kPhysicalMaterialSlot,
    kLightModelSlot,
    kProgramSlot,
    kPolygonModeSlot,
    kPrimitiveRestartSlot,
    kClipPlaneSlot, ///< last one met, of any number; planes of clip nodes are no attributes
    kBlendFuncSlot,
    kAlphaFuncSlot,
    kCullFaceSlot,
    kFrontFaceSlot,
    kPolygonOffsetSlot,
    kStencilSlot,
    kColorMaskSlot,
    kAssemblyProgramSlot, ///< last osg::VertexProgram or osg::FragmentProgram met
    kDepthSlot,
    kFogSlot,
    kUnitSlot, ///< first slot of unit 0, see UnitSlot; those of unit 1 follow
    kAttributeSlots = kUnitSlot + 8,
};

/// Names the attributes of one texture unit.
enum UnitSlot : unsigned int
{
    kTextureSlot,
    kTextureEnvironmentSlot,
    kTextureMatrixSlot,
    kTexGenSlot,
    kUnitSlots,
};
static_assert(kUnitSlot + kUnits * kUnitSlots == kAttributeSlots, "slots of the units");

constexpr int kMaskedLights = 32; ///< osg::Light numbers with a bit of their own

/// End of the osg::Light numbers: GL_LIGHT0 + n is from this number on the name of another mode of
/// OpenGL.
constexpr int kLightNumbers = 0x4000;

/// Maps osg::Light numbers from kMaskedLights on to the value that GL_LIGHT0 + n was set to.
using LightModes = std::map<unsigned int, unsigned int>;

/// Holds accumulated state. Attributes live as long as the StateStack does, unless somebody changes
/// a state set.
struct GraphState
{
    uint64_t modesOn = 0;
    uint64_t modesOverride = 0;
    std::array<const osg::StateAttribute*, kAttributeSlots> attributes{};
    uint32_t attributesOverride = 0;              ///< bit: AttributeSlot
    std::shared_ptr<const LightModes> moreLights; ///< null: none was set
    std::array<uint8_t, kUnits> generated{};      ///< bit n: coordinate n of the unit is generated
    std::array<uint8_t, kUnits> generatedOverride{};
    bool programIsNearer = false; ///< true: a program was set below the PhysicalMaterial, if any
    std::shared_ptr<const ShaderState> shader; ///< null: nobody reads uniforms and textures by name

    bool isOn(unsigned int modeBit) const { return (modesOn >> modeBit & 1u) != 0; }
    bool isOn(unsigned int unit, UnitBit bit) const
    {
        return isOn(kTextureUnitBit + unit * kUnitBits + bit);
    }
    bool generates(unsigned int unit, unsigned int coordinate) const
    {
        return (generated[unit] >> coordinate & 1u) != 0;
    }
    bool usesHigherTextures() const { return modesOn >> kHigherTextureBit != 0; }

    /// Returns the attribute of a slot; null if there is none of this class.
    template <class T> const T* attribute(AttributeSlot slot) const
    {
        return dynamic_cast<const T*>(attributes[slot]);
    }
    template <class T> const T* attribute(unsigned int unit, UnitSlot slot) const
    {
        return dynamic_cast<const T*>(attributes[kUnitSlot + unit * kUnitSlots + slot]);
    }
};

/// Pushes StateSets as osg::State does: a value replaces the inherited one unless the inherited
/// value has OVERRIDE and the new one lacks PROTECTED. Equal sequences of pushes give the same
/// state number.
class StateStack
{
public:
    explicit StateStack(const GraphState& root);

    void push(const osg::StateSet& stateSet);
    void pop() { _stack.pop_back(); }

    /// Forgets stencil, colour masks and depth that were pushed up to now, because they hold for
    /// all of the picture alike, traced or not.
    void forgetMasks();

    /// Returns the number of the current state in states().
    uint32_t top() const { return _stack.back(); }
    const std::vector<GraphState>& states() const { return _states; }

private:
    std::vector<GraphState> _states;
    std::vector<uint32_t> _stack;
    std::map<std::pair<uint32_t, osg::ref_ptr<const osg::StateSet>>, uint32_t> _known;
};

} // namespace osgRayTrace::engine
