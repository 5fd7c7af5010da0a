// StateGenerator.cpp - state sets, textures and lights with values that nobody would set. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "StateGenerator.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/BlendFunc>
#include <osg/ClipPlane>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/PolygonMode>
#include <osg/PrimitiveRestartIndex>
#include <osg/TexEnv>
#include <osg/TexEnvCombine>
#include <osg/TexGen>
#include <osg/TexMat>
#include <osg/Texture1D>
#include <osg/Texture2D>

#include <cmath>
#include <limits>

namespace osgRayTrace::test
{

namespace
{

osg::Vec4 strangeColor(Dice& dice, int rarity)
{
    osg::Vec4 color;
    for (int c = 0; c < 4; ++c)
        color[c] = strangeFloat(dice, 1.0, rarity);
    return color;
}

osg::Vec3 strangeVector(Dice& dice, double size, int rarity)
{
    return {strangeFloat(dice, size, rarity), strangeFloat(dice, size, rarity),
            strangeFloat(dice, size, rarity)};
}

constexpr GLenum kFormats[] = {GL_RGBA,
                               GL_RGBA,
                               GL_RGB,
                               GL_BGRA,
                               GL_BGR,
                               GL_LUMINANCE,
                               GL_LUMINANCE_ALPHA,
                               GL_ALPHA,
                               GL_INTENSITY,
                               GL_RED,
                               GL_RG,
                               GL_DEPTH_COMPONENT,
                               GL_COLOR_INDEX,
                               GL_STENCIL_INDEX,
                               GL_COMPRESSED_RGB_S3TC_DXT1_EXT,
                               GL_COMPRESSED_RGBA_S3TC_DXT3_EXT,
                               GL_COMPRESSED_RGBA_S3TC_DXT5_EXT,
                               GL_COMPRESSED_RED_RGTC1_EXT,
                               0x12345u};

constexpr GLenum kTypes[] = {GL_UNSIGNED_BYTE,
                             GL_UNSIGNED_BYTE,
                             GL_UNSIGNED_BYTE,
                             GL_BYTE,
                             GL_UNSIGNED_SHORT,
                             GL_SHORT,
                             GL_UNSIGNED_INT,
                             GL_INT,
                             GL_FLOAT,
                             GL_HALF_FLOAT,
                             GL_DOUBLE,
                             GL_UNSIGNED_SHORT_5_6_5,
                             GL_UNSIGNED_SHORT_4_4_4_4,
                             GL_UNSIGNED_INT_8_8_8_8_REV,
                             GL_BITMAP,
                             0u};

osg::ref_ptr<osg::Texture2D> randomTexture(Dice& dice)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    if (!dice.oneIn(12)) texture->setImage(randomImage(dice));
    constexpr osg::Texture::WrapMode kWraps[] = {osg::Texture::REPEAT, osg::Texture::MIRROR,
                                                 osg::Texture::CLAMP, osg::Texture::CLAMP_TO_EDGE,
                                                 osg::Texture::CLAMP_TO_BORDER};
    texture->setWrap(osg::Texture::WRAP_S, dice.oneOf(kWraps));
    texture->setWrap(osg::Texture::WRAP_T, dice.oneOf(kWraps));
    if (dice.oneIn(2)) texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    if (dice.oneIn(4)) texture->setInternalFormat(GL_SRGB8);
    return texture;
}

osg::ref_ptr<osg::Material> randomMaterial(Dice& dice)
{
    osg::ref_ptr<osg::Material> material = new osg::Material;
    const auto face = osg::Material::FRONT_AND_BACK;
    material->setAmbient(face, strangeColor(dice, 8));
    material->setDiffuse(face, strangeColor(dice, 8));
    material->setSpecular(face, strangeColor(dice, 8));
    material->setEmission(face, strangeColor(dice, 8));
    material->setShininess(face, strangeFloat(dice, 128.0, 4));
    constexpr osg::Material::ColorMode kModes[] = {
        osg::Material::OFF,      osg::Material::AMBIENT,  osg::Material::DIFFUSE,
        osg::Material::SPECULAR, osg::Material::EMISSION, osg::Material::AMBIENT_AND_DIFFUSE};
    material->setColorMode(dice.oneOf(kModes));
    return material;
}

/// Sets the parameters that few surfaces have, some of them to strange values.
template <std::size_t N>
void addDetails(PhysicalMaterial& material, Dice& dice, const float (&units)[N])
{
    material.setAlpha(dice.oneOf(units));
    material.setVertexColors(dice.oneIn(2));
    material.setThinWalled(dice.oneIn(2));
    if (dice.oneIn(2)) material.setAttenuationColor(strangeVector(dice, 1.0, 6));
    if (dice.oneIn(2)) material.setAttenuationDistance(strangeFloat(dice, 2.0, 3));
    if (dice.oneIn(2)) material.setSpecular(dice.oneOf(units));
    if (dice.oneIn(2)) material.setSpecularColor(strangeVector(dice, 10.0, 3));
    if (dice.oneIn(2)) material.setClearcoat(dice.oneOf(units));
    material.setClearcoatRoughness(dice.oneOf(units));
    if (dice.oneIn(2)) material.setClearcoatNormalScale(strangeFloat(dice, 2.0, 4));
    if (dice.oneIn(2)) material.setSheenColor(strangeVector(dice, 1.0, 6));
    material.setSheenRoughness(dice.oneOf(units));
    if (dice.oneIn(3)) material.setAnisotropy(dice.oneOf(units));
    if (dice.oneIn(3)) material.setAnisotropyRotation(strangeFloat(dice, 6.0, 6));
    if (dice.oneIn(3)) material.setDiffuseTransmission(dice.oneOf(units));
    if (dice.oneIn(3)) material.setDiffuseTransmissionColor(strangeVector(dice, 1.0, 6));
    if (dice.oneIn(4)) material.setSubsurface(dice.oneOf(units));
    if (dice.oneIn(4)) material.setSubsurfaceRadius(strangeVector(dice, 1.0, 6));
    if (dice.oneIn(3)) material.setIridescence(dice.oneOf(units));
    if (dice.oneIn(3)) material.setIridescenceIor(strangeFloat(dice, 3.0, 3));
    if (dice.oneIn(3)) material.setIridescenceThicknessMinimum(strangeFloat(dice, 1000.0, 3));
    if (dice.oneIn(3)) material.setIridescenceThicknessMaximum(strangeFloat(dice, 1000.0, 3));
    if (dice.oneIn(2)) material.setNormalScale(strangeFloat(dice, 2.0, 4));
    for (int i = PhysicalMaterial::NORMAL_TEXTURE; i < PhysicalMaterial::NUMBER_OF_TEXTURES; ++i)
    {
        const auto use = static_cast<PhysicalMaterial::TextureUse>(i);
        if (dice.oneIn(4)) material.setTexture(use, randomTexture(dice).get());
        PhysicalMaterial::TexturePlace place;
        place.unit = dice.oneIn(2) ? 1 : 0;
        place.rotation = strangeFloat(dice, 6.0, 6);
        place.scale.set(strangeFloat(dice, 2.0, 6), strangeFloat(dice, 2.0, 6));
        if (dice.oneIn(4)) material.setTexturePlace(use, place);
    }
}

osg::ref_ptr<PhysicalMaterial> randomPhysical(Dice& dice)
{
    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    constexpr float kUnits[] = {0.0f, 0.0f, 1.0f, 1.0f, 1e-30f, 1e-5f, 0.5f, 0.99999994f};
    constexpr float kIors[] = {1.0f, 1.0000001f, 1.5f, 4.0f, 0.0f, -1.0f, 1e30f};
    material->setBaseColor(strangeVector(dice, 1.0, 6));
    material->setMetallic(dice.oneOf(kUnits));
    material->setRoughness(dice.oneOf(kUnits));
    material->setTransmission(dice.oneOf(kUnits));
    material->setIor(dice.oneOf(kIors));
    if (dice.oneIn(4)) material->setRoughness(strangeFloat(dice, 2.0, 2));
    if (dice.oneIn(4)) material->setEmission(strangeVector(dice, 10.0, 3));
    if (dice.oneIn(4)) material->setBaseColorTexture(randomTexture(dice).get());
    if (dice.oneIn(4)) material->setMetallicRoughnessTexture(randomTexture(dice).get());
    if (dice.oneIn(4)) material->setTransmissionTexture(randomTexture(dice).get());
    if (dice.oneIn(4)) material->setEmissionTexture(randomTexture(dice).get());
    if (dice.oneIn(2)) addDetails(*material, dice, kUnits);
    return material;
}

osg::StateAttribute::GLModeValue randomMode(Dice& dice)
{
    using osg::StateAttribute;
    const unsigned int on = dice.oneIn(3) ? StateAttribute::OFF : StateAttribute::ON;
    if (dice.oneIn(8)) return on | StateAttribute::OVERRIDE;
    return dice.oneIn(8) ? on | StateAttribute::PROTECTED : on;
}

void addTextures(osg::StateSet& stateSet, Dice& dice)
{
    stateSet.setTextureAttributeAndModes(0, randomTexture(dice), randomMode(dice));
    if (dice.oneIn(6))
        stateSet.setTextureAttributeAndModes(0, new osg::Texture1D, randomMode(dice));
    if (dice.oneIn(6))
        stateSet.setTextureAttributeAndModes(1, randomTexture(dice), randomMode(dice));
    if (dice.oneIn(6)) stateSet.setTextureAttributeAndModes(0, new osg::TexGen, randomMode(dice));
    if (dice.oneIn(6)) stateSet.setTextureAttribute(0, new osg::TexMat);
    constexpr osg::TexEnv::Mode kModes[] = {osg::TexEnv::MODULATE, osg::TexEnv::REPLACE,
                                            osg::TexEnv::DECAL, osg::TexEnv::BLEND,
                                            osg::TexEnv::ADD};
    if (dice.oneIn(2)) stateSet.setTextureAttribute(0, new osg::TexEnv(dice.oneOf(kModes)));
    if (dice.oneIn(9)) stateSet.setTextureAttribute(0, new osg::TexEnvCombine);
}

} // namespace

osg::ref_ptr<osg::Image> randomImage(Dice& dice)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    if (dice.oneIn(10)) return image;
    constexpr int kPackings[] = {1, 1, 2, 4, 8};
    const int width = 1 + dice.below(17), height = 1 + dice.below(9);
    image->allocateImage(width, height, dice.oneIn(8) ? 2 : 1, dice.oneOf(kFormats),
                         dice.oneOf(kTypes), dice.oneOf(kPackings));
    if (image->data())
        for (unsigned int i = 0; i < image->getTotalSizeInBytes(); ++i)
            image->data()[i] = static_cast<unsigned char>(dice.bits());
    return image;
}

float strangeFloat(Dice& dice, double size, int rarity)
{
    const double value = dice.strange(size, rarity);
    return std::fabs(value) > 3.5e38 ? std::numeric_limits<float>::infinity()
                                     : static_cast<float>(value);
}

osg::ref_ptr<osg::StateSet> randomStateSet(Dice& dice)
{
    osg::ref_ptr<osg::StateSet> stateSet = new osg::StateSet;
    if (dice.oneIn(2)) stateSet->setAttribute(randomMaterial(dice), randomMode(dice));
    if (dice.oneIn(2)) stateSet->setAttribute(randomPhysical(dice), randomMode(dice));
    if (dice.oneIn(2)) addTextures(*stateSet, dice);
    if (dice.oneIn(3)) stateSet->setMode(GL_LIGHTING, randomMode(dice));
    if (dice.oneIn(9))
        stateSet->setAttribute(
            new osg::PrimitiveRestartIndex(static_cast<unsigned int>(dice.below(300))));
    if (dice.oneIn(9)) stateSet->setMode(GL_PRIMITIVE_RESTART, randomMode(dice));
    if (dice.oneIn(9)) stateSet->setMode(0x8D69, randomMode(dice)); // restart at the largest index
    if (dice.oneIn(9))
        stateSet->setAttributeAndModes(
            new osg::ClipPlane(static_cast<unsigned int>(dice.below(10))));
    if (dice.oneIn(3)) stateSet->setAttributeAndModes(new osg::BlendFunc, randomMode(dice));
    if (dice.oneIn(6))
        stateSet->setAttribute(
            new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, osg::PolygonMode::LINE));
    for (const GLenum mode :
         {GL_ALPHA_TEST, GL_CULL_FACE, GL_FOG, GL_CLIP_PLANE0, GL_LIGHT0, GL_LIGHT3})
        if (dice.oneIn(6)) stateSet->setMode(mode, randomMode(dice));
    if (dice.oneIn(5))
    {
        osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
        model->setAmbientIntensity(strangeColor(dice, 4));
        model->setTwoSided(dice.oneIn(2));
        stateSet->setAttribute(model, randomMode(dice));
    }
    return stateSet;
}

osg::ref_ptr<osg::Light> randomLight(Dice& dice)
{
    const int number = dice.oneIn(8) ? dice.below(80) - 40 : dice.below(8);
    osg::ref_ptr<osg::Light> light = new osg::Light(static_cast<unsigned int>(number));
    const int rarity = dice.oneIn(2) ? 1 << 30 : 8;
    light->setAmbient(strangeColor(dice, rarity));
    light->setDiffuse(strangeColor(dice, rarity));
    light->setSpecular(strangeColor(dice, rarity));
    osg::Vec4 position(strangeVector(dice, 5.0, rarity), dice.oneIn(2) ? 1.0f : 0.0f);
    if (dice.oneIn(6)) position.w() = strangeFloat(dice, 2.0, 2);
    light->setPosition(position);
    light->setDirection(strangeVector(dice, 1.0, rarity));
    light->setConstantAttenuation(strangeFloat(dice, 1.0, rarity));
    light->setLinearAttenuation(strangeFloat(dice, 1.0, rarity));
    light->setQuadraticAttenuation(strangeFloat(dice, 1.0, rarity));
    light->setSpotExponent(strangeFloat(dice, 128.0, rarity));
    light->setSpotCutoff(dice.oneIn(2) ? 180.0f : strangeFloat(dice, 180.0, rarity));
    return light;
}

} // namespace osgRayTrace::test
