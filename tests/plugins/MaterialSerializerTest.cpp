// MaterialSerializerTest.cpp - PhysicalMaterial survives OSG's three native formats. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/plugins/Serializers.h"

#include <osg/Geode>
#include <osg/Geometry>

using osgRayTrace::PhysicalMaterial;
using namespace osgRayTrace::test;

TEST_CASE("serializers: PhysicalMaterial keeps every parameter", "[plugins]")
{
    const auto material = glass();
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const auto copy = roundTrip(*material, format);
        CHECK(copy->getName() == "glass");
        CHECK(copy->getBaseColor() == material->getBaseColor());
        CHECK(copy->getMetallic() == material->getMetallic());
        CHECK(copy->getRoughness() == material->getRoughness());
        CHECK(copy->getTransmission() == material->getTransmission());
        CHECK(copy->getIor() == material->getIor());
        CHECK(copy->getEmission() == material->getEmission());
        CHECK(valueOf(copy->getBaseColorTexture()) == 1);
        CHECK(valueOf(copy->getMetallicRoughnessTexture()) == 2);
        CHECK(valueOf(copy->getTransmissionTexture()) == 3);
        CHECK(valueOf(copy->getEmissionTexture()) == 4);
    }
}

TEST_CASE("serializers: PhysicalMaterial keeps what few surfaces have", "[plugins]")
{
    const auto material = glass();
    const std::string plain = written(*material, kFormats[0]);
    CHECK(plain.find("Details") == std::string::npos); // as files of before, which are read above
    material->setAlpha(0.25f);
    material->setVertexColors(true);
    material->setNormalScale(-0.1f);
    material->setThinWalled(true);
    material->setAttenuationColor(osg::Vec3(0.1f, 0.2f, 0.3f));
    material->setAttenuationDistance(1e-20f);
    material->setInterior(new osgRayTrace::Medium);
    material->getInterior()->setAbsorption(osg::Vec3(0.1f, 1e-6f, 0.0f));
    material->getInterior()->setScattering(osg::Vec3(7.0f, 0.0f, 1e3f));
    material->getInterior()->setEmission(osg::Vec3(0.0f, 0.3f, 0.0f));
    material->getInterior()->setAnisotropy(0.9f);
    material->getInterior()->setPriority(-2);
    material->setSpecular(0.7f);
    material->setSpecularColor(osg::Vec3(1e6f, 0.5f, 0.0f));
    material->setClearcoat(0.9f);
    material->setClearcoatRoughness(0.8f);
    material->setClearcoatNormalScale(0.4f);
    material->setSheenColor(osg::Vec3(0.6f, 0.0f, 1.0f));
    material->setSheenRoughness(0.3f);
    material->setAnisotropy(0.1f);
    material->setAnisotropyRotation(-3.3f);
    material->setDiffuseTransmission(0.2f);
    material->setDiffuseTransmissionColor(osg::Vec3(0.7f, 0.0f, 1.0f));
    material->setSubsurface(0.3f);
    material->setSubsurfaceRadius(osg::Vec3(1.1f, 1e-4f, 0.0f));
    material->setIridescence(0.4f);
    material->setIridescenceIor(1.1f);
    material->setIridescenceThicknessMinimum(0.0f);
    material->setIridescenceThicknessMaximum(1234.5f);
    for (int i = 0; i < PhysicalMaterial::NUMBER_OF_TEXTURES; ++i)
    {
        const auto use = static_cast<PhysicalMaterial::TextureUse>(i);
        material->setTexture(use, texture(static_cast<unsigned char>(10 + i)));
        PhysicalMaterial::TexturePlace place;
        place.unit = i % 8;
        place.offset.set(0.1f * i, -0.2f);
        place.rotation = 0.3f;
        place.scale.set(2.0f, 1.0f / 3.0f);
        material->setTexturePlace(use, place);
    }
    const osg::ref_ptr<osg::Geode> scene = new osg::Geode; // with something behind the material
    scene->getOrCreateStateSet()->setAttribute(material);
    scene->addDrawable(new osg::Geometry);
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const auto copied = roundTrip(*scene, format);
        REQUIRE(copied->getNumDrawables() == 1);
        const auto* copy = dynamic_cast<const PhysicalMaterial*>(
            copied->getStateSet()->getAttribute(PhysicalMaterial::ATTRIBUTE_TYPE));
        REQUIRE(copy);
        for (int i = 0; i < PhysicalMaterial::NUMBER_OF_TEXTURES; ++i)
        {
            const auto use = static_cast<PhysicalMaterial::TextureUse>(i);
            CHECK(valueOf(copy->getTexture(use)) == 10 + i);
            CHECK(copy->getTexturePlace(use) == material->getTexturePlace(use));
        }
        const osg::ref_ptr<PhysicalMaterial> own = new PhysicalMaterial(*copy);
        for (int i = 0; i < PhysicalMaterial::NUMBER_OF_TEXTURES; ++i)
            own->setTexture(static_cast<PhysicalMaterial::TextureUse>(i),
                            material->getTexture(static_cast<PhysicalMaterial::TextureUse>(i)));
        CHECK(own->compare(*material) == 0);
    }
}

TEST_CASE("serializers: a state set keeps the material with its override", "[plugins]")
{
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->getOrCreateStateSet()->setAttribute(glass(), osg::StateAttribute::OVERRIDE);
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const auto copy = roundTrip(*group, format);
        REQUIRE(copy->getStateSet());
        const auto* pair = copy->getStateSet()->getAttributePair(PhysicalMaterial::ATTRIBUTE_TYPE);
        REQUIRE(pair);
        CHECK((pair->second & osg::StateAttribute::OVERRIDE) != 0);
        CHECK(static_cast<PhysicalMaterial&>(*pair->first).getIor() == 2.25f);
    }
}
