// ShaderRulesTest.cpp - rules of a material file for state that programs read.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Messages.h"
#include "tests/bridge/ShaderScenes.h"

#include <osg/Material>
#include <osg/Texture2DArray>

#include <limits>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;
using Catch::Matchers::Contains;
using osgRayTrace::engine::test::Messages;

namespace
{

std::string errorOf(const std::string& text)
{
    const MaterialLibraryResult result = parseMaterialLibrary(text, "m.json");
    CHECK((result.library == nullptr) == !result.error.empty());
    return result.error;
}

/// Returns the error of a rule "glass" whose last member stands in line 3.
std::string memberError(const std::string& member)
{
    return errorOf("{ \"shaders\": [\n { \"name\": \"glass\", \"if\": { \"unit\": 0 },\n" + member +
                   " } ] }");
}

bool fits(const ShadedPart& shaded, const std::string& conditions)
{
    return countOf(shaded.convert("{ \"if\": { " + conditions + " } }"), "traced.by-rule") == 1;
}

} // namespace

TEST_CASE("shader rules: what is wrong is named, with its line", "[bridge]")
{
    CHECK(errorOf(R"({ "shaders": [] })") == "");
    CHECK_THAT(errorOf("{\n\"shaders\": {} }"),
               Contains("m.json:2: an array of rules was expected, not an object"));
    CHECK_THAT(errorOf("{\n\"shaders\": 3 }"),
               Contains("m.json:2: an array of rules was expected, not a number"));
    CHECK_THAT(errorOf("{ \"shaders\": [],\n\"shaders\": [] }"),
               Contains("m.json:2: 'shaders' is there twice"));
    CHECK_THAT(errorOf("{ \"shaders\": [\n1 ] }"), Contains("an object for a rule was expected"));
    CHECK_THAT(errorOf("{ \"shaders\": [ {\"if\": {\"unit\": 1}},\n{ \"ior\": 1 } ] }"),
               Contains("m.json:2: shaders: 'rule 2': the rule has no condition in an 'if'"));
    CHECK_THAT(errorOf("{ \"shaders\": [ [[[[[[1]]]]]] ] }"), Contains("lies too deep"));

    const auto beginning = Catch::Matchers::StartsWith("m.json:3: shaders: 'glass': ");
    const auto wrong = [&](const std::string& member, const std::string& message)
    { CHECK_THAT(memberError(member), beginning && Contains(message)); };
    wrong(R"("gloss": 1)", "'gloss': is no member of a rule; there are name, if, attributes, base");
    wrong(R"("if": { "unit": 1 })", "'if': is there twice");
    wrong(R"("ior": 9)", "'ior': a number is out of range");
    wrong(R"("interiorPriority": 1.5)", "'interiorPriority': a whole number was expected");
    wrong(R"("ior": "high")", "'ior': a number or an object was expected, not a string");
    wrong(R"("ior": [1])", "'ior': a number or an object was expected, not an array");
    wrong(R"("baseColor": [1, 1])", "'baseColor': an array of three numbers was expected");
    wrong(R"("baseColor": [1, 1, 2])", "'baseColor': a number is out of range");
    wrong(R"("ior": {})", "'ior': the object names no uniform or user value");
    wrong(R"("ior": { "uniform": 1 })", "'uniform': a string was expected, not a number");
    wrong(R"("ior": { "uniform": "" })", "'uniform': the string is empty");
    wrong(R"("ior": { "uniform": "a", "user": "b" })", "'user': is a second source");
    wrong(R"("ior": { "sampler": "a" })", "'sampler': does not belong here");
    wrong(R"("ior": { "uniform": "a", "srgb": true })", "'srgb': does not belong here");
    wrong(R"("ior": { "uniform": "a", "scale": true })", "'scale': a number was expected");
    wrong(R"("baseColorTexture": 0)", "'baseColorTexture': an object was expected");
    wrong(R"("baseColorTexture": {})", "the object names no texture");
    wrong(R"("baseColorTexture": { "unit": -1 })", "'unit': the number is none of 0, 1, ... 1023");
    wrong(R"("baseColorTexture": { "unit": 0.5 })", "'unit': the number is none of");
    wrong(R"("baseColorTexture": { "unit": 0, "channels": "r" })", "'channels': does not belong");
    wrong(R"("roughnessTexture": { "unit": 0, "srgb": true })", "'srgb': does not belong here");
    wrong(R"("roughnessTexture": { "unit": 0, "channels": "x" })", "'x' is not one letter of rgba");
    wrong(R"("metallicRoughnessTexture": { "unit": 0, "channels": "r" })", "is not two letters");
    wrong(R"("attributes": { "color": 3 })", "'color': is no attribute");
    wrong(R"("attributes": { "normal": 256 })", "none of 0, 1, ... 255");
    wrong(R"("alphaReference": 2)", "'alphaReference': a number is out of range");
    CHECK_THAT(memberError(R"("roughnessTexture": { "unit": 0 },
                           "metallicRoughnessTexture": { "unit": 0 })"),
               Contains("metallicRoughnessTexture excludes roughnessTexture"));
    CHECK_THAT(errorOf("{ \"shaders\": [ { \"if\": {\n\"colour\": \"a\" } } ] }"),
               Contains("m.json:2: shaders: 'rule 1': 'colour': is no condition; there are"));

    std::string many = "{ \"shaders\": [";
    for (std::size_t i = 0; i < kMostPatterns; ++i)
        many += "{ \"if\": { \"unit\": 0 } },";
    CHECK(errorOf(many.substr(0, many.size() - 1) + "] }") == "");
    CHECK_THAT(errorOf(many + "{ \"if\": { \"unit\": 0 } } ] }"), Contains("more than 1024 rules"));
}

TEST_CASE("shader rules: conditions, which all must hold", "[bridge]")
{
    ShadedPart shaded;
    shaded.bind(3, texel({1, 2, 3, 4}, "pictures/wall_rough.png"), "glossMap");
    shaded.state().addUniform(new osg::Uniform("uRoughness", 0.25f));
    shaded.state().setUserValue("sDiffuse", std::string("1"));
    shaded.model->setUserValue("kind", 3);
    CHECK(fits(shaded, R"("program": "Bump")"));
    CHECK(fits(shaded, R"("program": "bump.frag")"));
    CHECK(fits(shaded, R"("program": "shaders/*")"));
    CHECK_FALSE(fits(shaded, R"("program": "Bum")"));
    CHECK(fits(shaded, R"("sampler": "gloss*")"));
    CHECK_FALSE(fits(shaded, R"("sampler": "uRoughness")")); // it is no sampler
    CHECK(fits(shaded, R"("uniform": "uRoughness")"));
    CHECK_FALSE(fits(shaded, R"("uniform": "roughness")"));
    CHECK(fits(shaded, R"("unit": 3)"));
    CHECK_FALSE(fits(shaded, R"("unit": 0)"));
    CHECK(fits(shaded, R"("user": "sDiffuse")")); // of a state set
    CHECK(fits(shaded, R"("user": "ki*")"));      // of a node
    CHECK_FALSE(fits(shaded, R"("user": "size")"));
    CHECK(fits(shaded, R"("texture": "*_rough.png")"));
    CHECK_FALSE(fits(shaded, R"("texture": "*_n.png")"));
    CHECK(fits(shaded, R"("uniform": ["uRoughness", "glossMap"], "program": "*")"));
    CHECK_FALSE(fits(shaded, R"("uniform": ["uRoughness", "uMetallic"])"));
    CHECK_FALSE(fits(shaded, R"("unit": 3, "program": "Glass")"));

    shaded.state().setAttribute(new VirtualProgram);
    CHECK(fits(shaded, R"("program": "VirtualProgram")"));
    shaded.state().setAttribute(new osg::Program); // an empty one draws nothing
    CHECK_FALSE(fits(shaded, R"("program": "*")"));
}

TEST_CASE("shader rules: the first one that fits wins", "[bridge]")
{
    ShadedPart shaded;
    shaded.state().addUniform(new osg::Uniform("glass", true));
    const std::string rules = R"(
        { "if": { "program": "Wood" }, "roughness": 0.125 },
        { "name": "panes", "if": { "uniform": "glass" }, "roughness": 0.25 },
        { "if": { "program": "Bump" }, "roughness": 0.5 })";
    const ConversionResult result = shaded.convert(rules);
    CHECK(soleMaterial(result).roughness == 0.25f);
    CHECK(result.paths.at("traced.by-rule") == std::vector<std::string>{"'panes', for model/part"});
    shaded.state().removeUniform("glass");
    CHECK(soleMaterial(shaded.convert(rules)).roughness == 0.5f);

    // Names win over conventions.
    SceneConverter converter;
    const ConversionInput input = shaded.input("{ \"shaders\": [ " + rules +
                                               R"( ], "nodes": { "part": { "roughness": 0 } } })");
    CHECK(soleMaterial(converter.convert(input)).roughness == 0.0f);
}

TEST_CASE("shader rules: numbers of constants, uniforms and user values", "[bridge]")
{
    ShadedPart shaded;
    osg::StateSet& state = shaded.state();
    state.addUniform(new osg::Uniform("gloss", 0.25f));
    state.addUniform(new osg::Uniform("steps", 1));
    state.addUniform(new osg::Uniform("tint", osg::Vec4(0.5f, 1.0f, 0.0f, 0.125f)));
    state.addUniform(new osg::Uniform("bright", 1e9f));
    state.addUniform(new osg::Uniform("frame", osg::Matrixf()));
    state.setUserValue("IOR", std::string("1.25"));
    state.setUserValue("Glow", osg::Vec3d(3.0, 2.0, 1.0));
    state.setUserValue("Name", std::string("oak"));
    CHECK(materialOf(shaded, R"("roughness": 0.125, "ior": 1.75)").ior == 1.75f);
    CHECK(materialOf(shaded, R"("roughness": { "uniform": "gloss" })").roughness == 0.25f);
    CHECK(materialOf(shaded, R"("roughness": { "uniform": "gl*", "invert": true })").roughness ==
          0.75f);
    CHECK(materialOf(shaded, R"("roughness": { "uniform": "gloss", "invert": true, "scale": 0.5 })")
              .roughness == 0.375f);
    CHECK(materialOf(shaded, R"("metallic": { "uniform": "steps" })").metallic == 1.0f);
    CHECK(materialOf(shaded, R"("ior": { "uniform": "bright" })").ior == 4.0f); // the range's end
    const Vec3 tint = materialOf(shaded, R"("baseColor": { "uniform": "tint" })").baseColor;
    CHECK(tint == Vec3(0.5f, 1.0f, 0.0f));
    CHECK(materialOf(shaded, R"("baseColor": { "uniform": "tint", "srgb": true })").baseColor.x ==
          Approx(0.21404));
    CHECK(materialOf(shaded, R"("ior": { "user": "IOR" })").ior == 1.25f);
    CHECK(materialOf(shaded, R"("emission": { "user": "Glow" })").emission == Vec3(3, 2, 1));

    const Messages messages;
    CHECK(materialOf(shaded, R"("ior": { "uniform": "frame" })").ior == 1.5f);
    CHECK(messages.timesSaid("asks for the uniform 'frame', which is not there") == 1);
    CHECK(materialOf(shaded, R"("ior": { "user": "Name" })").ior == 1.5f);
    CHECK(messages.timesSaid("asks for the user value 'Name', which is not there") == 1);
    state.addUniform(new osg::Uniform("gloss", std::numeric_limits<float>::quiet_NaN()));
    CHECK(materialOf(shaded, R"("roughness": { "uniform": "gloss" })").roughness == 1.0f);
}

TEST_CASE("shader rules: textures by sampler, unit, user value and file", "[bridge]")
{
    ShadedPart shaded;
    shaded.bind(4, texel({10, 20, 30, 40}, "wall.png"), "diffuseMap");
    shaded.bind(6, texel({50, 60, 70, 80}, "wall_rough.png"));
    shaded.state().setUserValue("sMetallic", std::string("6"));
    const auto colorOf = [&](const std::string& source)
    {
        const ConversionResult result =
            shaded.convert("{ " + kBump + ", \"baseColorTexture\": { " + source + " } }");
        return texelOf(result, soleMaterial(result).baseColorTexture);
    };
    CHECK(colorOf(R"("sampler": "diffuseMap")") == std::vector<int>{10, 20, 30, 40});
    CHECK(colorOf(R"("sampler": "*Map", "srgb": true)") == std::vector<int>{10, 20, 30, 40});
    CHECK(colorOf(R"("unit": 6)") == std::vector<int>{50, 60, 70, 80});
    CHECK(colorOf(R"("user": "sMetallic")") == std::vector<int>{50, 60, 70, 80});
    CHECK(colorOf(R"("texture": "*_rough.png")") == std::vector<int>{50, 60, 70, 80});

    const ConversionResult linear =
        shaded.convert("{ " + kBump + R"(, "baseColorTexture": { "unit": 4, "srgb": false } })");
    const Texture& floats = *linear.scene->textures.at(soleMaterial(linear).baseColorTexture);
    REQUIRE(floats.floats.size() == 4);
    CHECK(floats.floats[1] == Approx(20.0 / 255.0));
    CHECK_FALSE(floats.decodeSrgb);

    // A number that is given beside a texture is its factor, and nothing without the texture.
    const Material glow = materialOf(
        shaded, R"("emission": [1, 1, 1], "emissionTexture": { "sampler": "diffuseMap" })");
    CHECK(glow.emission == Vec3(1.0f));
    CHECK(glow.emissionTexture != kInvalid);
    const Messages messages;
    const Material dark = materialOf(
        shaded, R"("emission": [1, 1, 1], "emissionTexture": { "unit": 9, "optional": true })");
    CHECK(dark.emission == Vec3(0.0f));
    CHECK(messages.timesSaid("is not there") == 0);
    CHECK(countOf(shaded.convert("{ " + kBump + R"(, "emissionTexture": { "unit": 9 } },
                                 { "if": { "unit": 6 } })"),
                  "warned.material-value") == 1);
    CHECK(messages.timesSaid("material file, shaders 'rule 1': asks for the 2-D texture of unit "
                             "'9', which is not there") == 1);
}

TEST_CASE("shader rules: layers of texture arrays are textures", "[bridge]")
{
    ShadedPart shaded;
    const osg::ref_ptr<osg::Texture2DArray> array = new osg::Texture2DArray;
    array->setTextureSize(1, 1, 3);
    array->setWrap(osg::Texture::WRAP_S, osg::Texture::MIRROR);
    for (const unsigned char layer : {0, 1, 2})
        array->setImage(layer, texel({layer, 50, 60, 70})->getImage());
    shaded.bind(3, array, "layers");
    const osg::ref_ptr<osg::Uniform> number = new osg::Uniform("number", 0.6f);
    shaded.state().addUniform(number);

    const auto redOf = [&](const std::string& layer)
    {
        const ConversionResult result = shaded.convert(
            "{ " + kBump + R"(, "baseColorTexture": { "sampler": "layers", "layer": )" + layer +
            " } }");
        const uint32_t texture = soleMaterial(result).baseColorTexture;
        CHECK(result.scene->textures.at(texture)->wrapS == TextureWrap::Mirror);
        return texelOf(result, texture).at(0);
    };
    CHECK(redOf("0") == 0);
    CHECK(redOf("2") == 2);
    CHECK(redOf("9") == 2); // as OpenGL clamps it
    CHECK(redOf(R"({ "uniform": "number" })") == 1);

    // Layers have channels, and a change of the layer or of its image shows.
    SceneConverter converter;
    const ConversionInput input = shaded.input("{ \"shaders\": [ { " + kBump + R"(,
        "roughnessTexture": { "unit": 3, "layer": { "uniform": "number" } } } ] })");
    const auto roughness = [&]
    {
        const ConversionResult result = converter.convert(input);
        return texelOf(result, soleMaterial(result).metallicRoughnessTexture).at(1);
    };
    CHECK(roughness() == 1);
    number->set(2.0f);
    CHECK(roughness() == 2);
    array->getImage(2)->data()[0] = 99;
    array->getImage(2)->dirty();
    CHECK(roughness() == 99);

    // What is not there is named: an array where there is a texture, and a uniform.
    shaded.bind(4, texel({1, 2, 3, 4}), "flat");
    const auto misses = [&](const std::string& source)
    {
        const Messages messages;
        shaded.convert("{ " + kBump + ", \"emissionTexture\": { " + source + " } }");
        return messages.text();
    };
    CHECK_THAT(misses(R"("sampler": "flat", "layer": 0)"),
               Contains("asks for the layer of sampler 'flat', which is not there"));
    CHECK_THAT(misses(R"("sampler": "layers")"),
               Contains("asks for the 2-D texture of sampler 'layers'"));
    CHECK_THAT(misses(R"("sampler": "layers", "layer": { "uniform": "none" })"),
               Contains("asks for the uniform 'none'"));
    CHECK_THAT(memberError(R"("normalTexture": { "unit": 0, "layer": -1 })"),
               Contains("'layer': a number is out of range"));
}

TEST_CASE("shader rules: channels are put where they belong, once", "[bridge]")
{
    ShadedPart shaded;
    shaded.bind(1, texel({10, 20, 30, 40}));
    shaded.bind(2, texel({50, 60, 70, 80}));
    const auto packedOf = [&](const std::string& textures)
    {
        const ConversionResult result = shaded.convert("{ " + kBump + ", " + textures + " }");
        std::vector<int> rgba = texelOf(result, soleMaterial(result).metallicRoughnessTexture);
        return std::vector<int>{rgba[1], rgba[2]}; // roughness, metallic
    };
    CHECK(packedOf(R"("metallicRoughnessTexture": { "unit": 1 })") == std::vector<int>{20, 30});
    CHECK(packedOf(R"("metallicRoughnessTexture": { "unit": 1, "channels": "ra" })") ==
          std::vector<int>{10, 40});
    CHECK(packedOf(R"("metallicRoughnessTexture": { "unit": 1, "invert": true })") ==
          std::vector<int>{235, 225});
    CHECK(packedOf(R"("roughnessTexture": { "unit": 1, "channels": "a", "invert": true },
                      "metallicTexture": { "unit": 2 })") == std::vector<int>{215, 50});
    CHECK(packedOf(R"("roughnessTexture": { "unit": 2 })") == std::vector<int>{50, 255});

    const ConversionResult body =
        shaded.convert("{ " + kBump + R"(, "subsurface": 0.5, "subsurfaceRadius": [1, 2, 3],
            "subsurfaceTexture": { "unit": 2, "channels": "g" },
            "subsurfaceRadiusTexture": { "unit": 1, "channels": "bgr" } })");
    const Material& skin = soleMaterial(body);
    REQUIRE(skin.detail);
    CHECK(skin.detail->subsurface == 0.5f);
    CHECK(skin.detail->subsurfaceRadius == Vec3(1.0f, 2.0f, 3.0f));
    CHECK(texelOf(body, skin.detail->textures[kSubsurfaceRole])[0] == 60);
    const std::vector<int> radius = texelOf(body, skin.detail->textures[kSubsurfaceRadiusRole]);
    CHECK(std::vector<int>(radius.begin(), radius.begin() + 3) == std::vector<int>{30, 20, 10});
    // Without their texture the parameters are those of a rule that does not name them.
    CHECK_FALSE(soleMaterial(shaded.convert("{ " + kBump + R"(, "subsurface": 0.5,
        "subsurfaceTexture": { "unit": 7, "optional": true } })"))
                    .detail);

    const std::string alpha = R"("transmissionTexture": { "unit": 2, "channels": "a" })";
    SceneConverter converter;
    const ConversionInput input =
        shaded.input("{ \"shaders\": [ { " + kBump + ", " + alpha + " } ] }");
    const ConversionResult first = converter.convert(input);
    CHECK(texelOf(first, soleMaterial(first).transmissionTexture)[0] == 80);
    const auto textureOf = [](const ConversionResult& result)
    { return result.scene->textures.at(soleMaterial(result).transmissionTexture); };
    // An unchanged image is not read again; a changed one is.
    CHECK(textureOf(converter.convert(input)) == textureOf(first));
    auto* texture = static_cast<osg::Texture2D*>(
        shaded.state().getTextureAttribute(2, osg::StateAttribute::TEXTURE));
    texture->getImage()->data()[3] = 90;
    texture->getImage()->dirty();
    const ConversionResult painted = converter.convert(input);
    CHECK(texelOf(painted, soleMaterial(painted).transmissionTexture)[0] == 90);
    // The source's filters and wrap modes are taken over without its image being changed.
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::MIRROR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    const auto sampled = textureOf(converter.convert(input));
    CHECK(sampled->wrapS == TextureWrap::Mirror);
    CHECK_FALSE(sampled->linearFilter);
}

TEST_CASE("shader rules: a textured channel keeps the largest size, and wraps as its source",
          "[bridge]")
{
    ShadedPart shaded;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 1, 1, GL_LUMINANCE, GL_UNSIGNED_BYTE);
    image->data()[0] = 40;
    image->data()[1] = 200;
    osg::ref_ptr<osg::Texture2D> wide = new osg::Texture2D(image);
    wide->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    shaded.bind(0, wide);
    shaded.bind(1, texel({90, 0, 0, 0}));
    const ConversionResult result = shaded.convert("{ " + kBump + R"(,
        "roughnessTexture": { "unit": 0 }, "metallicTexture": { "unit": 1 } })");
    const Texture& packed =
        *result.scene->textures.at(soleMaterial(result).metallicRoughnessTexture);
    REQUIRE(packed.width == 2);
    CHECK(packed.wrapS == TextureWrap::Repeat);
    CHECK(int(packed.bytes[1]) == 40);
    CHECK(int(packed.bytes[5]) == 200);
    CHECK(int(packed.bytes[6]) == 90);
}

TEST_CASE("shader rules: without a base colour the model's stays", "[bridge]")
{
    ShadedPart shaded;
    osg::ref_ptr<osg::Material> red = new osg::Material;
    red->setDiffuse(osg::Material::FRONT, osg::Vec4(1, 0, 0, 1));
    shaded.state().setAttribute(red);
    shaded.state().setTextureAttributeAndModes(0, texel({1, 2, 3, 4}));
    shaded.bind(5, texel({5, 6, 7, 8}), "diffuseMap");
    CHECK(materialOf(shaded, R"("roughness": 0.5)").baseColor == Vec3(1, 0, 0));
    const ConversionResult own = shaded.convert("{ " + kBump + " }");
    CHECK(texelOf(own, soleMaterial(own).baseColorTexture)[0] == 1);
    const ConversionResult mapped =
        shaded.convert("{ " + kBump + R"(, "baseColorTexture": { "sampler": "diffuseMap" } })");
    CHECK(soleMaterial(mapped).baseColor == Vec3(1, 0, 0));
    CHECK(texelOf(mapped, soleMaterial(mapped).baseColorTexture)[0] == 5);
    CHECK(materialOf(shaded, R"("baseColor": [0, 1, 0])").baseColorTexture == kInvalid);
}

TEST_CASE("shader rules: alpha is tested against a constant or a uniform", "[bridge]")
{
    ShadedPart shaded;
    shaded.state().addUniform(new osg::Uniform("alphaRef", 0.25f));
    const Material tested = materialOf(shaded, R"("alphaReference": { "uniform": "alphaRef" })");
    CHECK(tested.alphaTest == AlphaTest::Greater);
    CHECK(tested.alphaReference == 0.25f);
    CHECK(materialOf(shaded, R"("alphaReference": 0.5)").alphaReference == 0.5f);
    CHECK(materialOf(shaded, R"("roughness": 1)").alphaTest == AlphaTest::Always);
}

TEST_CASE("shader rules: coordinates of the texture's unit, or of unit 0", "[bridge]")
{
    ShadedPart shaded;
    shaded.bind(0, texel({1, 2, 3, 4}));
    shaded.bind(5, texel({5, 6, 7, 8}));
    osg::ref_ptr<osg::Vec2Array> own = new osg::Vec2Array(3);
    (*own)[1] = osg::Vec2(0.25f, 0.75f);
    const auto second = [&](const std::string& unit)
    {
        const ConversionResult result =
            shaded.convert("{ " + kBump + ", \"baseColorTexture\": { \"unit\": " + unit + " } }");
        CHECK(soleMaterial(result).baseColorTexture != kInvalid);
        return soleMesh(result).uvs[1];
    };
    CHECK(second("5") == Vec2(0.0f, 0.0f)); // there are none for unit 5
    shaded.part->setTexCoordArray(5, own);
    CHECK(second("5") == Vec2(0.25f, 0.75f));
    CHECK(second("0") == Vec2(0.0f, 0.0f));
    CHECK(shaded.part->getTexCoordArray(0) != own); // the graph is as it was
}

TEST_CASE("shader rules: vertex attributes in the place of fixed arrays", "[bridge]")
{
    ShadedPart shaded;
    shaded.bind(0, texel({1, 2, 3, 4}));
    const osg::ref_ptr<osg::Array> positions = shaded.part->getVertexArray();
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec2Array> coordinates = new osg::Vec2Array(3);
    normals->assign(3, osg::Vec3(0, 0, 1));
    coordinates->assign(3, osg::Vec2(0.5f, 0.25f));
    shaded.part->setVertexArray(nullptr);
    shaded.part->setTexCoordArray(0, nullptr);
    shaded.part->setVertexAttribArray(6, positions, osg::Array::BIND_PER_VERTEX);
    shaded.part->setVertexAttribArray(2, normals, osg::Array::BIND_PER_VERTEX);
    shaded.part->setVertexAttribArray(8, coordinates, osg::Array::BIND_PER_VERTEX);
    const std::string rule = "{ " + kBump + R"(, "baseColorTexture": { "unit": 0 },
        "attributes": { "position": 6, "normal": 2, "texcoord": 8 } })";
    const ConversionResult result = shaded.convert(rule);
    REQUIRE(result.scene->instances.size() == 1);
    CHECK(firstCorner(*result.scene, 0) == Vec3(0.0f));
    CHECK(soleMesh(result).positions.size() == 3);
    CHECK(soleMesh(result).normals.size() == 3);
    CHECK(soleMesh(result).uvs[2] == Vec2(0.5f, 0.25f));
    CHECK(shaded.part->getVertexArray() == nullptr);
    CHECK(countOf(shaded.convert("{ " + kBump + " }"), "not-traced.no-vertices") == 1);
}
