// ConversionReportTest.cpp - what the user is told: counts, node paths, and each reason once.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"
#include "tests/bridge/Messages.h"

#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <osgRayTrace/EnvironmentLight>
#include <osgRayTrace/Statistics>

#include <osg/Fog>
#include <osg/LightSource>
#include <osgText/Text>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using Strings = std::vector<std::string>;

namespace
{

osg::ref_ptr<osg::Geometry> named(const std::string& name)
{
    osg::ref_ptr<osg::Geometry> geometry = triangleGeometry();
    geometry->setName(name);
    return geometry;
}

osg::ref_ptr<osg::Group> town()
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("town");
    return root;
}

Strings pathsOf(const ConversionResult& result, const std::string& what)
{
    const auto found = result.paths.find(what);
    return found == result.paths.end() ? Strings() : found->second;
}

} // namespace

TEST_CASE("conversion report: paths of the first four, each once", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = town();
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setFogCoordinateSource(osg::Fog::FOG_COORDINATE);
    root->getOrCreateStateSet()->setAttributeAndModes(fog);
    for (const char* name : {"a", "b", "b", "c", "d", "e", "f"})
        root->addChild(named(name));
    const ConversionResult result = convertGraph(root);
    const Strings first{"town/a", "town/b", "town/c", "town/d"};
    CHECK(countOf(result, "approximated.fog-coordinate") == 7); // by the materials' conversion
    CHECK(pathsOf(result, "approximated.fog-coordinate") == first);
    CHECK(countOf(result, "converted.geometry") == 7);
    CHECK(pathsOf(result, "converted.geometry") == first);
}

TEST_CASE("conversion report: bad geometry and bad nodes are found by their paths", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = town();
    const auto broken = named("broken");
    const GLuint beyond[] = {0, 1, 77};
    broken->setPrimitiveSet(0, new osg::DrawElementsUInt(GL_TRIANGLES, 3, beyond));
    root->addChild(broken);
    osg::ref_ptr<osg::MatrixTransform> flat = new osg::MatrixTransform;
    flat->setName("flat");
    flat->setMatrix(osg::Matrixd::scale(1.0, 0.0, 0.0));
    flat->addChild(named("below"));
    root->addChild(flat);
    osg::ref_ptr<osgText::Text> sign = new osgText::Text;
    sign->setName("sign");
    root->addChild(sign);
    osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
    lamp->setName("lamp");
    lamp->getLight()->setPosition(osg::Vec4(NAN, 0.0f, 0.0f, 1.0f));
    root->addChild(lamp);

    SceneConverter converter;
    for (int again = 0; again < 2; ++again) // the second result is from the cache
    {
        const ConversionResult result = converter.convert(inputFor(root));
        CHECK(pathsOf(result, "skipped.index-out-of-range") == Strings{"town/broken"});
        CHECK(pathsOf(result, "skipped.singular-transform") == Strings{"town/flat"});
        CHECK(pathsOf(result, "not-traced.text") == Strings{"town/sign"});
        CHECK(pathsOf(result, "skipped.light") == Strings{"light 'town/lamp'"});
    }
}

TEST_CASE("conversion report: each reason is named once, with its first object", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = town();
    for (const char* name : {"drawn", "alike"})
    {
        const auto geometry = named(name);
        geometry->setDrawCallback(new osg::Drawable::DrawCallback);
        root->addChild(geometry);
    }
    osg::ref_ptr<osgText::Text> sign = new osgText::Text;
    sign->setName("sign");
    root->addChild(sign);

    const test::Messages messages;
    SceneConverter converter;
    ConversionInput input = inputFor(root);
    input.rasterizesRest = true; // OSG goes on drawing the sign
    converter.convert(input);
    root->addChild(named("another"));
    converter.convert(input);
    CHECK(messages.timesSaid("draw-callback") == 1);
    CHECK(messages.timesSaid("approximated.draw-callback: 2, the first is 'town/drawn'") == 1);
    CHECK(messages.timesSaid("sign") == 0);
    CHECK(messages.timesSaid("converted") == 0);
}

TEST_CASE("conversion report: the log has two lines for a reason, however many objects there are",
          "[bridge]")
{
    forgetKindsOfWarnings();
    osg::ref_ptr<osg::Group> root = town();
    for (int i = 0; i < 100; ++i)
    {
        const auto broken = named("broken" + std::to_string(i));
        const GLuint beyond[] = {0, 1, 77};
        broken->setPrimitiveSet(0, new osg::DrawElementsUInt(GL_TRIANGLES, 3, beyond));
        root->addChild(broken);
        osg::ref_ptr<osg::MatrixTransform> flat = new osg::MatrixTransform;
        flat->setName("flat" + std::to_string(i));
        flat->setMatrix(osg::Matrixd::scale(1.0, 0.0, 0.0));
        root->addChild(flat);
    }
    const test::Messages messages;
    SceneConverter converter;
    const ConversionResult result = converter.convert(inputFor(root));
    CHECK(countOf(result, "skipped.index-out-of-range") == 100);
    CHECK(countOf(result, "skipped.singular-transform") == 100);
    root->addChild(named("another")); // a later conversion says nothing new
    converter.convert(inputFor(root));
    CHECK(messages.timesSaid("\n") == 4);
    CHECK(messages.timesSaid("town/broken0'") == 1);
    CHECK(messages.timesSaid("town/flat0'") == 1);
    CHECK(messages.timesSaid("skipped.index-out-of-range: there are more") == 1);
    CHECK(messages.timesSaid("skipped.singular-transform: there are more") == 1);
}

// A reason whose first object has a line needs no line of its own.
TEST_CASE("conversion report: what is named by its object is not named again", "[bridge]")
{
    forgetKindsOfWarnings();
    osg::ref_ptr<osg::Group> root = town();
    root->addChild(new EnvironmentLight); // this light has no image
    root->addChild(new osg::MatrixTransform(osg::Matrix::scale(0.0, 0.0, 1.0)));
    root->getChild(1)->setName("squashed");
    const test::Messages messages;
    const ConversionResult result = convertGraph(root);
    CHECK(countOf(result, "skipped.environment-light") == 1);
    CHECK(countOf(result, "skipped.singular-transform") == 1);
    CHECK(messages.timesSaid("environment light 'town/EnvironmentLight'") == 1);
    CHECK(messages.timesSaid("transform 'town/squashed'") == 1);
    CHECK(messages.timesSaid("skipped.environment-light") == 0);
    CHECK(messages.timesSaid("skipped.singular-transform") == 0);
}

TEST_CASE("conversion report: as text", "[bridge]")
{
    Statistics statistics;
    CHECK(conversionReport(statistics) == "Nothing was converted.\n");
    statistics.conversion = {{"approximated.fog-coordinate", 12},
                             {"converted.geometry", 3},
                             {"converted.light", 0},
                             {"instance.invalid-transform", 1},
                             {"skipped.not-finite", 1234567}};
    statistics.conversionPaths = {{"approximated.fog-coordinate", {"town/a", "town/b"}}};
    CHECK(conversionReport(statistics) == "Ray traced:\n"
                                          "         3  geometry\n"
                                          "Ray traced, but not with all that OpenGL does:\n"
                                          "        12  fog coordinate\n"
                                          "              town/a\n"
                                          "              town/b\n"
                                          "Bad data, left out:\n"
                                          "   1234567  not finite\n"
                                          "Other:\n"
                                          "         1  instance.invalid transform\n");
    statistics.conversion = {{"converted.geometry", 3}};
    statistics.conversions = 2;
    statistics.lastConversionReason = "a light came";
    statistics.lastConversionPath = "town/lamp";
    CHECK(conversionReport(statistics) ==
          "Ray traced:\n"
          "         3  geometry\n"
          "Converted as a whole 2 times, for the last time because:\n"
          "            a light came\n"
          "              town/lamp\n");
}
