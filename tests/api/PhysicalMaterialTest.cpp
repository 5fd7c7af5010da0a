// PhysicalMaterialTest.cpp - tests of the material as a state attribute.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/Material>
#include <osg/State>
#include <osg/StateSet>

#include <limits>
#include <set>

using osgRayTrace::PhysicalMaterial;

namespace
{

const PhysicalMaterial* materialOf(const osg::State& state)
{
    return static_cast<const PhysicalMaterial*>(
        state.getLastAppliedAttribute(PhysicalMaterial::ATTRIBUTE_TYPE));
}

} // namespace

TEST_CASE("material: its type is none of OSG's own", "[api][material]")
{
    CHECK(int(PhysicalMaterial::ATTRIBUTE_TYPE) > int(osg::StateAttribute::CAPABILITY));
    CHECK(int(PhysicalMaterial::ATTRIBUTE_TYPE) <= 127);
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    CHECK(material->getType() == PhysicalMaterial::ATTRIBUTE_TYPE);
    CHECK_FALSE(material->isTextureAttribute());
}

TEST_CASE("material: it lives beside osg::Material in a state set", "[api][material]")
{
    const osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    const osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    set->setAttributeAndModes(new osg::Material);
    set->setAttributeAndModes(physical, osg::StateAttribute::OVERRIDE);

    CHECK(set->getAttributeList().size() == 2);
    CHECK(set->getAttribute(PhysicalMaterial::ATTRIBUTE_TYPE) == physical);
    const auto* pair = set->getAttributePair(PhysicalMaterial::ATTRIBUTE_TYPE);
    REQUIRE(pair);
    CHECK((pair->second & osg::StateAttribute::OVERRIDE) != 0);
    set->removeAttribute(PhysicalMaterial::ATTRIBUTE_TYPE);
    CHECK(set->getAttributeList().size() == 1);
}

TEST_CASE("material: osg::State pushes, overrides and pops it", "[api][material]")
{
    const osg::ref_ptr<PhysicalMaterial> outer = new PhysicalMaterial;
    const osg::ref_ptr<PhysicalMaterial> inner = new PhysicalMaterial;
    const osg::ref_ptr<osg::StateSet> outerSet = new osg::StateSet;
    const osg::ref_ptr<osg::StateSet> innerSet = new osg::StateSet;
    outerSet->setAttribute(outer);
    innerSet->setAttribute(inner);

    const osg::ref_ptr<osg::State> state = new osg::State;
    state->setCheckForGLErrors(osg::State::NEVER_CHECK_GL_ERRORS);
    const auto current = [&state]
    {
        const osg::ref_ptr<osg::StateSet> captured = new osg::StateSet;
        state->captureCurrentState(*captured);
        return captured->getAttribute(PhysicalMaterial::ATTRIBUTE_TYPE);
    };
    state->pushStateSet(outerSet);
    CHECK(current() == outer);
    state->pushStateSet(innerSet);
    CHECK(current() == inner);
    state->popStateSet();
    CHECK(current() == outer);
    state->popStateSet();
    CHECK(current() == nullptr);

    outerSet->setAttribute(outer, osg::StateAttribute::OVERRIDE);
    state->pushStateSet(outerSet);
    state->pushStateSet(innerSet);
    CHECK(current() == outer);
    innerSet->setAttribute(inner, osg::StateAttribute::PROTECTED);
    state->popStateSet();
    state->pushStateSet(innerSet);
    CHECK(current() == inner);
    state->popAllStateSets();

    state->applyAttribute(outer);
    CHECK(materialOf(*state) == outer);
}

TEST_CASE("material: values are kept within their range", "[api][material]")
{
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    CHECK(material->getBaseColor() == osg::Vec3(1.0f, 1.0f, 1.0f));
    CHECK(material->getMetallic() == 0.0f);
    CHECK(material->getRoughness() == 1.0f);
    CHECK(material->getTransmission() == 0.0f);
    CHECK(material->getIor() == 1.5f);
    CHECK(material->getEmission() == osg::Vec3());

    material->setBaseColor(osg::Vec3(-1.0f, 0.5f, 2.0f));
    CHECK(material->getBaseColor() == osg::Vec3(0.0f, 0.5f, 1.0f));
    material->setMetallic(3.0f);
    CHECK(material->getMetallic() == 1.0f);
    material->setRoughness(-3.0f);
    CHECK(material->getRoughness() == 0.0f);
    material->setTransmission(1.5f);
    CHECK(material->getTransmission() == 1.0f);
    material->setIor(0.5f);
    CHECK(material->getIor() == 1.0f);
    material->setIor(9.0f);
    CHECK(material->getIor() == 4.0f);
    material->setEmission(osg::Vec3(1.0e6f, -1.0f, 0.0f));
    CHECK(material->getEmission() == osg::Vec3(1.0e6f, 0.0f, 0.0f));

    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    material->setIor(nan);
    CHECK(material->getIor() == 4.0f);
    material->setEmission(osg::Vec3(2.0f, infinity, nan));
    CHECK(material->getEmission() == osg::Vec3(2.0f, 0.0f, 0.0f));
}

TEST_CASE("material: the parameters of glTF's extensions begin as glTF has them", "[api][material]")
{
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    CHECK(material->getAlpha() == 1.0f);
    CHECK_FALSE(material->getVertexColors());
    CHECK(material->getNormalScale() == 1.0f);
    CHECK_FALSE(material->getThinWalled());
    CHECK(material->getAttenuationColor() == osg::Vec3(1.0f, 1.0f, 1.0f));
    CHECK(material->getAttenuationDistance() == 0.0f);
    CHECK(material->getSpecular() == 1.0f);
    CHECK(material->getSpecularColor() == osg::Vec3(1.0f, 1.0f, 1.0f));
    CHECK(material->getClearcoat() == 0.0f);
    CHECK(material->getClearcoatRoughness() == 0.0f);
    CHECK(material->getClearcoatNormalScale() == 1.0f);
    CHECK(material->getSheenColor() == osg::Vec3());
    CHECK(material->getSheenRoughness() == 0.0f);
    CHECK(material->getAnisotropy() == 0.0f);
    CHECK(material->getAnisotropyRotation() == 0.0f);
    CHECK(material->getDiffuseTransmission() == 0.0f);
    CHECK(material->getDiffuseTransmissionColor() == osg::Vec3(1.0f, 1.0f, 1.0f));
    CHECK(material->getSubsurface() == 0.0f);
    CHECK(material->getSubsurfaceRadius() == osg::Vec3(1.0f, 1.0f, 1.0f));
    CHECK(material->getIridescence() == 0.0f);
    CHECK(material->getIridescenceIor() == 1.3f);
    CHECK(material->getIridescenceThicknessMinimum() == 100.0f);
    CHECK(material->getIridescenceThicknessMaximum() == 400.0f);

    material->setAttenuationDistance(-1.0f);
    CHECK(material->getAttenuationDistance() == 0.0f);
    material->setSpecularColor(osg::Vec3(3.0f, -1.0f, 0.0f));
    CHECK(material->getSpecularColor() == osg::Vec3(3.0f, 0.0f, 0.0f));
    material->setSubsurface(2.0f);
    CHECK(material->getSubsurface() == 1.0f);
    material->setSubsurfaceRadius(osg::Vec3(3.0f, -1.0f, 0.0f));
    CHECK(material->getSubsurfaceRadius() == osg::Vec3(3.0f, 0.0f, 0.0f));
    material->setNormalScale(-20.0f);
    CHECK(material->getNormalScale() == -16.0f);
    PhysicalMaterial::TexturePlace place;
    place.unit = 9;
    place.offset.set(std::numeric_limits<float>::quiet_NaN(), 2.0f);
    material->setTexturePlace(PhysicalMaterial::NORMAL_TEXTURE, place);
    const auto& kept = material->getTexturePlace(PhysicalMaterial::NORMAL_TEXTURE);
    CHECK(kept.unit == 7);
    CHECK(kept.offset == osg::Vec2(0.0f, 2.0f));
    CHECK(kept.scale == osg::Vec2(1.0f, 1.0f));
    CHECK(material->getTexturePlace(PhysicalMaterial::EMISSION_TEXTURE).unit == 0);
}

TEST_CASE("material: comparison sees every parameter", "[api][material]")
{
    const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    std::vector<osg::ref_ptr<PhysicalMaterial>> all;
    for (int i = 0; i < 11 + 23 + 2 * PhysicalMaterial::NUMBER_OF_TEXTURES - 4; ++i)
    {
        all.push_back(new PhysicalMaterial);
    }
    all[1]->setBaseColor(osg::Vec3(0.5f, 0.5f, 0.5f));
    all[2]->setMetallic(1.0f);
    all[3]->setRoughness(0.5f);
    all[4]->setTransmission(1.0f);
    all[5]->setIor(2.0f);
    all[6]->setEmission(osg::Vec3(1.0f, 1.0f, 1.0f));
    all[7]->setBaseColorTexture(texture);
    all[8]->setMetallicRoughnessTexture(texture);
    all[9]->setTransmissionTexture(texture);
    all[10]->setEmissionTexture(texture);
    all[11]->setAlpha(0.5f);
    all[12]->setVertexColors(true);
    all[13]->setNormalScale(2.0f);
    all[14]->setThinWalled(true);
    all[15]->setAttenuationColor(osg::Vec3(0.5f, 1.0f, 1.0f));
    all[16]->setAttenuationDistance(2.0f);
    all[17]->setSpecular(0.5f);
    all[18]->setSpecularColor(osg::Vec3(0.5f, 1.0f, 1.0f));
    all[19]->setClearcoat(0.5f);
    all[20]->setClearcoatRoughness(0.5f);
    all[21]->setSheenColor(osg::Vec3(0.5f, 0.0f, 0.0f));
    all[22]->setSheenRoughness(0.5f);
    all[23]->setAnisotropy(0.5f);
    all[24]->setAnisotropyRotation(0.5f);
    all[25]->setDiffuseTransmission(0.5f);
    all[26]->setDiffuseTransmissionColor(osg::Vec3(0.5f, 1.0f, 1.0f));
    all[27]->setIridescence(0.5f);
    all[28]->setIridescenceIor(1.5f);
    all[29]->setIridescenceThicknessMinimum(200.0f);
    all[30]->setIridescenceThicknessMaximum(500.0f);
    all[31]->setClearcoatNormalScale(2.0f);
    all[32]->setSubsurface(0.5f);
    all[33]->setSubsurfaceRadius(osg::Vec3(1.0f, 0.2f, 0.1f));
    std::size_t next = 34;
    for (int i = 0; i < PhysicalMaterial::NUMBER_OF_TEXTURES; ++i)
    {
        const auto use = static_cast<PhysicalMaterial::TextureUse>(i);
        if (i >= PhysicalMaterial::NORMAL_TEXTURE) all[next++]->setTexture(use, texture);
        PhysicalMaterial::TexturePlace place;
        place.rotation = 1.0f;
        all[next++]->setTexturePlace(use, place);
    }
    REQUIRE(next == all.size());

    for (size_t i = 0; i < all.size(); ++i)
    {
        for (size_t j = 0; j < all.size(); ++j)
        {
            INFO(i << " against " << j);
            CHECK((all[i]->compare(*all[j]) == 0) == (i == j));
            CHECK(all[i]->compare(*all[j]) == -all[j]->compare(*all[i]));
        }
        const osg::ref_ptr<PhysicalMaterial> copy = new PhysicalMaterial(*all[i]);
        CHECK(copy->compare(*all[i]) == 0);
    }
    const osg::ref_ptr<osg::Material> classic = new osg::Material;
    CHECK(all[0]->compare(*classic) != 0);
}

TEST_CASE("material: textures are shared or copied as the copy asks", "[api][material]")
{
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    material->setBaseColorTexture(texture);
    material->setEmissionTexture(new osg::Texture2D);

    const osg::ref_ptr<osg::Object> shallow = material->clone(osg::CopyOp::SHALLOW_COPY);
    const osg::ref_ptr<osg::Object> deep = material->clone(osg::CopyOp::DEEP_COPY_TEXTURES);
    CHECK(static_cast<PhysicalMaterial&>(*shallow).getBaseColorTexture() == texture);
    const auto& copied = static_cast<PhysicalMaterial&>(*deep);
    CHECK(copied.getBaseColorTexture() != texture);
    CHECK(copied.getBaseColorTexture() != nullptr);
    CHECK(copied.getMetallicRoughnessTexture() == nullptr);
    CHECK(std::string(material->libraryName()) == "osgRayTrace");
    CHECK(std::string(material->className()) == "PhysicalMaterial");

    material->releaseGLObjects();
    material->releaseGLObjects();
    material->resizeGLObjectBuffers(4);
}
