// ShippedRulesTest.cpp - the material files of data/materials, with states as the programs make
// them that they are for. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/ShaderScenes.h"

#include <filesystem>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

const std::filesystem::path kFolder =
    std::filesystem::path(OSGRAYTRACE_TEST_SOURCE) / "data" / "materials";

/// Returns the conversion of the part by a shipped file; nothing that the file asks for is missing.
ConversionResult convert(const ShadedPart& shaded, const std::string& file)
{
    const MaterialLibraryResult read = readMaterialLibrary((kFolder / file).string());
    REQUIRE(read.error == "");
    ConversionInput input = inputFor(shaded.model);
    input.materials = read.library;
    input.rasterizesRest = true;
    SceneConverter converter;
    ConversionResult result = converter.convert(input);
    REQUIRE(countOf(result, "traced.by-rule") == 1);
    CHECK(countOf(result, "warned.material-value") == 0);
    return result;
}

std::string ruleOf(const ConversionResult& result)
{
    return result.paths.at("traced.by-rule").front();
}

std::vector<int> roughAndMetal(const ConversionResult& result)
{
    const std::vector<int> rgba = texelOf(result, soleMaterial(result).metallicRoughnessTexture);
    return {rgba[1], rgba[2]};
}

} // namespace

TEST_CASE("shipped material files: all can be read", "[bridge]")
{
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder))
    {
        INFO(entry.path());
        CHECK(readMaterialLibrary(entry.path().string()).error == "");
        ++files;
    }
    CHECK(files == 5);
}

TEST_CASE("shipped material files: OpenMW", "[bridge]")
{
    ShadedPart shaded;
    shaded.bind(0, texel({10, 20, 30, 200}), "diffuseMap");
    const ConversionResult plain = convert(shaded, "openmw.json");
    CHECK(texelOf(plain, soleMaterial(plain).baseColorTexture) ==
          std::vector<int>{10, 20, 30, 200});
    CHECK(soleMaterial(plain).emission == Vec3(0.0f));
    CHECK(soleMaterial(plain).alphaTest == AlphaTest::Always);
    CHECK(soleMaterial(plain).roughness == 1.0f);

    shaded.bind(1, texel({40, 50, 60, 255}), "emissiveMap");
    shaded.bind(2, texel({0, 0, 0, 55}), "specularMap");
    shaded.state().addUniform(new osg::Uniform("alphaRef", 0.5f));
    const ConversionResult full = convert(shaded, "openmw.json");
    const Material& material = soleMaterial(full);
    CHECK(texelOf(full, material.emissionTexture)[0] == 40);
    CHECK(material.emission == Vec3(1.0f));
    CHECK(roughAndMetal(full)[0] == 200);
    CHECK(material.metallic == 0.0f);
    CHECK(material.alphaReference == 0.5f);
}

TEST_CASE("shipped material files: OpenCOVER", "[bridge]")
{
    ShadedPart shaded;
    shaded.program->setName("RevitDiffuseBump");
    shaded.bind(0, texel({10, 20, 30, 255}));
    CHECK(ruleOf(convert(shaded, "opencover.json")) == "'OpenCOVER bump map', for model/part");

    shaded.bind(2, texel({11, 20, 30, 255}), "diffuseMap");
    const ConversionResult mapped = convert(shaded, "opencover.json");
    CHECK(ruleOf(mapped) == "'OpenCOVER diffuse map', for model/part");
    CHECK(texelOf(mapped, soleMaterial(mapped).baseColorTexture)[0] == 11);
    CHECK(soleMaterial(mapped).roughness == 0.6f);

    shaded.program->setName("treeAlpha");
    const ConversionResult tree = convert(shaded, "opencover.json");
    CHECK(texelOf(tree, soleMaterial(tree).baseColorTexture)[0] == 10);
    CHECK(soleMaterial(tree).alphaReference == 0.5f);
}

TEST_CASE("shipped material files: osgVerse", "[bridge]")
{
    ShadedPart shaded;
    const char* const names[] = {"DiffuseMap", "NormalMap",   "SpecularMap",  "ShininessMap",
                                 "AmbientMap", "EmissiveMap", "ReflectionMap"};
    for (unsigned int unit = 0; unit < 7; ++unit)
    {
        const auto value = static_cast<unsigned char>(10 * unit + 10);
        shaded.bind(unit, texel({value, 101, 102, 255}), names[unit]);
    }
    const ConversionResult result = convert(shaded, "osgverse.json");
    const Material& material = soleMaterial(result);
    CHECK(texelOf(result, material.baseColorTexture)[0] == 10);
    CHECK(result.scene->textures.at(material.baseColorTexture)->decodeSrgb);
    CHECK(texelOf(result, material.metallicRoughnessTexture)[0] == 40); // O, R, M as it is
    CHECK(roughAndMetal(result) == std::vector<int>{101, 102});
    CHECK(material.metallic == 1.0f);
    CHECK(texelOf(result, material.emissionTexture)[0] == 60);

    // The pipeline sets the samplers for all, whatever is bound.
    shaded.state().removeTextureAttribute(3, osg::StateAttribute::TEXTURE);
    shaded.state().removeTextureAttribute(5, osg::StateAttribute::TEXTURE);
    const ConversionResult plain = convert(shaded, "osgverse.json");
    CHECK(soleMaterial(plain).metallic == 0.0f);
    CHECK(soleMaterial(plain).emission == Vec3(0.0f));
}

TEST_CASE("shipped material files: osgEarth", "[bridge]")
{
    ShadedPart shaded;
    shaded.state().setAttribute(new VirtualProgram);
    shaded.bind(0, texel({10, 20, 30, 255}), "oe_sg_sampler0");
    const ConversionResult model = convert(shaded, "osgearth.json");
    CHECK(ruleOf(model) == "'osgEarth model', for model/part");
    CHECK(texelOf(model, soleMaterial(model).baseColorTexture)[0] == 10);

    shaded.bind(3, texel({11, 20, 30, 255}), "oe_albedo_tex");
    shaded.bind(5, texel({1, 102, 3, 104}), "oe_pbr_tex");
    const ConversionResult pbr = convert(shaded, "osgearth.json");
    CHECK(texelOf(pbr, soleMaterial(pbr).baseColorTexture)[0] == 11);
    CHECK(roughAndMetal(pbr) == std::vector<int>{102, 104});
    CHECK(soleMaterial(pbr).metallic == 1.0f);
}

TEST_CASE("shipped material files: names of physical materials", "[bridge]")
{
    {
        ShadedPart gltf; // as the glTF reader proposed to OSG in pull request 519 makes it
        gltf.bind(1, texel({10, 20, 30, 255}));
        gltf.bind(7, texel({1, 102, 103, 255}));
        gltf.state().setUserValue("sDiffuse", std::string("1"));
        gltf.state().setUserValue("sMetallic", std::string("7"));
        gltf.state().setUserValue("DiffuseColor", osg::Vec4(0.5f, 0.25f, 1.0f, 1.0f));
        gltf.state().setUserValue("EmissiveFactor", osg::Vec3(1.0f, 2.0f, 3.0f));
        const ConversionResult result = convert(gltf, "pbr-names.json");
        CHECK(ruleOf(result) == "'glTF user values', for model/part");
        CHECK(soleMaterial(result).baseColor == Vec3(0.5f, 0.25f, 1.0f));
        CHECK(texelOf(result, soleMaterial(result).baseColorTexture)[0] == 10);
        CHECK(roughAndMetal(result) == std::vector<int>{102, 103});
        CHECK(soleMaterial(result).emission == Vec3(1.0f, 2.0f, 3.0f));
    }
    {
        ShadedPart samplers;
        samplers.bind(0, texel({10, 20, 30, 255}), "u_BaseColorTexture");
        samplers.bind(1, texel({1, 102, 103, 255}), "u_MetallicRoughnessTexture");
        samplers.bind(2, texel({40, 0, 0, 255}), "u_EmissiveTexture");
        const ConversionResult result = convert(samplers, "pbr-names.json");
        CHECK(texelOf(result, soleMaterial(result).baseColorTexture)[0] == 10);
        CHECK(roughAndMetal(result) == std::vector<int>{102, 103});
        CHECK(texelOf(result, soleMaterial(result).emissionTexture)[0] == 40);
    }
    {
        ShadedPart maps;
        maps.bind(0, texel({10, 20, 30, 255}), "albedoMap");
        maps.bind(2, texel({102, 0, 0, 255}), "metallicMap");
        maps.bind(3, texel({101, 0, 0, 255}), "roughnessMap");
        const ConversionResult result = convert(maps, "pbr-names.json");
        CHECK(texelOf(result, soleMaterial(result).baseColorTexture)[0] == 10);
        CHECK(roughAndMetal(result) == std::vector<int>{101, 102});
        CHECK(soleMaterial(result).metallic == 1.0f);
    }
    {
        ShadedPart numbers;
        numbers.state().addUniform(new osg::Uniform("albedo", osg::Vec3(0.5f, 0.0f, 0.0f)));
        numbers.state().addUniform(new osg::Uniform("metallic", 0.75f));
        numbers.state().addUniform(new osg::Uniform("roughness", 0.25f));
        const ConversionResult result = convert(numbers, "pbr-names.json");
        CHECK(soleMaterial(result).baseColor == Vec3(0.5f, 0.0f, 0.0f));
        CHECK(soleMaterial(result).metallic == 0.75f);
        CHECK(soleMaterial(result).roughness == 0.25f);
    }
    {
        ShadedPart files;
        files.bind(0, texel({10, 20, 30, 255}, "textures/wall_albedo.png"));
        files.bind(2, texel({101, 0, 0, 255}, "textures/wall_rough.png"));
        files.bind(3, texel({102, 0, 0, 255}, "textures/wall_metal.png"));
        const ConversionResult result = convert(files, "pbr-names.json");
        CHECK(texelOf(result, soleMaterial(result).baseColorTexture)[0] == 10);
        CHECK(roughAndMetal(result) == std::vector<int>{101, 102});
        files.bind(4, texel({0, 103, 104, 255}, "textures/wall_orm.png"));
        CHECK(roughAndMetal(convert(files, "pbr-names.json")) == std::vector<int>{103, 104});
    }
}
