// FixedFunction.cpp - sets what the rasterizer needs to show a material. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/FixedFunction.h"

#include "osgPlugins/gltf/Srgb.h"

#include <osg/AlphaFunc>
#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/TexEnv>
#include <osg/TexMat>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::gltf
{

namespace
{

constexpr float kDielectric = 0.04f; ///< reflectance at normal incidence of ior 1.5
constexpr float kShiniest = 128.0f;  ///< OpenGL's

/// Blinn's exponent of about the width of a GGX lobe, and a highlight that fades as it widens.
void setSpecular(const MaterialValues& values, osg::Material& material)
{
    const float roughness = std::clamp(values.roughness, 0.0f, 1.0f);
    const float metallic = std::clamp(values.metallic, 0.0f, 1.0f);
    const float alpha = std::max(roughness * roughness, 0.01f);
    osg::Vec4 specular = values.baseColor * metallic;
    for (int i = 0; i < 3; ++i)
        specular[i] = (specular[i] + kDielectric * values.specular * values.specularColor[i] *
                                         (1.0f - metallic)) *
                      (1.0f - roughness);
    specular = displayColor(specular);
    specular.a() = 1.0f;
    material.setSpecular(osg::Material::FRONT_AND_BACK, specular);
    material.setShininess(osg::Material::FRONT_AND_BACK,
                          std::clamp(2.0f / (alpha * alpha) - 2.0f, 0.0f, kShiniest));
}

osg::ref_ptr<osg::Material> materialOf(const MaterialValues& values, const SurfaceUse& use)
{
    const osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setName(values.name);
    osg::Vec4 color = displayColor(values.baseColor);
    if (values.alphaMode == AlphaMode::Opaque) color.a() = 1.0f;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, color);
    material->setAmbient(osg::Material::FRONT_AND_BACK, color);
    if (use.colors) material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    if (!values.emissionTexture)
        material->setEmission(osg::Material::FRONT_AND_BACK,
                              displayColor(osg::Vec4(values.emission, 1.0f)));
    setSpecular(values, *material);
    return material;
}

constexpr unsigned int kUnits = 8;    ///< as most of OpenGL's fixed functions have
constexpr unsigned int kOwnUnits = 2; ///< sets that keep the unit of their number

/// Returns a unit, from least on, for a texture of a set: that of its number, or one whose set no
/// texture of the material uses. kUnits if there is none.
unsigned int unitFor(unsigned int set, unsigned int least, unsigned int used)
{
    if (set >= least && set < kOwnUnits) return set;
    unsigned int unit = least;
    while (unit < kUnits && unit != set && (used >> unit & 1u))
        ++unit;
    return unit;
}

void setTexture(const TextureUse& use, unsigned int unit, osg::TexEnv::Mode mode, Surface& surface)
{
    if (unit >= kUnits) return;
    if (unit != use.set) surface.extraUnits.push_back({unit, use.set});
    osg::StateSet& states = *surface.states;
    states.setTextureAttributeAndModes(unit, use.texture);
    states.setTextureAttribute(unit, new osg::TexEnv(mode));
    if (use.transform)
        states.setTextureAttributeAndModes(unit, new osg::TexMat(use.transform->toMatrix()));
}

/// What shines is added by a unit behind that of the base colour. Surfaces that are not lit have
/// the base colour alone.
void setTextures(const MaterialValues& values, Surface& surface)
{
    const unsigned int used = surface.lit ? usedSets(values) : 0;
    unsigned int next = 0;
    if (values.baseColorTexture)
    {
        const unsigned int unit = unitFor(values.baseColorTexture->set, 0, used);
        setTexture(*values.baseColorTexture, unit, osg::TexEnv::MODULATE, surface);
        next = unit + 1;
    }
    if (!surface.lit || !values.emissionTexture || values.emission.length2() == 0.0f) return;
    const unsigned int unit = unitFor(values.emissionTexture->set, next, used);
    setTexture(*values.emissionTexture, unit, osg::TexEnv::ADD, surface);
}

void setAlpha(const MaterialValues& values, osg::StateSet& states)
{
    switch (values.alphaMode)
    {
    case AlphaMode::Opaque:
        return;
    case AlphaMode::Mask:
        states.setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::GEQUAL, values.alphaCutoff));
        return;
    case AlphaMode::Blend:
        states.setAttributeAndModes(
            new osg::BlendFunc(osg::BlendFunc::SRC_ALPHA, osg::BlendFunc::ONE_MINUS_SRC_ALPHA));
        states.setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    }
}

} // namespace

void setFixedFunction(const MaterialValues& values, const SurfaceUse& use, Surface& surface)
{
    osg::StateSet& states = *surface.states;
    states.setName(values.name);
    if (surface.lit)
        states.setAttributeAndModes(materialOf(values, use).get());
    else
        states.setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    setTextures(values, surface);
    setAlpha(values, states);
    // The inside of glass is seen through its front.
    if (values.doubleSided || values.transmission > 0.0f)
    {
        states.setMode(GL_CULL_FACE, osg::StateAttribute::OFF);
        const osg::ref_ptr<osg::LightModel> bothSides = new osg::LightModel;
        bothSides->setTwoSided(true);
        states.setAttributeAndModes(bothSides.get());
    }
    else
        states.setAttributeAndModes(new osg::CullFace(osg::CullFace::BACK));
}

} // namespace osgRayTrace::gltf
