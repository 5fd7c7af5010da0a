// SerializerTest.cpp - our classes survive OSG's three native formats.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/CommaLocale.h"
#include "tests/plugins/Serializers.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/EnvironmentLight>
#include <osgRayTrace/MediumVolume>
#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/RayTracedScene>

#include <osg/MatrixTransform>
#include <osg/Notify>
#include <osgDB/Registry>

#include <cstdlib>
#include <sstream>

using osgRayTrace::AreaLight;
using osgRayTrace::EnvironmentLight;
using osgRayTrace::PhysicalMaterial;
using osgRayTrace::RayTraceDrawable;
using osgRayTrace::RayTracedScene;
using osgRayTrace::RayTraceSettings;
using namespace osgRayTrace::test;

TEST_CASE("serializers: numbers have a point in any locale", "[plugins]")
{
    const auto material = glass();
    material->setRoughness(0.73f);
    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->getSettings()->setExposure(-1.5f);
    scene->getSettings()->setPhotons(123456);
    const osg::ref_ptr<AreaLight> light = new AreaLight;
    light->setRadiance(osg::Vec3(12345.5f, 0.25f, 1e-7f));
    scene->addChild(light);
    const osg::ref_ptr<EnvironmentLight> sky = new EnvironmentLight;
    sky->setScale(osg::Vec3(0.5f, 1.5f, 2.5f));
    scene->addChild(sky);
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const std::string materialText = written(*material, format);
        const std::string sceneText = written(*scene, format);
        const CommaLocale commas;
        CHECK(written(*material, format) == materialText);
        CHECK(written(*scene, format) == sceneText);
        CHECK(roundTrip(*material, format)->getRoughness() == 0.73f);
        const auto copy = roundTrip(*scene, format);
        CHECK(copy->getSettings()->getExposure() == -1.5f);
        CHECK(dynamic_cast<AreaLight&>(*copy->getChild(0)).getRadiance() == light->getRadiance());
        CHECK(dynamic_cast<EnvironmentLight&>(*copy->getChild(1)).getScale() == sky->getScale());
    }
}

TEST_CASE("serializers: the stream of the host keeps its locale", "[plugins]")
{
    const CommaLocale commas;
    std::ostringstream stream;
    REQUIRE(
        readerWriter(kFormats[0]).writeObject(*glass(), stream, optionsOf(kFormats[0])).success());
    stream.str("");
    stream << 0.5;
    CHECK(stream.str() == "0,5");
}

TEST_CASE("serializers: objects at their defaults stay at them", "[plugins]")
{
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    const osg::ref_ptr<AreaLight> light = new AreaLight;
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        CHECK(roundTrip(*material, format)->compare(*material) == 0);
        const auto copy = roundTrip(*light, format);
        CHECK(copy->getCorner() == light->getCorner());
        CHECK(copy->getEdgeU() == light->getEdgeU());
        CHECK(copy->getEdgeV() == light->getEdgeV());
        CHECK(copy->getRadiance() == light->getRadiance());
        CHECK_FALSE(copy->getTwoSided());
    }
}

TEST_CASE("serializers: AreaLight keeps its place in the graph", "[plugins]")
{
    const osg::ref_ptr<osg::MatrixTransform> root =
        new osg::MatrixTransform(osg::Matrix::translate(0.0, 0.0, 5.0));
    const osg::ref_ptr<AreaLight> light =
        new AreaLight(osg::Vec3(1.0f, 2.0f, 3.0f), osg::Vec3(0.5f, 0.0f, 0.0f),
                      osg::Vec3(0.0f, 0.25f, 0.0f), osg::Vec3(7.0f, 8.0f, 9.0f));
    light->setTwoSided(true);
    root->addChild(light);
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const auto copy = roundTrip(*root, format);
        REQUIRE(copy->getNumChildren() == 1);
        auto* copied = dynamic_cast<AreaLight*>(copy->getChild(0));
        REQUIRE(copied);
        CHECK(copied->getCorner() == light->getCorner());
        CHECK(copied->getEdgeU() == light->getEdgeU());
        CHECK(copied->getEdgeV() == light->getEdgeV());
        CHECK(copied->getRadiance() == light->getRadiance());
        CHECK(copied->getTwoSided());
        CHECK(copied->getGeometry()->getBoundingBox().zMax() == 3.0f);
    }
}

TEST_CASE("serializers: RayTraceSettings keep every option against the environment", "[plugins]")
{
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    settings->set("integrator", "path");
    settings->set("light-sampling", "uniform-jitter");
    settings->set("shadows", "off");
    settings->set("terminator-correction", "off");
    settings->set("max-passes", "77");
    settings->set("seed", "4294967295");
    settings->set("light-sizes", "the \"key\"{1}=0.25,100%=1");
    settings->set("materials", "<my> files/caf\xc3\xa9 & more.json");
    settings->set("exposure", "-0.1");
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const std::string text = written(*settings, format);
        setenv("OSGRAYTRACE_LIGHT_SAMPLES", "100", 1);
        const osg::ref_ptr<osg::Object> object = read(text, format);
        unsetenv("OSGRAYTRACE_LIGHT_SAMPLES");
        const auto* copy = dynamic_cast<RayTraceSettings*>(object.get());
        REQUIRE(copy);
        for (const auto& option : RayTraceSettings::options())
        {
            INFO(option.name);
            CHECK(copy->get(option.name) == settings->get(option.name));
        }
    }
}

TEST_CASE("serializers: options of another version are passed over", "[plugins]")
{
    const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
    settings->set("integrator", "path");
    settings->set("max-passes", "77");
    std::string text = written(*settings, kFormats[0]);
    const auto replace = [&text](const std::string& from, const std::string& to)
    {
        const auto position = text.find(from);
        REQUIRE(position != std::string::npos);
        text.replace(position, from.size(), to);
    };
    replace("light-samples", "wave-length");
    replace("integrator path", "integrator bidirectional");

    const osg::ref_ptr<osg::Object> object = read(text, kFormats[0]);
    const auto* copy = dynamic_cast<RayTraceSettings*>(object.get());
    REQUIRE(copy);
    CHECK(copy->getIntegrator() == RayTraceSettings::AUTOMATIC);
    CHECK(copy->getMaxPasses() == 77);
}

TEST_CASE("serializers: options under their former names are read", "[plugins]")
{
    int formerNames = 0;
    for (const auto& option : RayTraceSettings::options())
    {
        if (option.formerName.empty()) continue;
        ++formerNames;
        const osg::ref_ptr<RayTraceSettings> settings = new RayTraceSettings;
        REQUIRE(settings->set(option.name, option.defaultValue == "true" ? "false" : "true"));
        std::string text = written(*settings, kFormats[0]);
        const auto position = text.find(option.name);
        REQUIRE(position != std::string::npos);
        text.replace(position, option.name.size(), option.formerName);

        const osg::ref_ptr<osg::Object> object = read(text, kFormats[0]);
        const auto* copy = dynamic_cast<RayTraceSettings*>(object.get());
        REQUIRE(copy);
        CHECK(copy->get(option.name) == settings->get(option.name));
    }
    CHECK(formerNames > 0);
}

TEST_CASE("serializers: RayTracedScene keeps children, switch and settings", "[plugins]")
{
    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    const osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->setName("floor");
    geode->addDrawable(osg::createTexturedQuadGeometry(osg::Vec3(), osg::Vec3(1.0f, 0.0f, 0.0f),
                                                       osg::Vec3(0.0f, 1.0f, 0.0f)));
    scene->addChild(geode);
    scene->addChild(new AreaLight);
    scene->setEnabled(false);
    scene->getSettings()->setIntegrator(RayTraceSettings::PATH);
    scene->getSettings()->setLightSamples(9);
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const auto copy = roundTrip(*scene, format);
        REQUIRE(copy->getNumChildren() == 2);
        CHECK(copy->getChild(0)->getName() == "floor");
        CHECK(dynamic_cast<AreaLight*>(copy->getChild(1)) != nullptr);
        CHECK_FALSE(copy->getEnabled());
        REQUIRE(copy->getSettings());
        CHECK(copy->getSettings()->getIntegrator() == RayTraceSettings::PATH);
        CHECK(copy->getSettings()->getLightSamples() == 9);
        CHECK(copy->getDrawable() != scene->getDrawable());
        CHECK(copy->getBound().radius() == Approx(scene->getBound().radius()));
    }
}

TEST_CASE("serializers: two scenes that share settings still share them", "[plugins]")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<RayTracedScene> first = new RayTracedScene;
    const osg::ref_ptr<RayTracedScene> second = new RayTracedScene;
    second->setSettings(first->getSettings());
    root->addChild(first);
    root->addChild(second);
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const auto copy = roundTrip(*root, format);
        REQUIRE(copy->getNumChildren() == 2);
        auto* a = dynamic_cast<RayTracedScene*>(copy->getChild(0));
        auto* b = dynamic_cast<RayTracedScene*>(copy->getChild(1));
        REQUIRE((a && b));
        CHECK(a->getSettings() == b->getSettings());
    }
}

TEST_CASE("serializers: EnvironmentLight keeps its images and parameters", "[plugins]")
{
    const osg::ref_ptr<EnvironmentLight> light = new EnvironmentLight;
    light->setImage(texture(7)->getImage());
    light->setCubeMap(new osg::TextureCubeMap);
    for (unsigned int face = 0; face < 6; ++face)
        light->getCubeMap()->setImage(face, texture(static_cast<unsigned char>(face))->getImage());
    light->setRotation(osg::Quat(0.5, 0.25, -0.125, 0.75));
    light->setScale(osg::Vec3(0.5f, 2.0f, 0.0f));
    light->setVisible(false);
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const auto copy = roundTrip(*light, format);
        REQUIRE(copy->getImage());
        CHECK(copy->getImage()->data()[0] == 7);
        REQUIRE(copy->getCubeMap());
        for (unsigned int face = 0; face < 6; ++face)
            CHECK(copy->getCubeMap()->getImage(face)->data()[0] == face);
        // OSG's reader of text adds up digit by digit, so the last digits differ.
        CHECK((copy->getRotation() - light->getRotation()).length() < 1e-12);
        CHECK(copy->getScale() == light->getScale());
        CHECK_FALSE(copy->getVisible());
        const auto plain = roundTrip(*osg::ref_ptr<EnvironmentLight>(new EnvironmentLight), format);
        CHECK(plain->getImage() == nullptr);
        CHECK(plain->getCubeMap() == nullptr);
        CHECK(plain->getVisible());
    }
}

TEST_CASE("serializers: MediumVolume keeps its medium and its radius", "[plugins]")
{
    const osg::ref_ptr<osgRayTrace::Medium> medium = new osgRayTrace::Medium;
    medium->setAbsorption(osg::Vec3(0.5f, 0.25f, 0.0f));
    medium->setScattering(osg::Vec3(2.0f, 3.0f, 4.0f));
    medium->setEmission(osg::Vec3(0.0f, 0.0f, 0.125f));
    medium->setAnisotropy(-0.75f);
    medium->setPriority(-3);
    medium->setPhase(osgRayTrace::Medium::DROPLETS);
    medium->setDropletSize(12.5f);
    const osg::ref_ptr<osgRayTrace::MediumVolume> volume = new osgRayTrace::MediumVolume(medium);
    volume->setRadius(12.5f);
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const auto copy = roundTrip(*volume, format);
        REQUIRE(copy->getMedium());
        CHECK(copy->getMedium()->compare(*medium) == 0);
        CHECK(copy->getRadius() == 12.5f);
        const osg::ref_ptr<osgRayTrace::MediumVolume> empty = new osgRayTrace::MediumVolume;
        const auto plain = roundTrip(*empty, format);
        CHECK(plain->getMedium() == nullptr);
        CHECK(plain->getRadius() == 0.0f);
    }
}

TEST_CASE("serializers: MediumVolume keeps its shape, and files of before are read", "[plugins]")
{
    using osgRayTrace::MediumVolume;
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    const osg::ref_ptr<MediumVolume> even = new MediumVolume(new osgRayTrace::Medium);
    const osg::ref_ptr<MediumVolume> layer = new MediumVolume(even->getMedium());
    layer->setShape(MediumVolume::LAYER);
    layer->setScaleHeight(0.1f);
    const osg::ref_ptr<MediumVolume> box = new MediumVolume;
    box->setShape(MediumVolume::BOX);
    box->setBox({-0.1f, -2.0f, 3.0f, 0.3f, 5.0f, 1e6f});
    for (const osg::ref_ptr<MediumVolume>& volume : {even, layer, box, even})
        group->addChild(volume);
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        // What other versions do not know is not written unless it is used.
        CHECK(written(*even, format).find("Extent") == std::string::npos);
        const auto copy = roundTrip(*group, format);
        REQUIRE(copy->getNumChildren() == 4);
        const auto child = [&](unsigned int i)
        { return dynamic_cast<const MediumVolume*>(copy->getChild(i)); };
        for (const unsigned int i : {0u, 3u})
        {
            REQUIRE(child(i));
            CHECK(child(i)->getShape() == MediumVolume::EVERYWHERE);
        }
        REQUIRE(child(1));
        CHECK(child(1)->getShape() == MediumVolume::LAYER);
        CHECK(child(1)->getScaleHeight() == 0.1f);
        REQUIRE(child(2));
        CHECK(child(2)->getShape() == MediumVolume::BOX);
        CHECK(child(2)->getBox()._min == box->getBox()._min);
        CHECK(child(2)->getBox()._max == box->getBox()._max);
    }
}

TEST_CASE("serializers: RayTraceDrawable keeps its scene and settings", "[plugins]")
{
    const osg::ref_ptr<RayTraceDrawable> drawable = new RayTraceDrawable;
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->setName("the scene");
    scene->addChild(new AreaLight);
    drawable->setScene(scene);
    drawable->getSettings()->setMaxBounces(3);
    for (const Format& format : kFormats)
    {
        INFO(format.extension);
        const auto copy = roundTrip(*drawable, format);
        REQUIRE(copy->getScene());
        CHECK(copy->getScene()->getName() == "the scene");
        CHECK(copy->getScene()->asGroup()->getNumChildren() == 1);
        CHECK(copy->getSettings()->getMaxBounces() == 3);
    }
}

TEST_CASE("serializers: a truncated file is refused or read in part, not fatal", "[plugins]")
{
    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->addChild(new AreaLight);
    scene->getOrCreateStateSet()->setAttribute(new PhysicalMaterial);
    scene->getSettings()->setLightSamples(9);
    const osg::NotifySeverity level = osg::getNotifyLevel();
    osg::setNotifyLevel(osg::ALWAYS); // OSG's readers log a lot
    for (const Format& format : kFormats)
    {
        const std::string text = written(*scene, format);
        // The file is not cut at every length. If a binary file ends just before the count of a
        // list of OSG's own (its state set, at byte 128), OSG 3.6.5 loops for hours over a count
        // that it has not read. An odd step misses this length.
        const size_t step = text.size() / 113 | 1;
        for (size_t length = 0; length < text.size(); length += step)
        {
            if (length >= 124 && length <= 132) continue; // whatever the step is
            INFO(format.extension << ", the first " << length << " of " << text.size() << " bytes");
            const osg::ref_ptr<osg::Object> object = read(text.substr(0, length), format);
            const auto* part = dynamic_cast<RayTracedScene*>(object.get());
            if (part) CHECK(part->getSettings() != nullptr);
        }
    }
    osg::setNotifyLevel(level);
}
