// ReportOptionTest.cpp - osgraytrace --report as its users see it. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"

#include <osgRayTrace/PhysicalMaterial>

#include <nlohmann/json.hpp>

#include <osg/Fog>
#include <osg/Geometry>
#include <osg/Group>
#include <osg/Image>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/Program>
#include <osg/Texture2D>
#include <osg/Uniform>
#include <osg/ValueObject>
#include <osgDB/WriteFile>

using Catch::Matchers::Contains;

namespace
{

osg::ref_ptr<osg::Geometry> strokes(GLenum mode, const std::string& name)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (int i = 0; i < 3; ++i)
        vertices->push_back(osg::Vec3(i, i * i, 0.0f));
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setName(name);
    geometry->setVertexArray(vertices.get());
    geometry->addPrimitiveSet(new osg::DrawArrays(mode, 0, 3));
    return geometry;
}

std::string writeScene(const TemporaryFolder& folder, bool triangles)
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("town");
    root->addChild(strokes(GL_LINES, "fence").get());
    if (triangles) root->addChild(strokes(GL_TRIANGLES, "roof").get());
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setFogCoordinateSource(osg::Fog::FOG_COORDINATE);
    root->getOrCreateStateSet()->setAttributeAndModes(fog);
    REQUIRE(osgDB::writeNodeFile(*root, folder / "town.osgt"));
    return folder / "town.osgt";
}

} // namespace

TEST_CASE("osgraytrace --report: what became of a scene, without a picture", "[apps]")
{
    const TemporaryFolder folder, models;
    const std::string town = writeScene(models, true);
    const Outcome outcome = osgraytrace(folder, town + " --report --size 8 8");
    CHECK(outcome.exitCode == 0);
    CHECK_THAT(outcome.output,
               Contains("Ray traced:\n         1  geometry\n              town/roof\n"));
    CHECK_THAT(outcome.output, Contains("         1  fog coordinate\n              town/roof\n"));
    CHECK_THAT(outcome.output, Contains("not with all that OpenGL does:"));
    CHECK_THAT(outcome.output, Contains("              town/fence\n"));
    CHECK(folder.fileNames().empty());

    const Outcome stored = osgraytrace(folder, town + " --report --size 8 8 --stats s.json");
    CHECK(stored.exitCode == 0);
    const auto json = nlohmann::json::parse(contents(folder / "s.json"));
    CHECK(json["conversionPaths"]["approximated.fog-coordinate"] == nlohmann::json{"town/roof"});
    CHECK(json["passes"] == 1);
    CHECK(osgraytrace(folder, town + " --report --size 8 8 --passes 3 --stats s.json").exitCode ==
          0);
    CHECK(nlohmann::json::parse(contents(folder / "s.json"))["passes"] == 3);
}

TEST_CASE("osgraytrace --report: also of a scene that cannot be rendered", "[apps]")
{
    const TemporaryFolder folder, models;
    const Outcome outcome =
        osgraytrace(folder, writeScene(models, false) + " --report -o x.png --size 8 8");
    CHECK(outcome.exitCode == 3);
    CHECK_THAT(outcome.output, Contains("              town/fence\n"));
    CHECK_THAT(outcome.errors, Contains("no triangles"));
}

TEST_CASE("osgraytrace --materials: glass by a name, and errors with their line", "[apps]")
{
    const TemporaryFolder folder, models;
    const std::string town = writeScene(models, true);
    const auto write = [&](const std::string& text) { std::ofstream(models / "m.json") << text; };
    const std::string run = town + " --size 8 8 --passes 1 -o x.exr --stats s.json --materials '" +
                            models / "m.json" + "'";

    write("{ \"nodes\": { \"roof\": { \"metallic\": 1 }, \"cellar\": {} } }");
    const Outcome good = osgraytrace(folder, run);
    CHECK(good.exitCode == 0);
    CHECK_THAT(good.errors, Contains("nodes 'cellar': nothing in the scene has this name"));
    const auto json = nlohmann::json::parse(contents(folder / "s.json"));
    CHECK(json["integrator"] == "path"); // the scene is no longer a fixed-function one

    write("{ \"nodes\": {\n \"roof\": { \"metalic\": 1 } } }");
    const Outcome bad = osgraytrace(folder, run);
    CHECK(bad.exitCode == 2);
    CHECK_THAT(bad.errors, Contains("m.json:2: nodes: 'roof': 'metalic' is no parameter"));
    CHECK(osgraytrace(folder, town + " -o x.exr --materials 'no such.json'").exitCode == 2);
}

TEST_CASE("osgraytrace --names: a line for each name that a material file can use", "[apps]")
{
    const TemporaryFolder folder, models;
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("to\twn"); // a tab would end the column
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1, 1, 1, GL_RGB, GL_UNSIGNED_BYTE);
    image->setFileName("wall.png");
    for (int i = 0; i < 2; ++i)
    {
        const osg::ref_ptr<osg::Geometry> house = strokes(GL_TRIANGLES, "house");
        osg::StateSet& state = *house->getOrCreateStateSet();
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->setName("Bump");
        osg::ref_ptr<osg::Material> material = new osg::Material;
        material->setName("brick");
        state.setAttribute(program);
        state.setAttribute(material);
        state.setTextureAttribute(3, new osg::Texture2D(image));
        state.addUniform(new osg::Uniform("diffuseMap", 3));
        state.addUniform(new osg::Uniform("gloss", 0.5f));
        state.setUserValue("kind", std::string("brick"));
        root->addChild(house);
        root->addChild(house); // a second path is no second house
    }
    REQUIRE(osgDB::writeNodeFile(*root, folder / "town.osgb"));
    const Outcome outcome = osgraytrace(models, (folder / "town.osgb") + " --names");
    CHECK(outcome.exitCode == 0);
    CHECK(outcome.output == "material\t2\tbrick\t-\tto\\twn/house\n"
                            "node\t2\thouse\t-\tto\\twn/house\n"
                            "node\t1\tto\\twn\t-\tto\\twn\n"
                            "program\t2\tBump\t-\tto\\twn/house\n"
                            "sampler\t2\tdiffuseMap\t3\tto\\twn/house\n"
                            "texture\t2\twall.png\t3\tto\\twn/house\n"
                            "uniform\t2\tgloss\t-\tto\\twn/house\n"
                            "user\t2\tkind\t-\tto\\twn/house\n");
    CHECK(models.fileNames().empty());
    CHECK(osgraytrace(models, "--names").exitCode == 1); // no model
}

namespace
{

/// Returns a triangle beside the others, with a material of this name.
osg::ref_ptr<osg::MatrixTransform> placed(int place, const std::string& material,
                                          osgRayTrace::PhysicalMaterial* physical)
{
    const osg::ref_ptr<osg::Geometry> geometry = strokes(GL_TRIANGLES, "");
    osg::ref_ptr<osg::Material> own = new osg::Material;
    own->setName(material);
    own->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.7f, 0.1f, 0.3f, 1.0f));
    own->setSpecular(osg::Material::FRONT_AND_BACK, osg::Vec4(0.4f, 0.4f, 0.4f, 1.0f));
    geometry->getOrCreateStateSet()->setAttribute(own);
    if (physical) geometry->getOrCreateStateSet()->setAttribute(physical);
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(
        osg::Matrixd::rotate(1.57, osg::X_AXIS) * osg::Matrixd::translate(1.5 * place, 0.0, 0.0));
    transform->addChild(geometry);
    return transform;
}

osg::ref_ptr<osgRayTrace::PhysicalMaterial> metal(float roughness)
{
    osg::ref_ptr<osgRayTrace::PhysicalMaterial> material = new osgRayTrace::PhysicalMaterial;
    material->setBaseColor(osg::Vec3(0.1f, 0.7f, 1.0f / 3.0f)); // not all are short in decimal
    material->setMetallic(0.9f);
    material->setRoughness(roughness);
    material->setClearcoat(0.3f);
    return material;
}

} // namespace

TEST_CASE("osgraytrace --write-materials: used as it is, the file changes no bit", "[apps]")
{
    const TemporaryFolder folder, models;
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("town");
    root->addChild(placed(0, "brick", nullptr));
    root->addChild(placed(1, "copper", metal(0.35f)));
    root->addChild(placed(2, "mixed", metal(0.2f)));
    root->addChild(placed(3, "mixed", metal(0.6f)));
    const osg::ref_ptr<osg::MatrixTransform> shed = placed(4, "", nullptr);
    shed->setName("shed \"old\"");
    root->addChild(shed);
    root->addChild(placed(5, "", nullptr)); // only below "town", which is above all others
    REQUIRE(osgDB::writeNodeFile(*root, models / "town.osgb"));
    const std::string town = "'" + (models / "town.osgb") + "'";
    const auto picture = [&](const std::string& name, const std::string& more)
    {
        const Outcome outcome = osgraytrace(
            folder, town + " --size 64 32 --passes 2 --integrator path -o " + name + more);
        CHECK(outcome.exitCode == 0);
        CHECK(outcome.errors == "");
        return contents(folder / name);
    };

    const Outcome written = osgraytrace(folder, town + " --write-materials m.json");
    CHECK(written.exitCode == 0);
    CHECK(written.output == "m.json: 4 entries\n");
    CHECK_THAT(written.errors, Contains("1 geometries are in no entry"));
    const auto file = nlohmann::json::parse(contents(folder / "m.json"));
    CHECK(file["materials"]["copper"]["clearcoat"] == 0.3);
    CHECK(file["materials"]["copper"]["baseColor"][1] == 0.7);
    CHECK(file["materials"]["brick"]["roughness"] == 1.0);
    CHECK(file["materials"]["mixed"] == nlohmann::json{{"edits", 1}});
    CHECK(file["nodes"].size() == 1);
    CHECK(file["nodes"].contains("shed \"old\""));

    const std::string plain = picture("plain.exr", "");
    CHECK(picture("unedited.exr", " --materials m.json") == plain);
    for (const char* name : {"brick", "copper", "mixed", "shed \"old\""})
    {
        auto edited = file;
        auto& group = edited[name[0] == 's' ? "nodes" : "materials"];
        group[name]["baseColor"] = {0.2, 0.9, 0.1};
        std::ofstream(folder / "edited.json") << edited;
        CAPTURE(name);
        CHECK(picture("edited.exr", " --materials edited.json") != plain);
    }
    CHECK(osgraytrace(folder, town + " --write-materials no/such/folder/m.json").exitCode == 4);

    const TemporaryFolder empty;
    for (const char* other : {"--names", "-o a.png", "--report", "--stats s.json"})
    {
        const Outcome refused =
            osgraytrace(empty, town + " --write-materials m.json " + std::string(other));
        CAPTURE(other);
        CHECK(refused.exitCode == 1);
        CHECK_THAT(refused.errors,
                   Contains("--write-materials excludes " +
                            std::string(other).substr(0, std::string(other).find(' '))));
    }
    CHECK(empty.fileNames().empty());
}
