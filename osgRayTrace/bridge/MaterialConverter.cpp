// MaterialConverter.cpp - what OpenGL's state says about a surface. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/MaterialConverter.h"

#include "osgRayTrace/bridge/VertexArrays.h"
#include "osgRayTrace/film/ToneMap.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/ClipPlane>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/PolygonMode>
#include <osg/Program>
#include <osg/TexEnv>
#include <osg/TexMat>

#include <algorithm>
#include <cmath>
#include <cstring>

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

Vec3 rgb(const osg::Vec3& color)
{
    return {color.x(), color.y(), color.z()};
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

/// Does to the whole material what a vertex colour would do.
void replaceColor(Material& material, VertexColorUse use, const Vec4& color)
{
    const Vec3 value(color);
    switch (use)
    {
    case VertexColorUse::None:
        break;
    case VertexColorUse::Ambient:
        material.ambient = value;
        break;
    case VertexColorUse::Specular:
        material.specular = value;
        break;
    case VertexColorUse::Emission:
        material.emission = value;
        break;
    case VertexColorUse::AmbientAndDiffuse:
        material.ambient = value;
        material.diffuse = value;
        material.alpha = color.w;
        break;
    case VertexColorUse::Diffuse:
        material.diffuse = value;
        material.alpha = color.w;
        break;
    }
}

/// The values that decide on the picture, for comparison.
std::vector<uint32_t> valuesOf(const Material& m)
{
    std::vector<uint32_t> values;
    values.reserve(40);
    const auto add = [&values](float value)
    {
        uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        values.push_back(bits);
    };
    for (const Vec3& color : {m.ambient, m.diffuse, m.specular, m.baseColor, m.emission})
        for (int c = 0; c < 3; ++c)
            add(color[c]);
    for (const float value : {m.shininess, m.metallic, m.roughness, m.transmission, m.ior, m.alpha})
        add(value);
    values.insert(values.end(),
                  {static_cast<uint32_t>(m.model), uint32_t(m.lit), uint32_t(m.twoSidedLighting),
                   m.lightMask, static_cast<uint32_t>(m.vertexColorUse),
                   static_cast<uint32_t>(m.textureEnvironment), m.baseColorTexture,
                   m.metallicRoughnessTexture, m.transmissionTexture, m.emissionTexture});
    return values;
}

} // namespace

bool sameMaterial(const Material& a, const Material& b)
{
    return valuesOf(a) == valuesOf(b);
}

SurfaceInputs surfaceInputs(const osg::Geometry& geometry)
{
    SurfaceInputs inputs;
    inputs.hasTextureCoordinates = isReadable(geometry.getTexCoordArray(0));
    const osg::Array* colors = geometry.getColorArray();
    const osg::Array::Binding binding = bindingOf(colors);
    inputs.hasVertexColors =
        binding == osg::Array::BIND_PER_VERTEX || binding == osg::Array::BIND_PER_PRIMITIVE_SET;
    if (binding != osg::Array::BIND_OVERALL) return inputs;
    forEachRow(*colors, {1, nullptr, IntegerMeaning::Normalized},
               [&inputs](std::size_t, const Vec4d& row)
               {
                   inputs.overallColor = Vec4(row);
                   inputs.hasOverallColor = isFinite(Vec3(row)) && std::isfinite(row.w);
               });
    return inputs;
}

uint32_t MaterialConverter::index(const GraphState& state, const SurfaceInputs& inputs)
{
    countApproximations(state);
    if (state.attribute<PhysicalMaterial>(kPhysicalMaterialSlot))
        return merged(physical(state, inputs));
    Material material = fixedFunction(state, inputs);
    if (_linear) decode(material);
    applyTexture(material, state, inputs);
    return merged(material);
}

uint32_t MaterialConverter::lampIndex(const Vec3& radiance)
{
    Material material;
    material.name = "area light";
    material.model = MaterialModel::Physical;
    material.baseColor = Vec3(0.0f);
    material.ior = 1.0f;
    material.emission = radiance;
    material.lightMask = 0; // black: no light of OpenGL changes it
    return merged(material);
}

Material MaterialConverter::fixedFunction(const GraphState& state,
                                          const SurfaceInputs& inputs) const
{
    Material material;
    material.lit = state.isOn(kLightingBit);
    material.lightMask = material.lit ? static_cast<uint32_t>(state.modesOn) : 0xffffffffu;
    if (const auto* model = state.attribute<osg::LightModel>(kLightModelSlot))
        material.twoSidedLighting = material.lit && model->getTwoSided();
    if (const auto* source = state.attribute<osg::Material>(kMaterialSlot))
    {
        material.name = source->getName();
        material.ambient = rgb(source->getAmbient(kFront));
        material.diffuse = rgb(source->getDiffuse(kFront));
        material.specular = rgb(source->getSpecular(kFront));
        material.emission = rgb(source->getEmission(kFront));
        material.alpha = finiteOr(source->getDiffuse(kFront).a(), 1.0f);
        material.shininess =
            std::clamp(finiteOr(source->getShininess(kFront), 0.0f), 0.0f, kLargestShininess);
    }
    applyColor(material, state, inputs);
    if (!state.isOn(kBlendBit))
        material.alpha = 1.0f; // OpenGL writes it, but nothing shows through
    return material;
}

/// Without any osg::Material there is the one that osgViewer sets above the scene: OpenGL's default
/// with AMBIENT_AND_DIFFUSE [OSG 3.6.5, StateSet::setGlobalDefaults]. osg::Material::apply makes
/// its diffuse colour the current one, which colours geometry without a colour array.
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
        replaceColor(material, use, inputs.overallColor);
    else if (use == VertexColorUse::AmbientAndDiffuse)
        material.ambient = material.diffuse;
}

void MaterialConverter::applyTexture(Material& material, const GraphState& state,
                                     const SurfaceInputs& inputs)
{
    if (state.isOn(kOtherTextureBit)) _report.count("approximated.texture-target");
    if (!state.isOn(kTexture2DBit)) return;
    const auto* texture = state.attribute<osg::Texture2D>(kTextureSlot);
    if (!texture) return;
    if (state.isOn(kTexGenBit))
    {
        _report.count("approximated.texgen");
        return;
    }
    if (!inputs.hasTextureCoordinates)
    {
        _report.count("approximated.no-texture-coordinates");
        return;
    }
    if (state.attributes[kTextureMatrixSlot]) _report.count("approximated.texture-matrix");
    material.baseColorTexture = _textures.index(texture, TextureContent::Color, _report);

    const osg::StateAttribute* environment = state.attributes[kTextureEnvironmentSlot];
    if (!environment) return;
    const auto* plain = dynamic_cast<const osg::TexEnv*>(environment);
    const osg::TexEnv::Mode mode = plain ? plain->getMode() : osg::TexEnv::ADD;
    if (mode == osg::TexEnv::REPLACE)
        material.textureEnvironment = TextureEnvironment::Replace;
    else if (mode == osg::TexEnv::DECAL)
        material.textureEnvironment = TextureEnvironment::Decal;
    else if (mode != osg::TexEnv::MODULATE)
        _report.count("approximated.texture-environment");
}

Material MaterialConverter::physical(const GraphState& state, const SurfaceInputs& inputs)
{
    const auto& source = *state.attribute<PhysicalMaterial>(kPhysicalMaterialSlot);
    Material material;
    material.name = source.getName();
    material.model = MaterialModel::Physical;
    material.lightMask = static_cast<uint32_t>(state.modesOn);
    material.baseColor = rgb(source.getBaseColor());
    material.metallic = source.getMetallic();
    material.roughness = source.getRoughness();
    material.transmission = source.getTransmission();
    material.ior = source.getIor();
    material.emission = rgb(source.getEmission());
    if (!inputs.hasTextureCoordinates)
    {
        if (source.getBaseColorTexture() || source.getMetallicRoughnessTexture() ||
            source.getTransmissionTexture() || source.getEmissionTexture())
            _report.count("approximated.no-texture-coordinates");
        return material;
    }
    const auto color = TextureContent::Color;
    const auto data = TextureContent::Data;
    material.baseColorTexture = _textures.index(source.getBaseColorTexture(), color, _report);
    material.emissionTexture = _textures.index(source.getEmissionTexture(), color, _report);
    material.transmissionTexture = _textures.index(source.getTransmissionTexture(), data, _report);
    material.metallicRoughnessTexture =
        _textures.index(source.getMetallicRoughnessTexture(), data, _report);
    return material;
}

void MaterialConverter::decode(Material& material) const
{
    material.ambient = decoded(material.ambient);
    material.diffuse = decoded(material.diffuse);
    material.specular = decoded(material.specular);
    material.emission = decoded(material.emission);
}

void MaterialConverter::countApproximations(const GraphState& state)
{
    const auto* program = state.attribute<osg::Program>(kProgramSlot);
    if (program && !program->isFixedFunction()) _report.count("approximated.shader");
    if (state.isOn(kBlendBit)) _report.count("approximated.blending");
    if (state.isOn(kAlphaTestBit)) _report.count("approximated.alpha-test");
    if (state.isOn(kCullFaceBit)) _report.count("approximated.cull-face");
    if (state.isOn(kFogBit)) _report.count("approximated.fog");
    const auto* plane = state.attribute<osg::ClipPlane>(kClipPlaneSlot);
    if (plane && plane->getClipPlaneNum() < kClipPlanes &&
        state.isOn(kClipPlaneBit + plane->getClipPlaneNum()))
        _report.count("approximated.clip-plane-attribute");
    if (state.usesHigherTextures()) _report.count("approximated.texture-unit");
    if (const auto* mode = state.attribute<osg::PolygonMode>(kPolygonModeSlot))
        if (mode->getMode(osg::PolygonMode::FRONT) != osg::PolygonMode::FILL)
            _report.count("approximated.polygon-mode");
}

uint32_t MaterialConverter::merged(const Material& material)
{
    const auto [known, isNew] =
        _known.try_emplace(valuesOf(material), static_cast<uint32_t>(_materials.size()));
    if (isNew) _materials.push_back(material);
    return known->second;
}

} // namespace osgRayTrace::engine
