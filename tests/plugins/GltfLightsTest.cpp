// GltfLightsTest.cpp - a file may have more lights than OpenGL. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfPictures.h"
#include "tests/Catch.h"

#include <osgRayTrace/TracedLight>

#include <osg/LightSource>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kLights = 12;
constexpr int kShown = 7; ///< by OpenGL, beside the viewer's

/// Returns a square with these of the twelve lights, each from another side.
Json modelOf(int first, int end)
{
    Json model = triangleModel();
    Json& attributes = attributesOf(model);
    attributes["POSITION"] =
        addAccessor<float>(model, {-2, -2, 0, 2, -2, 0, -2, 2, 0, 2, 2, 0}, kFloat, "VEC3", 4);
    model["meshes"][0]["primitives"][0]["mode"] = 5;
    model["materials"] = Json::parse(R"([{ "pbrMetallicRoughness": { "metallicFactor": 0 } }])");
    model["meshes"][0]["primitives"][0]["material"] = 0;
    model["scenes"][0]["nodes"] = {0};
    for (int i = first; i < end; ++i)
    {
        const double angle = 0.1 * i;
        Json light = {{"type", i % 2 ? "point" : "directional"}, {"intensity", 1 + i % 3}};
        model["extensions"]["KHR_lights_punctual"]["lights"].push_back(light);
        model["scenes"][0]["nodes"].push_back(model["nodes"].size());
        model["nodes"].push_back(
            {{"translation", {0.2 * i - 1, 0.5, 1.5}},
             {"rotation", {0, std::sin(angle / 2), 0, std::cos(angle / 2)}},
             {"extensions", {{"KHR_lights_punctual", {{"light", i - first}}}}}});
    }
    return model;
}

osg::ref_ptr<osg::Node> throughFile(const osg::Node& scene)
{
    auto& format = *osgDB::Registry::instance()->getReaderWriterForExtension("osgb");
    std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
    if (!format.writeNode(scene, stream).success()) throw std::runtime_error("not written");
    return format.readNode(stream).getNode();
}

} // namespace

TEST_CASE("gltf: lights beyond OpenGL's are for rays alone, and one line says so", "[gltf]")
{
    const Listening listening;
    const auto scene = sceneOf(modelOf(0, kLights));
    const std::size_t line = listening.text().find("has 12 lights; OpenGL shows the first 7");
    CHECK(line != std::string::npos);
    CHECK(listening.text().find("lights", line + 20) == std::string::npos);
    const auto sources = findAll<osg::LightSource>(*scene);
    REQUIRE(sources.size() == kLights);
    for (int i = 0; i < kLights; ++i)
    {
        INFO(i);
        const osg::Light* light = sources[static_cast<std::size_t>(i)]->getLight();
        CHECK(light->getLightNum() == i + 1);
        CHECK((dynamic_cast<const TracedLight*>(light) != nullptr) == (i >= kShown));
        const unsigned int mode = scene->getStateSet()->getMode(GL_LIGHT0 + i + 1);
        CHECK(mode == (i < kShown ? osg::StateAttribute::ON : osg::StateAttribute::INHERIT));
        const osg::StateSet* own = sources[static_cast<std::size_t>(i)]->getStateSet();
        CHECK((!own || own->getModeList().empty()));
    }
    const Listening few;
    sceneOf(modelOf(0, kShown));
    CHECK(few.text().empty());
}

TEST_CASE("gltf: all lights of a file are in its traced picture, from an .osgb file as well",
          "[gltf]")
{
    const auto scene = sceneOf(modelOf(0, kLights), "noRotation");
    for (const auto integrator : {RayTraceSettings::WHITTED, RayTraceSettings::PATH})
    {
        const osg::ref_ptr<osg::Image> all = pictureOf(*scene, integrator);
        const osg::ref_ptr<osg::Image> sum = new osg::Image(*all, osg::CopyOp::DEEP_COPY_ALL);
        std::fill_n(reinterpret_cast<float*>(sum->data()), sum->getTotalSizeInBytes() / 4, 0.0f);
        for (int i = 0; i < kLights; ++i)
        {
            const auto one =
                pictureOf(*sceneOf(modelOf(i, i + 1), "noRotation"), RayTraceSettings::WHITTED);
            for (unsigned int k = 0; k < sum->getTotalSizeInBytes() / 4; ++k)
                reinterpret_cast<float*>(sum->data())[k] +=
                    reinterpret_cast<const float*>(one->data())[k];
        }
        const Difference difference = differenceOf(*sum, *all);
        CHECK(difference.brightest > 1.0f);
        // Paths add what the square sends itself: nothing.
        CHECK(difference.largest < 1e-3f * difference.brightest);
        const osg::ref_ptr<osg::Node> copy = throughFile(*scene);
        REQUIRE(copy);
        CHECK(differenceOf(*all, *pictureOf(*copy, integrator)).largest == 0.0f);
    }
}
