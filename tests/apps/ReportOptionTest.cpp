// ReportOptionTest.cpp - osgraytrace --report as its users see it. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"

#include <nlohmann/json.hpp>

#include <osg/Geometry>
#include <osg/Group>
#include <osg/Image>
#include <osg/Material>
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
    root->getOrCreateStateSet()->setMode(GL_FOG, osg::StateAttribute::ON);
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
    CHECK_THAT(outcome.output, Contains("         1  fog\n              town/roof\n"));
    CHECK_THAT(outcome.output, Contains("not with all that OpenGL does:"));
    CHECK_THAT(outcome.output, Contains("              town/fence\n"));
    CHECK(folder.fileNames().empty());

    const Outcome stored = osgraytrace(folder, town + " --report --size 8 8 --stats s.json");
    CHECK(stored.exitCode == 0);
    const auto json = nlohmann::json::parse(contents(folder / "s.json"));
    CHECK(json["conversionPaths"]["approximated.fog"] == nlohmann::json{"town/roof"});
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
