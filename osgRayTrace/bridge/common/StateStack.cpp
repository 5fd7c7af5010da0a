// StateStack.cpp - applies OVERRIDE and PROTECTED to the state that is followed. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/BlendFunc>
#include <osg/ClipPlane>
#include <osg/Fog>
#include <osg/FragmentProgram>
#include <osg/Light>
#include <osg/TexGen>
#include <osg/TextureCubeMap>
#include <osg/TextureRectangle>
#include <osg/VertexProgram>

#include <algorithm>
#include <optional>

namespace osgRayTrace::engine
{

namespace
{

constexpr GLenum kPrimitiveRestartFixedIndex = 0x8D69; // OpenGL 4.3; OSG has no name for it

std::optional<unsigned int> modeBit(osg::StateAttribute::GLMode mode)
{
    if (mode >= GL_LIGHT0 && mode < GL_LIGHT0 + kMaskedLights) return mode - GL_LIGHT0;
    if (mode >= GL_CLIP_PLANE0 && mode < GL_CLIP_PLANE0 + kClipPlanes)
        return kClipPlaneBit + (mode - GL_CLIP_PLANE0);
    switch (mode)
    {
    case GL_LIGHTING:
        return kLightingBit;
    case GL_BLEND:
        return kBlendBit;
    case GL_ALPHA_TEST:
        return kAlphaTestBit;
    case GL_CULL_FACE:
        return kCullFaceBit;
    case GL_FOG:
        return kFogBit;
    case GL_PRIMITIVE_RESTART:
        return kPrimitiveRestartBit;
    case kPrimitiveRestartFixedIndex:
        return kFixedRestartBit;
    case GL_POLYGON_OFFSET_FILL:
        return kPolygonOffsetBit;
    case GL_STENCIL_TEST:
        return kStencilBit;
    case GL_COLOR_LOGIC_OP:
        return kLogicOpBit;
    case GL_POLYGON_STIPPLE:
        return kPolygonStippleBit;
    case GL_VERTEX_PROGRAM_ARB:
    case GL_FRAGMENT_PROGRAM_ARB:
        return kAssemblyProgramBit;
    default:
        return std::nullopt;
    }
}

std::optional<UnitBit> unitBit(osg::StateAttribute::GLMode mode)
{
    switch (mode)
    {
    case GL_TEXTURE_1D:
        return kTexture1DBit;
    case GL_TEXTURE_2D:
        return kTexture2DBit;
    case GL_TEXTURE_3D:
        return kTexture3DBit;
    case GL_TEXTURE_CUBE_MAP:
        return kCubeMapBit;
    case GL_TEXTURE_RECTANGLE:
        return kRectangleBit;
    default:
        return std::nullopt;
    }
}

std::optional<unsigned int> textureModeBit(osg::StateAttribute::GLMode mode, std::size_t unit)
{
    const std::optional<UnitBit> bit = unitBit(mode);
    if (!bit) return std::nullopt;
    if (unit < kUnits) return static_cast<unsigned int>(kTextureUnitBit + unit * kUnitBits + *bit);
    return static_cast<unsigned int>(
        std::min<std::size_t>(kHigherTextureBit + unit - kUnits, kModeBitEnd - 1));
}

std::optional<AttributeSlot> attributeSlot(osg::StateAttribute::Type type)
{
    if (type == PhysicalMaterial::ATTRIBUTE_TYPE) return kPhysicalMaterialSlot;
    switch (type)
    {
    case osg::StateAttribute::MATERIAL:
        return kMaterialSlot;
    case osg::StateAttribute::LIGHTMODEL:
        return kLightModelSlot;
    case osg::StateAttribute::PROGRAM:
        return kProgramSlot;
    case osg::StateAttribute::POLYGONMODE:
        return kPolygonModeSlot;
    case osg::StateAttribute::BLENDFUNC:
        return kBlendFuncSlot;
    case osg::StateAttribute::ALPHAFUNC:
        return kAlphaFuncSlot;
    case osg::StateAttribute::CULLFACE:
        return kCullFaceSlot;
    case osg::StateAttribute::FRONTFACE:
        return kFrontFaceSlot;
    case osg::StateAttribute::POLYGONOFFSET:
        return kPolygonOffsetSlot;
    case osg::StateAttribute::STENCIL:
        return kStencilSlot;
    case osg::StateAttribute::COLORMASK:
        return kColorMaskSlot;
    case osg::StateAttribute::VERTEXPROGRAM:
    case osg::StateAttribute::FRAGMENTPROGRAM:
        return kAssemblyProgramSlot;
    case osg::StateAttribute::PRIMITIVERESTARTINDEX:
        return kPrimitiveRestartSlot;
    case osg::StateAttribute::CLIPPLANE:
        return kClipPlaneSlot;
    case osg::StateAttribute::DEPTH:
        return kDepthSlot;
    case osg::StateAttribute::FOG:
        return kFogSlot;
    default:
        return std::nullopt;
    }
}

std::optional<UnitSlot> unitSlot(osg::StateAttribute::Type type)
{
    switch (type)
    {
    case osg::StateAttribute::TEXTURE:
        return kTextureSlot;
    case osg::StateAttribute::TEXENV:
        return kTextureEnvironmentSlot;
    case osg::StateAttribute::TEXMAT:
        return kTextureMatrixSlot;
    case osg::StateAttribute::TEXGEN:
        return kTexGenSlot;
    default:
        return std::nullopt;
    }
}

bool replaces(bool inheritedOverrides, unsigned int value)
{
    return !inheritedOverrides || (value & osg::StateAttribute::PROTECTED) != 0;
}

void applyMode(GraphState& state, unsigned int bit, unsigned int value)
{
    const uint64_t mask = uint64_t(1) << bit;
    if (!replaces((state.modesOverride & mask) != 0, value)) return;
    const bool on = (value & osg::StateAttribute::ON) != 0;
    const bool overrides = (value & osg::StateAttribute::OVERRIDE) != 0;
    state.modesOn = on ? state.modesOn | mask : state.modesOn & ~mask;
    state.modesOverride = overrides ? state.modesOverride | mask : state.modesOverride & ~mask;
}

void applyAttribute(GraphState& state, unsigned int slot,
                    const osg::StateSet::RefAttributePair& pair)
{
    const uint32_t mask = 1u << slot;
    if (!replaces((state.attributesOverride & mask) != 0, pair.second)) return;
    const bool overrides = (pair.second & osg::StateAttribute::OVERRIDE) != 0;
    state.attributes[slot] = pair.first.get();
    state.attributesOverride =
        overrides ? state.attributesOverride | mask : state.attributesOverride & ~mask;
}

/// Applies modes. Modes that share a bit (texture targets, texture generation) are set once, on if
/// one of them is on.
template <class BitOf>
void applyModes(GraphState& state, const osg::StateSet::ModeList& modes, const BitOf& bitOf)
{
    std::map<unsigned int, unsigned int> values;
    for (const auto& [mode, value] : modes)
    {
        const auto bit = bitOf(mode);
        if (bit) values[*bit] |= value;
    }
    for (const auto& [bit, value] : values)
        applyMode(state, bit, value);
}

void applyMoreLights(GraphState& state, const osg::StateSet::ModeList& modes)
{
    const auto first = modes.lower_bound(GL_LIGHT0 + kMaskedLights);
    const auto end = modes.lower_bound(GL_LIGHT0 + kLightNumbers);
    if (first == end) return;
    auto lights = std::make_shared<LightModes>(state.moreLights ? *state.moreLights : LightModes());
    for (auto mode = first; mode != end; ++mode)
    {
        const auto [light, isNew] = lights->try_emplace(mode->first - GL_LIGHT0, mode->second);
        const bool overrides = (light->second & osg::StateAttribute::OVERRIDE) != 0;
        if (isNew || replaces(overrides, mode->second)) light->second = mode->second;
    }
    state.moreLights = std::move(lights);
}

/// Applies GL_TEXTURE_GEN_S and the three modes that follow it.
void applyGeneration(GraphState& state, unsigned int unit, const osg::StateSet::ModeList& modes)
{
    for (unsigned int coordinate = 0; coordinate < kTextureCoordinates; ++coordinate)
    {
        const auto mode = modes.find(GL_TEXTURE_GEN_S + coordinate);
        const auto bit = static_cast<uint8_t>(1u << coordinate);
        uint8_t& on = state.generated[unit];
        uint8_t& overrides = state.generatedOverride[unit];
        if (mode == modes.end() || !replaces((overrides & bit) != 0, mode->second)) continue;
        const auto set = [bit](uint8_t& bits, bool value)
        { bits = static_cast<uint8_t>(value ? bits | bit : bits & ~bit); };
        set(on, (mode->second & osg::StateAttribute::ON) != 0);
        set(overrides, (mode->second & osg::StateAttribute::OVERRIDE) != 0);
    }
}

void applyTextures(GraphState& state, const osg::StateSet& stateSet)
{
    const osg::StateSet::TextureModeList& modes = stateSet.getTextureModeList();
    for (unsigned int unit = 0; unit < std::min<std::size_t>(kUnits, modes.size()); ++unit)
        applyGeneration(state, unit, modes[unit]);
    for (std::size_t unit = 0; unit < modes.size(); ++unit)
        applyModes(state, modes[unit],
                   [unit](osg::StateAttribute::GLMode mode) { return textureModeBit(mode, unit); });

    const osg::StateSet::TextureAttributeList& attributes = stateSet.getTextureAttributeList();
    for (unsigned int unit = 0; unit < std::min<std::size_t>(kUnits, attributes.size()); ++unit)
        for (const auto& [type, pair] : attributes[unit])
            if (const auto slot = unitSlot(type.first))
                applyAttribute(state, kUnitSlot + unit * kUnitSlots + *slot, pair);
}

GraphState applied(GraphState state, const osg::StateSet& stateSet)
{
    applyModes(state, stateSet.getModeList(), modeBit);
    applyMoreLights(state, stateSet.getModeList());
    uint32_t set = 0;
    for (const auto& [type, pair] : stateSet.getAttributeList())
    {
        const auto slot = attributeSlot(type.first);
        if (!slot) continue;
        applyAttribute(state, *slot, pair);
        if (state.attributes[*slot] == pair.first) set |= 1u << *slot;
    }
    if (set & 1u << kPhysicalMaterialSlot)
        state.programIsNearer = false;
    else if (set & (1u << kProgramSlot | 1u << kAssemblyProgramSlot))
        state.programIsNearer = true;
    applyTextures(state, stateSet);
    if (state.shader) state.shader = below(state.shader, stateSet);
    return state;
}

} // namespace

StateStack::StateStack(const GraphState& root) : _states{root}, _stack{0} {}

void StateStack::push(const osg::StateSet& stateSet)
{
    const auto number = static_cast<uint32_t>(_states.size());
    const auto [entry, isNew] = _known.try_emplace({top(), &stateSet}, number);
    if (isNew) _states.push_back(applied(_states[top()], stateSet));
    _stack.push_back(entry->second);
}

void StateStack::forgetMasks()
{
    GraphState& state = _states[top()];
    for (const AttributeSlot slot : {kStencilSlot, kColorMaskSlot, kDepthSlot})
    {
        state.attributes[slot] = nullptr;
        state.attributesOverride &= ~(1u << slot);
    }
    state.modesOn &= ~(uint64_t(1) << kStencilBit);
    state.modesOverride &= ~(uint64_t(1) << kStencilBit);
}

} // namespace osgRayTrace::engine
