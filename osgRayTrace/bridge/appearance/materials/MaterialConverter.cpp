// MaterialConverter.cpp - converts OpenGL's state of a surface to a material. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialConverter.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialValues.h"
#include "osgRayTrace/bridge/appearance/materials/PhysicalConversion.h"
#include "osgRayTrace/bridge/appearance/materials/SurfaceState.h"
#include "osgRayTrace/bridge/geometry/MeshPlacement.h"
#include "osgRayTrace/film/ToneMap.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/AlphaFunc>
#include <osg/Fog>
#include <osg/FrontFace>
#include <osg/LightModel>
#include <osg/Material>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr auto kFront = osg::Material::FRONT;
constexpr float kLargestShininess = 128.0f;

float finiteOr(float value, float otherwise)
{
    return std::isfinite(value) ? value : otherwise;
}

Vec3 rgb(const osg::Vec4& color)
{
    return {finiteOr(color.r(), 0.0f), finiteOr(color.g(), 0.0f), finiteOr(color.b(), 0.0f)};
}

/// Enables the lights whose modes are on.
void enableLights(Material& material, const GraphState& state)
{
    material.lightMask = static_cast<uint32_t>(state.modesOn);
    if (!state.moreLights) return;
    for (const auto& [number, value] : *state.moreLights)
    {
        if (!(value & osg::StateAttribute::ON)) continue;
        const std::size_t word = number / 32 - 1; // the numbers rise
        material.moreLights.resize(word + 1);
        material.moreLights[word] |= 1u << number % 32;
    }
}

Vec3 decoded(const Vec3& color)
{
    return {linearFromSrgb(color.x), linearFromSrgb(color.y), linearFromSrgb(color.z)};
}

VertexColorUse vertexColorUse(osg::Material::ColorMode mode)
{
    switch (mode)
    {
    case osg::Material::AMBIENT:
        return VertexColorUse::Ambient;
    case osg::Material::DIFFUSE:
        return VertexColorUse::Diffuse;
    case osg::Material::SPECULAR:
        return VertexColorUse::Specular;
    case osg::Material::EMISSION:
        return VertexColorUse::Emission;
    case osg::Material::AMBIENT_AND_DIFFUSE:
        return VertexColorUse::AmbientAndDiffuse;
    default:
        return VertexColorUse::None;
    }
}

/// Returns the colour that osg::Material::apply makes OpenGL's current colour.
const osg::Vec4& currentColorOf(const osg::Material& source)
{
    switch (source.getColorMode())
    {
    case osg::Material::AMBIENT:
        return source.getAmbient(kFront);
    case osg::Material::SPECULAR:
        return source.getSpecular(kFront);
    case osg::Material::EMISSION:
        return source.getEmission(kFront);
    default:
        return source.getDiffuse(kFront);
    }
}

const Vec3 kDefaultColor = FaceColors().diffuse;

FaceColors faceColors(const osg::Material& source, osg::Material::Face face)
{
    FaceColors colors;
    colors.ambient = rgb(source.getAmbient(face));
    colors.diffuse = rgb(source.getDiffuse(face));
    colors.specular = rgb(source.getSpecular(face));
    colors.emission = rgb(source.getEmission(face));
    colors.alpha = finiteOr(source.getDiffuse(face).a(), 1.0f);
    colors.shininess =
        std::clamp(finiteOr(source.getShininess(face), 0.0f), 0.0f, kLargestShininess);
    return colors;
}

/// Replaces the colours of a whole face as a vertex colour would do.
void replaceColor(FaceColors& face, VertexColorUse use, const Vec4& color)
{
    const Vec3 value(color);
    switch (use)
    {
    case VertexColorUse::None:
        break;
    case VertexColorUse::Ambient:
        face.ambient = value;
        break;
    case VertexColorUse::Specular:
        face.specular = value;
        break;
    case VertexColorUse::Emission:
        face.emission = value;
        break;
    case VertexColorUse::AmbientAndDiffuse:
        face.ambient = value;
        face.diffuse = value;
        face.alpha = color.w;
        break;
    case VertexColorUse::Diffuse:
        face.diffuse = value;
        face.alpha = color.w;
        break;
    }
}

void setFront(Material& m, const FaceColors& face)
{
    m.ambient = face.ambient;
    m.diffuse = face.diffuse;
    m.specular = face.specular;
    m.emission = face.emission;
    m.shininess = face.shininess;
    m.alpha = face.alpha;
}

FogMode fogModeOf(const osg::Fog& fog)
{
    switch (fog.getMode())
    {
    case osg::Fog::LINEAR:
        return FogMode::Linear;
    case osg::Fog::EXP:
        return FogMode::Exponential;
    case osg::Fog::EXP2:
        return FogMode::ExponentialSquared;
    }
    return FogMode::None; // OpenGL refuses other modes
}

/// Returns the fog that a state has. Without an attribute OpenGL's first values hold: black,
/// exponential, of density 1.
Fog fogOf(const GraphState& state)
{
    Fog fog;
    if (!state.isOn(kFogBit)) return fog;
    fog.mode = FogMode::Exponential;
    const auto* source = state.attribute<osg::Fog>(kFogSlot);
    if (!source) return fog;
    fog.mode = fogModeOf(*source);
    fog.radial = source->getUseRadialFog();
    fog.color = rgb(source->getColor());
    fog.density = std::max(finiteOr(source->getDensity(), 0.0f), 0.0f);
    fog.start = finiteOr(source->getStart(), 0.0f);
    fog.end = finiteOr(source->getEnd(), 1.0f);
    return fog;
}

AlphaTest comparisonOf(osg::AlphaFunc::ComparisonFunction function)
{
    switch (function)
    {
    case osg::AlphaFunc::NEVER:
        return AlphaTest::Never;
    case osg::AlphaFunc::LESS:
        return AlphaTest::Less;
    case osg::AlphaFunc::EQUAL:
        return AlphaTest::Equal;
    case osg::AlphaFunc::LEQUAL:
        return AlphaTest::LessOrEqual;
    case osg::AlphaFunc::GREATER:
        return AlphaTest::Greater;
    case osg::AlphaFunc::NOTEQUAL:
        return AlphaTest::NotEqual;
    case osg::AlphaFunc::GEQUAL:
        return AlphaTest::GreaterOrEqual;
    case osg::AlphaFunc::ALWAYS:
        return AlphaTest::Always;
    }
    return AlphaTest::Always;
}

} // namespace

bool setsCurrentColor(const GraphState& state)
{
    const auto* source = state.attribute<osg::Material>(kMaterialSlot);
    return source && rgb(currentColorOf(*source)) != kDefaultColor;
}

Material MaterialConverter::material(const GraphState& state, const SurfaceInputs& inputs,
                                     const SurfacePlacement& placement)
{
    countApproximations(state, _report);
    const bool isPhysical = state.attribute<PhysicalMaterial>(kPhysicalMaterialSlot) != nullptr;
    Material material = isPhysical ? physical(state, inputs) : fixedFunction(state, inputs);
    applyOpacity(material, state);
    applyFaces(material, state, placement);
    material.fog = fogOf(state);
    if (_rules.linear) material.fog.color = decoded(material.fog.color);
    if (!isPhysical)
    {
        applyTextureUnits(material, state, placement, _textures, _report);
        if (_rules.linear) decode(material);
    }
    return material;
}

Material lampMaterial(const Vec3& radiance)
{
    Material material;
    material.name = "area light";
    material.model = MaterialModel::Physical;
    material.baseColor = Vec3(0.0f);
    material.ior = 1.0f;
    material.emission = radiance;
    material.lightMask = 0; // no light of OpenGL changes a black surface
    return material;
}

Material fallbackMaterial()
{
    Material material;
    material.name = "fallback";
    material.ambient = material.diffuse = Vec3(1.0f, 0.0f, 1.0f);
    material.lit = false;
    return material;
}

Material MaterialConverter::fixedFunction(const GraphState& state,
                                          const SurfaceInputs& inputs) const
{
    Material material;
    material.lit = state.isOn(kLightingBit);
    if (material.lit) enableLights(material, state);
    if (const auto* model = state.attribute<osg::LightModel>(kLightModelSlot))
    {
        material.twoSidedLighting = material.lit && model->getTwoSided();
        material.localViewer = material.lit && model->getLocalViewer();
        material.separateSpecular =
            material.lit && model->getColorControl() == osg::LightModel::SEPARATE_SPECULAR_COLOR;
    }
    if (const auto* source = state.attribute<osg::Material>(kMaterialSlot))
    {
        material.name = source->getName();
        setFront(material, faceColors(*source, kFront));
        material.back = faceColors(*source, osg::Material::BACK);
        material.hasBack = material.twoSidedLighting;
    }
    applyColor(material, state, inputs);
    if (material.hasBack)
    {
        Material back = material;
        setFront(back, material.back);
        back.hasBack = material.hasBack = false;
        applyColor(back, state, inputs);
        material.hasBack = !sameMaterial(material, back);
        material.back = frontOf(back);
    }
    if (inputs.isOfSolids && !material.lit)
    {
        material.lit = true; // with the colours that OpenGL shows without light
        enableLights(material, state);
    }
    return material;
}

/// Sets the colours. A state without any osg::Material has the one that osgViewer sets above the
/// scene: OpenGL's default with AMBIENT_AND_DIFFUSE [OSG 3.6.5, StateSet::setGlobalDefaults].
/// osg::Material::apply makes the diffuse colour the current one, which colours geometry without a
/// colour array.
///
/// At the end of a frame osg::State applies a default material that has no colour mode, with the
/// diffuse colour 0.8 and the ambient colour 0.2, and at the next frame the viewer's material. If
/// no other material came between the two, the current colour is 0.8 all along, and from the second
/// frame on Mesa (22.3) leaves the ambient colour at 0.2. osgviewer shows 0.2, and so does this
/// code; OpenGL's specification would have 0.8.
void MaterialConverter::applyColor(Material& material, const GraphState& state,
                                   const SurfaceInputs& inputs) const
{
    const auto* source = state.attribute<osg::Material>(kMaterialSlot);
    VertexColorUse use =
        vertexColorUse(source ? source->getColorMode() : osg::Material::AMBIENT_AND_DIFFUSE);
    if (!material.lit)
    {
        use = VertexColorUse::AmbientAndDiffuse;
        material.specular = Vec3(0.0f);
        material.emission = Vec3(0.0f);
        material.shininess = 0.0f;
    }
    if (inputs.hasVertexColors)
    {
        material.vertexColorUse = use;
        return;
    }
    if (inputs.hasOverallColor)
    {
        FaceColors face = frontOf(material);
        replaceColor(face, use, inputs.overallColor);
        setFront(material, face);
    }
    else if (use == VertexColorUse::AmbientAndDiffuse &&
             (_rules.setsColor || material.diffuse != kDefaultColor))
        material.ambient = material.diffuse;
}

/// Sets alpha, blending and alpha test. OpenGL writes alpha that is neither blended nor tested, but
/// nothing shows through.
void MaterialConverter::applyOpacity(Material& material, const GraphState& state) const
{
    material.blended = blendingOf(state) != Blending::Opaque;
    const auto* test = state.attribute<osg::AlphaFunc>(kAlphaFuncSlot);
    if (test && state.isOn(kAlphaTestBit))
    {
        material.alphaTest = comparisonOf(test->getFunction());
        material.alphaReference = std::clamp(finiteOr(test->getReferenceValue(), 0.0f), 0.0f, 1.0f);
    }
    if (!material.blended && material.alphaTest == AlphaTest::Always)
        material.alpha = material.back.alpha = 1.0f;
}

/// Sets culling and winding. A mirroring transform turns the winding that OpenGL sees, but not the
/// outside of the mesh.
void MaterialConverter::applyFaces(Material& material, const GraphState& state,
                                   const SurfacePlacement& placement) const
{
    material.culling = cullingOf(state);
    if (material.culling == FaceCulling::None && !material.twoSidedLighting) return;
    const auto* front = state.attribute<osg::FrontFace>(kFrontFaceSlot);
    const bool clockwise = front && front->getMode() == osg::FrontFace::CLOCKWISE;
    material.clockwise = clockwise != isMirrored(placement.engineFromLocal);
    // Lamps are sampled on both sides: rays that meet a lamp by chance must find both sides, too.
    const bool isLamp =
        material.model == MaterialModel::Physical && material.emission != Vec3(0.0f);
    material.cullsAllRays = _rules.cullAllRays && material.culling != FaceCulling::None && !isLamp;
}

Material MaterialConverter::physical(const GraphState& state, const SurfaceInputs& inputs)
{
    const auto& source = *state.attribute<PhysicalMaterial>(kPhysicalMaterialSlot);
    SurfaceInputs decodedInputs = inputs;
    if (_rules.linear)
        decodedInputs.overallColor =
            Vec4(decoded(Vec3(inputs.overallColor)), inputs.overallColor.w);
    Material material = physicalMaterial(source, decodedInputs, _textures, _report);
    enableLights(material, state);
    return material;
}

void MaterialConverter::decode(Material& material) const
{
    material.ambient = decoded(material.ambient);
    material.diffuse = decoded(material.diffuse);
    material.specular = decoded(material.specular);
    material.emission = decoded(material.emission);
    for (Vec3* color : {&material.back.ambient, &material.back.diffuse, &material.back.specular,
                        &material.back.emission})
        *color = decoded(*color);
    for (Vec4* color : {&material.environmentColor, &material.second.environmentColor})
        *color = Vec4(decoded(Vec3(*color)), color->w);
}

} // namespace osgRayTrace::engine
