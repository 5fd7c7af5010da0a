// MaterialLibraryTest.cpp - material files: their content, their errors, and what they apply to.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"
#include "tests/bridge/Messages.h"
#include "tests/plugins/TemporaryFolder.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialListing.h"

#include <osg/Image>
#include <osg/Material>
#include <osg/Texture2D>

#include <sys/stat.h>

#include <limits>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using Catch::Matchers::Contains;

namespace
{

std::string errorOf(const std::string& text)
{
    const MaterialLibraryResult result = parseMaterialLibrary(text, "m.json");
    CHECK((result.library == nullptr) == !result.error.empty());
    return result.error;
}

/// Returns the message about an error of a parameter in line 3.
std::string parameterError(const std::string& parameter)
{
    return errorOf("{ \"nodes\": {\n \"cow\": {\n" + parameter + "\n} } }");
}

ConversionInput inputWith(osg::Node* root, const std::string& text)
{
    ConversionInput input = inputFor(root);
    const MaterialLibraryResult result = parseMaterialLibrary(text, "m.json");
    REQUIRE(result.error == "");
    input.materials = result.library;
    return input;
}

/// Holds a group "house" with a geometry "roof" of the material "tiles" and the texture
/// "pictures/red.png".
struct House
{
    House()
    {
        roof->setName("roof");
        group->setName("house");
        group->addChild(roof);
        tiles->setName("tiles");
        tiles->setDiffuse(osg::Material::FRONT, osg::Vec4(0.5f, 1.0f, 0.0f, 1.0f));
        image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
        image->setFileName("pictures/red.png");
        osg::StateSet* state = roof->getOrCreateStateSet();
        state->setAttribute(tiles);
        state->setTextureAttributeAndModes(0, new osg::Texture2D(image));
        roof->setTexCoordArray(0, new osg::Vec2Array(3));
    }

    Material material(const std::string& text)
    {
        SceneConverter converter;
        const ConversionResult result = converter.convert(inputWith(group, text));
        return soleMaterial(result);
    }

    osg::ref_ptr<osg::Geometry> roof = triangleGeometry();
    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<osg::Material> tiles = new osg::Material;
    osg::ref_ptr<osg::Image> image = new osg::Image;
};

std::string roughness(const std::string& group, const std::string& name, const std::string& value)
{
    return "\"" + group + "\": { \"" + name + "\": { \"roughness\": " + value + " } }";
}

} // namespace

TEST_CASE("material files: every parameter", "[bridge]")
{
    const auto result = parseMaterialLibrary(R"({
        "materials": { "a": { "baseColor": [0.25, 0.5, 1], "metallic": 0.125, "roughness": 0,
                              "transmission": 0.75, "ior": 1.33, "emission": [2, 0, 1e3] },
                       "b": {} },
        "textures": {} })",
                                             "m.json");
    REQUIRE(result.error == "");
    REQUIRE(result.library->materials.size() == 2);
    const MaterialRule& rule = result.library->materials[0];
    CHECK(rule.pattern == "a");
    CHECK_FALSE(rule.keepsColor);
    CHECK(rule.material->getBaseColor() == osg::Vec3(0.25f, 0.5f, 1.0f));
    CHECK(rule.material->getMetallic() == 0.125f);
    CHECK(rule.material->getRoughness() == 0.0f);
    CHECK(rule.material->getTransmission() == 0.75f);
    CHECK(rule.material->getIor() == 1.33f);
    CHECK(rule.material->getEmission() == osg::Vec3(2.0f, 0.0f, 1000.0f));
    CHECK(result.library->materials[1].keepsColor);
    CHECK(result.library->materials[1].material->getRoughness() == 1.0f);
    CHECK(errorOf("{}") == "");
}

TEST_CASE("material files: what is wrong is named, with its line", "[bridge]")
{
    CHECK_THAT(errorOf("{ \"nodes\": {\n\n  \"cow\": { \"ior\" 1 } } }"),
               Contains("m.json: parse error at line 3, column 18"));
    CHECK_THAT(errorOf(""), Contains("m.json: parse error at line 1"));
    CHECK_THAT(errorOf("{} x"), Contains("parse error at line 1"));
    CHECK_THAT(errorOf("{\n\"nods\": {} }"),
               Contains("m.json:2: 'nods' is none of nodes, materials, textures, shaders"));
    CHECK_THAT(errorOf("[]"), Contains("m.json:1: an object was expected, not an array"));
    CHECK_THAT(errorOf("{ \"nodes\": 3 }"),
               Contains("an object was expected for the name, not a number"));
    CHECK_THAT(errorOf("{ \"nodes\": { \"\": {} } }"), Contains("a name is empty"));
    CHECK_THAT(errorOf("{ \"nodes\": { \"a\": {},\n \"a\": {} } }"),
               Contains("m.json:2: nodes: 'a' is there twice"));

    CHECK_THAT(parameterError("\"roughnes\": 1"),
               Contains("m.json:3: nodes: 'cow': 'roughnes' is no parameter; there are baseColor, "
                        "metallic, roughness, transmission, ior, emission, alpha"));
    CHECK_THAT(parameterError("\"ior\": 0.9"),
               Contains("m.json:3: nodes: 'cow': 'ior': 0.9 is not from 1.0 to 4.0"));
    CHECK_THAT(parameterError("\"baseColor\": [0.5, 1.5, 0]"),
               Contains("1.5 is not from 0.0 to 1.0"));
    CHECK_THAT(parameterError("\"emission\": [0, -1, 0]"), Contains("-1.0 is not from"));
    for (const char* whole : {"interiorPriority", "thinWalled", "vertexColors", "edits"})
        CHECK_THAT(parameterError('"' + std::string(whole) + "\": 0.5"),
                   Contains("'" + std::string(whole) + "': 0.5 is no whole number"));
    CHECK(parameterError("\"interiorPriority\": -3") == "");
    CHECK(parameterError("\"interiorPriority\": 2.0") == "");
    CHECK_THAT(
        parameterError("\"baseColor\": [0.5, 1]"),
        Contains("'baseColor': an array of three numbers was expected, not an array of another"));
    CHECK_THAT(parameterError("\"baseColor\": [1, 1, 1, 1]"), Contains("array of another length"));
    CHECK_THAT(parameterError("\"baseColor\": 1"),
               Contains("three numbers was expected, not a number"));
    CHECK_THAT(parameterError("\"baseColor\": [[1]]"), Contains("expected, not an array"));
    CHECK_THAT(parameterError("\"roughness\": [1]"),
               Contains("'roughness': a number was expected, not an array"));
    CHECK_THAT(parameterError("\"roughness\": \"0.5\""), Contains("expected, not a string"));
    CHECK_THAT(parameterError("\"roughness\": null"), Contains("expected, not null"));
    CHECK_THAT(parameterError("\"roughness\": true"), Contains("expected, not true or false"));
    CHECK_THAT(parameterError("\"roughness\": {}"), Contains("expected, not an object"));
    CHECK_THAT(parameterError("\"roughness\": 1e999"),
               Contains("m.json:3: number overflow parsing '1e999'"));
    CHECK_THAT(parameterError("\"ior\": 2,\n \"ior\": 2"),
               Contains("m.json:4: nodes: 'cow': 'ior' is there twice"));
    CHECK_THAT(readMaterialLibrary("no such file.json").error,
               Contains("no such file.json: there is no such file"));
}

TEST_CASE("material files: patterns", "[bridge]")
{
    CHECK(matchesPattern("cow", "cow"));
    CHECK_FALSE(matchesPattern("cow", "cows"));
    CHECK_FALSE(matchesPattern("cow", "Cow"));
    CHECK(matchesPattern("*", ""));
    CHECK(matchesPattern("*", "anything"));
    CHECK(matchesPattern("cow*", "cow.osg"));
    CHECK(matchesPattern("*glass*", "a glass door"));
    CHECK(matchesPattern("a*b*c", "a b b c c"));
    CHECK_FALSE(matchesPattern("a*b*c", "a c b"));
    CHECK_FALSE(matchesPattern("", "x"));
    CHECK(matchesPattern("*ab", "aab"));
}

TEST_CASE("material files: very many names are no more than many names", "[bridge]")
{
    // This takes minutes if each name is compared with each other one.
    constexpr int kNames = 200000;
    std::string text = "{ \"nodes\": {\n";
    for (int i = 0; i < kNames; ++i)
        text += "\"part " + std::to_string(i) + "\": {},\n";
    text += "\"part 7*\": {} } }";
    const MaterialLibraryResult result = parseMaterialLibrary(text, "m.json");
    REQUIRE(result.error == "");
    const MaterialRuleList& nodes = result.library->nodes;
    REQUIRE(nodes.size() == kNames + 1);
    int wrong = 0;
    for (int i = 0; i < kNames; ++i)
        wrong += nodes.find(nodes[std::size_t(i)].pattern) != &nodes[std::size_t(i)];
    CHECK(wrong == 0);
    CHECK(nodes.find("part 7 of 9") == &nodes[kNames]);
    CHECK(nodes.find("part") == nullptr);
    CHECK_THAT(errorOf(text.substr(0, text.size() - 4) + ",\n\"part 5\": {} } }"),
               Contains("m.json:200003: nodes: 'part 5' is there twice"));
}

TEST_CASE("material files: names with stars are bounded", "[bridge]")
{
    const auto withPatterns = [](std::size_t count)
    {
        std::string text = "{ \"nodes\": {";
        for (std::size_t i = 0; i < count; ++i)
            text += "\n\"*part " + std::to_string(i) + "\": {},";
        return text + "\n\"plain\": {} } }";
    };
    CHECK(errorOf(withPatterns(kMostPatterns)) == "");
    CHECK_THAT(errorOf(withPatterns(kMostPatterns + 1)),
               Contains("m.json:1026: nodes: '*part 1024': more than 1024 names with '*'"));
}

TEST_CASE("material files: what has no end is refused", "[bridge]")
{
    CHECK_THAT(readMaterialLibrary("/dev/zero").error, Contains("/dev/zero: is a device"));
    const TemporaryFolder folder;
    REQUIRE(mkfifo((folder / "pipe.json").c_str(), 0600) == 0);
    CHECK_THAT(readMaterialLibrary(folder / "pipe.json").error, Contains("pipe.json: is a pipe"));
    CHECK_THAT(readMaterialLibrary(folder / ".").error, Contains("is a directory"));
}

TEST_CASE("material files: nodes win over materials over textures, names over patterns", "[bridge]")
{
    House house;
    const std::string textures = roughness("textures", "red.png", "0.5");
    const std::string materials = roughness("materials", "tiles", "0.25");
    CHECK(house.material("{}").model == MaterialModel::FixedFunction);
    CHECK(house.material("{" + textures + "}").roughness == 0.5f);
    CHECK(house.material("{" + roughness("textures", "pictures/*", "0.5") + "}").roughness == 0.5f);
    CHECK(house.material("{" + textures + "," + materials + "}").roughness == 0.25f);
    CHECK(house.material("{" + materials + "," + roughness("nodes", "house", "0.125") + "}")
              .roughness == 0.125f);
    CHECK(house
              .material(
                  R"({"nodes": { "house": { "roughness": 0.5 }, "roof": { "roughness": 0 } } })")
              .roughness == 0.0f); // the nearest node decides
    CHECK(house
              .material(R"({"nodes": { "r*": { "roughness": 0.5 }, "*": { "roughness": 0.75 },
                           "roof": { "roughness": 0.25 } } })")
              .roughness == 0.25f);
    CHECK(
        house.material(R"({"nodes": { "r*": { "roughness": 0.5 }, "*": { "roughness": 0.75 } } })")
            .roughness == 0.5f);
    // The file also replaces what the model itself says.
    osg::ref_ptr<PhysicalMaterial> own = new PhysicalMaterial;
    house.roof->getStateSet()->setAttribute(own, osg::StateAttribute::OVERRIDE);
    CHECK(house.material("{" + materials + "}").roughness == 0.25f);
}

TEST_CASE("material files: without a base colour the model's stays", "[bridge]")
{
    House house;
    const Material kept = house.material(R"({"nodes": { "roof": { "metallic": 1 } } })");
    CHECK(kept.model == MaterialModel::Physical);
    CHECK(kept.baseColorTexture != kInvalid);
    CHECK(kept.baseColor.x == Approx(0.21404)); // sRGB 0.5
    CHECK(kept.baseColor.y == Approx(1.0));
    const Material given =
        house.material(R"({"nodes": { "roof": { "baseColor": [1, 0.5, 0] } } })");
    CHECK(given.baseColorTexture == kInvalid);
    CHECK(given.baseColor == Vec3(1.0f, 0.5f, 0.0f));

    // One rule applies to two models.
    House other;
    other.tiles->setDiffuse(osg::Material::FRONT, osg::Vec4(0.0f, 0.0f, 1.0f, 1.0f));
    house.group->addChild(other.group);
    SceneConverter converter;
    const ConversionResult result = converter.convert(
        inputWith(house.group, R"({"materials": { "tiles": { "roughness": 0.5 } } })"));
    REQUIRE(result.scene->instances.size() == 2);
    const auto colorOf = [&](std::size_t i)
    { return result.scene->materials[result.scene->instances[i].material].baseColor; };
    CHECK(colorOf(0).y == Approx(1.0));
    CHECK(colorOf(1) == Vec3(0.0f, 0.0f, 1.0f));
    CHECK_FALSE(result.scene->displayReferred);
}

TEST_CASE("material files: what fits nothing is named once", "[bridge]")
{
    House house;
    const test::Messages messages;
    SceneConverter converter;
    const ConversionInput input =
        inputWith(house.group,
                  R"({"materials": { "tiles": {}, "marble": {} }, "nodes": { "cellar*": {} } })");
    for (int again = 0; again < 2; ++again)
        CHECK(countOf(converter.convert(input), "warned.material-name") == 2);
    CHECK(messages.timesSaid(
              "material file, materials 'marble': nothing in the scene has this name") == 1);
    CHECK(messages.timesSaid("material file, nodes 'cellar*': nothing") == 1);
    CHECK(messages.timesSaid("tiles") == 0);
}

TEST_CASE("material listings: a shared part hides the names of all parents", "[bridge]")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group, a = new osg::Group, b = new osg::Group;
    House shared;
    shared.roof->getStateSet()->removeTextureAttribute(0, osg::StateAttribute::TEXTURE);
    a->setName("a");
    b->setName("b");
    root->addChild(a);
    root->addChild(b);
    a->addChild(shared.group);
    b->addChild(shared.group);
    b->addChild(triangleGeometry());

    // An entry "b" would win over "tiles" for the shared part.
    const MaterialListing listing = listMaterials(*root);
    CHECK(listing.entries == 1);
    CHECK(listing.nameless == 1);
    CHECK(listing.complete);
    const MaterialListing cut = listMaterials(*root, 4);
    CHECK_FALSE(cut.complete);
    CHECK(cut.entries + cut.nameless < listing.entries + listing.nameless);
    SceneConverter plain, listed;
    const ConversionResult before = plain.convert(inputFor(root));
    const ConversionResult after = listed.convert(inputWith(root, listing.text));
    REQUIRE(before.scene->instances.size() == 3);
    REQUIRE(after.scene->instances.size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
    {
        CAPTURE(i);
        const Material& was = before.scene->materials[before.scene->instances[i].material];
        const Material& is = after.scene->materials[after.scene->instances[i].material];
        CHECK(is.model == was.model);
        CHECK(is.diffuse == was.diffuse);
    }
}
