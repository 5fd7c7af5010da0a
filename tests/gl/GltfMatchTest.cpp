// GltfMatchTest.cpp - unlit glTF models, and those with vertex colours, look traced as OpenGL draws
// them. Layer: tests.
// SPDX-License-Identifier: MIT
#include "StateScenes.h"
#include "tests/plugins/GltfFiles.h"

#include <osg/LightSource>

#include <cstdlib>
#include <fstream>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// Returns a model of one unlit square of 6 x 6 with texture coordinates from 0 to 1 and a
/// material.
Json unlitSquareModel()
{
    Json model = triangleModel();
    attributesOf(model)["POSITION"] =
        addAccessor<float>(model, {-3, -3, 0, 3, -3, 0, -3, 3, 0, 3, 3, 0}, kFloat, "VEC3", 4);
    attributesOf(model)["TEXCOORD_0"] =
        addAccessor<float>(model, {0, 1, 1, 1, 0, 0, 1, 0}, kFloat, "VEC2", 4);
    Json& primitive = model["meshes"][0]["primitives"][0];
    primitive["indices"] =
        addAccessor<std::uint8_t>(model, {0, 1, 2, 2, 1, 3}, kUnsignedByte, "SCALAR", 6);
    primitive["material"] = 0;
    model["extensionsUsed"] = {"KHR_materials_unlit", "KHR_texture_transform"};
    model["materials"] = Json::parse(R"([{ "pbrMetallicRoughness": { "baseColorFactor":
        [0.8, 0.3, 0.05, 1] }, "extensions": { "KHR_materials_unlit": {} } }])");
    return model;
}

void addTexture(Json& model)
{
    const osg::ref_ptr<osg::Image> image = patchwork(16);
    std::ostringstream stream(std::ios::binary);
    osgDB::Registry::instance()->getReaderWriterForExtension("png")->writeImage(*image, stream);
    model["images"] = {{{"uri", "data:image/png;base64," + base64(stream.str())}}};
    model["textures"] = Json::parse(R"([{ "source": 0, "sampler": 0 }])");
    model["samplers"] = Json::parse(
        R"([{ "wrapS": 33648, "wrapT": 10497, "magFilter": 9729, "minFilter": 9729 }])");
    model["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = Json::parse(
        R"({ "index": 0, "extensions": { "KHR_texture_transform":
             { "scale": [1.5, 2], "offset": [0.1, 0.2], "rotation": 0.4 } } })");
}

osg::ref_ptr<osg::Node> readModel(const Json& model)
{
    return sceneOf(model, "noRotation");
}

} // namespace

TEST_CASE("match: unlit glTF surfaces, with textures and with colours of vertices",
          "[gl][coverage]")
{
    CHECK(matches("gltf-unlit", readModel(unlitSquareModel())));

    Json colors = unlitSquareModel();
    attributesOf(colors)["COLOR_0"] = addAccessor<std::uint8_t>(
        colors, {255, 0, 0, 255, 0, 255, 0, 255, 30, 60, 255, 255, 250, 240, 20, 255},
        kUnsignedByte, "VEC4", 4);
    colors["accessors"].back()["normalized"] = true;
    CHECK(matches("gltf-unlit-vertex-colors", readModel(colors)));
    colors["materials"][0]["alphaMode"] = "BLEND";
    colors["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.6;
    CHECK(matches("gltf-unlit-blend", readModel(colors)));

    Json textured = unlitSquareModel();
    addTexture(textured);
    CHECK(matches("gltf-unlit-texture", readModel(textured)));
    Json third = textured; // the other sets would look up another part of the texture
    for (const char* set : {"TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"})
        attributesOf(third)[set] = attributesOf(textured)["TEXCOORD_0"];
    attributesOf(third)["TEXCOORD_0"] = attributesOf(third)["TEXCOORD_1"] =
        addAccessor<float>(third, {0, 0, 0.1f, 0, 0, 0.1f, 0.1f, 0.1f}, kFloat, "VEC2", 4);
    third["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 3;
    const osg::ref_ptr<osg::Node> scene = readModel(third);
    CHECK(geometryOf(*scene).getTexCoordArray(0) == geometryOf(*scene).getTexCoordArray(3));
    CHECK(matches("gltf-unlit-texture-of-set-3", scene));
    textured["materials"][0]["alphaMode"] = "MASK";
    CHECK(matches("gltf-unlit-mask", readModel(textured)));
}

TEST_CASE("match: lights beyond OpenGL's give it no errors", "[gl]")
{
    Json model = unlitSquareModel();
    model["materials"][0].erase("extensions");
    model["scenes"][0]["nodes"] = {0};
    model["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::parse(R"([{ "type": "point", "intensity": 3 }])");
    for (int i = 0; i < 12; ++i)
    {
        model["scenes"][0]["nodes"].push_back(model["nodes"].size());
        model["nodes"].push_back({{"translation", {0.5 * i - 3, 1, 2}},
                                  {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    }
    const osg::ref_ptr<osg::Node> scene = readModel(model);
    REQUIRE(findAll<osg::LightSource>(*scene).size() == 12);
    const Listening listening; // OSG asks for errors at the end of each frame, and tells them
    TestViewer view(32, 32, scene.get());
    view.frames(2);
    INFO(listening.text());
    CHECK(listening.text().find("OpenGL error") == std::string::npos);
    CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("match: sample models, were their materials unlit", "[gl][osg-data]")
{
    const char* models = std::getenv("OSGRAYTRACE_GLTF_MODELS");
    for (const char* name : {"BoxVertexColors", "BoxTextured", "TextureCoordinateTest"})
    {
        const std::string folder = std::string(models ? models : "") + "/" + name + "/glTF/";
        std::ifstream text(folder + name + ".gltf");
        if (!text)
        {
            WARN("OSGRAYTRACE_GLTF_MODELS leads to no " << name << ": skipped");
            continue;
        }
        Json model = Json::parse(text);
        if (!model.contains("materials")) model["materials"] = {Json::object()};
        for (Json& material : model["materials"])
            material["extensions"]["KHR_materials_unlit"] = Json::object();
        for (Json& mesh : model["meshes"])
            for (Json& primitive : mesh["primitives"])
                if (!primitive.contains("material")) primitive["material"] = 0;
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
        options->getDatabasePathList().push_back(folder);
        std::istringstream stream(model.dump());
        const osg::ref_ptr<osg::Node> scene = gltfPlugin().readNode(stream, options).getNode();
        REQUIRE(scene);
        MatchSetup setup;
        setup.homeView = true;
        CHECK(matches(std::string("gltf-") + name, scene.get(), setup));
    }
}
