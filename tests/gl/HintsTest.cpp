// HintsTest.cpp - users decide what is ray traced and what is rasterized. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"
#include "tests/plugins/TemporaryFolder.h"

#include <osg/MatrixTransform>
#include <osg/Program>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgText/Text>

#include <fstream>
#include <sstream>

using namespace osgRayTrace;
using namespace osgRayTrace::test;
using Catch::Matchers::Contains;

namespace
{

constexpr int kSize = 128;

osg::ref_ptr<osg::MatrixTransform> at(float x, osg::Node* node)
{
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(osg::Matrix::translate(x, 0.0, 0.0));
    transform->addChild(node);
    return transform;
}

/// Adds a shader that draws the node green. Ray traced, the ball below the node is red.
void addShader(osg::Node& node)
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                       "void main() { gl_FragColor = vec4(0.0, 1.0, 0.0, 1.0); }"));
    node.getOrCreateStateSet()->setAttributeAndModes(program.get());
}

/// Holds two red balls below one group, with the green shader.
struct Balls
{
    Balls() : group(new osg::Group)
    {
        const osg::Vec4 red(1.0f, 0.0f, 0.0f, 1.0f);
        left = at(-1.5f, sphere(osg::Vec3(), 1.0f, red).get());
        right = at(1.5f, sphere(osg::Vec3(), 1.0f, red).get());
        group->addChild(left.get());
        group->addChild(right.get());
        addShader(*group);
    }

    osg::ref_ptr<osg::Group> group;
    osg::ref_ptr<osg::MatrixTransform> left, right;
};

struct Shown
{
    osg::ref_ptr<osg::Image> image;

    /// Returns 'r' if the ball is ray traced, 'g' if the shader drew it, '-' if it is not visible.
    char at(double x) const
    {
        const int column = static_cast<int>(kSize * (0.5 + 0.5 * x / 3.64)); // 40 degrees, from 10
        const osg::Vec4 color = pixel(*image, column, kSize / 2);
        return color.g() > 100.0f ? 'g' : color.r() > 100.0f ? 'r' : '-';
    }
    std::string balls() const { return {at(-1.5), at(1.5)}; }
};

struct Traced
{
    explicit Traced(osg::Node* content)
        : scene(tracedScene(content)), viewer(kSize, kSize, scene.get())
    {
    }
    Shown show() { return {viewer.frames(1)}; }
    uint64_t count(const std::string& what)
    {
        return scene->getDrawable()->getStatistics().conversion[what];
    }

    osg::ref_ptr<RayTracedScene> scene;
    TestViewer viewer;
};

} // namespace

TEST_CASE("hints: nothing is traced for a view that shows only what OSG draws", "[gl][hint]")
{
    const Balls balls; // their shader leaves them to OSG, and they have proxies
    Traced traced(balls.group.get());
    RayTraceSettings& settings = *traced.scene->getSettings();
    const auto statistics = [&] { return traced.scene->getDrawable()->getStatistics(); };
    settings.setFrameBudget(33.0f);
    CHECK(traced.show().balls() == "gg");
    CHECK(traced.count("traced.proxy") == 2);
    CHECK(statistics().cameraRays == 0);
    CHECK(statistics().passes == settings.getMaxPasses());
    CHECK(statistics().ok);

    RayTracedScene::setHint(balls.left.get(), RayTracedScene::TRACE);
    CHECK(traced.show().balls() == "rg");
    CHECK(statistics().cameraRays > 0);

    RayTracedScene::setHint(balls.left.get(), RayTracedScene::AUTOMATIC);
    CHECK(traced.show().balls() == "gg");
    settings.setFrameBudget(0.0f); // a picture is wanted, however long it takes
    CHECK(traced.show().balls() == "gg");
    CHECK(statistics().cameraRays > 0);
}

TEST_CASE("hints: a node and what is below it, the nearest counts", "[gl]")
{
    Balls balls;
    Traced traced(balls.group.get());
    CHECK(traced.show().balls() == "gg"); // OpenGL draws what has shaders
    CHECK(traced.count("rasterized.shader-program") == 2);

    RayTracedScene::setHint(balls.group.get(), RayTracedScene::TRACE);
    CHECK(traced.show().balls() == "rr"); // the next frame has the hint
    CHECK(traced.count("approximated.shader") == 2);
    CHECK(traced.count("rasterized.shader-program") == 0);

    RayTracedScene::setHint(balls.left.get(), RayTracedScene::RASTERIZE);
    CHECK(traced.show().balls() == "gr");
    CHECK(traced.count("rasterized.hint") == 1);

    RayTracedScene::setHint(balls.left->getChild(0), RayTracedScene::TRACE);
    CHECK(traced.show().balls() == "rr");

    RayTracedScene::setHint(balls.left->getChild(0), RayTracedScene::AUTOMATIC);
    RayTracedScene::setHint(balls.right.get(), RayTracedScene::RASTERIZE);
    CHECK(traced.show().balls() == "gg");
    CHECK(traced.count("rasterized.hint") == 1);
    CHECK(traced.count("rasterized.shader-program") == 1);
    CHECK(RayTracedScene::getHint(balls.right.get()) == RayTracedScene::RASTERIZE);
    CHECK(RayTracedScene::getHint(balls.left->getChild(0)) == RayTracedScene::AUTOMATIC);
    CHECK(balls.group->getNumDescriptions() == 1);
}

TEST_CASE("hints: a rule of the material file has what a shader draws traced, in its colour",
          "[gl]")
{
    const TemporaryFolder folder;
    std::ofstream(folder / "m.json") << R"({ "shaders": [ { "name": "paint",
        "if": { "uniform": "paint" }, "baseColor": { "uniform": "paint" } } ] })";
    Balls balls;
    osg::ref_ptr<osg::Uniform> paint = new osg::Uniform("paint", osg::Vec3(1.0f, 0.0f, 0.0f));
    balls.left->getOrCreateStateSet()->addUniform(paint);
    Traced traced(balls.group.get());
    CHECK(traced.show().balls() == "gg");
    traced.scene->getSettings()->setMaterials(folder / "m.json");
    CHECK(traced.show().balls() == "rg");
    CHECK(traced.count("traced.by-rule") == 1);
    CHECK(traced.count("rasterized.shader-program") == 1);
    paint->set(osg::Vec3(0.0f, 1.0f, 0.0f)); // it is lit, unlike what the shader draws
    const Shown green = traced.show();
    CHECK(green.balls() == "gg");
    CHECK(traced.count("traced.by-rule") == 1);
    RayTracedScene::setHint(balls.left.get(), RayTracedScene::RASTERIZE);
    CHECK(meanDifference(*traced.show().image, *green.image) > 1.0);
    CHECK(traced.count("rasterized.hint") == 1);
}

// Both kinds of parts composite: a part with the hint to be rasterized hides and is hidden as
// before.
TEST_CASE("hints: rasterized parts look as in the rasterizer", "[gl]")
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(sphere(osg::Vec3(-0.6f, 0.0f, 0.0f), 1.2f, osg::Vec4(1, 0, 0, 1)));
    osg::ref_ptr<osg::Node> other =
        sphere(osg::Vec3(0.7f, 0.2f, 0.3f), 1.2f, osg::Vec4(0, 0, 1, 1));
    group->addChild(other.get());

    Traced rasterized(group.get());
    rasterized.scene->setEnabled(false);
    const osg::ref_ptr<osg::Image> wanted = rasterized.show().image;
    RayTracedScene::setHint(other.get(), RayTracedScene::RASTERIZE);
    Traced traced(group.get());
    const osg::ref_ptr<osg::Image> image = traced.show().image;
    CHECK(traced.count("rasterized.hint") == 1);
    CHECK(traced.count("converted.geometry") == 1);
    const auto isBlue = [&](int x, int y) { return pixel(*wanted, x, y).b() > 100.0f; };
    const auto isRed = [&](int x, int y) { return pixel(*wanted, x, y).r() > 100.0f; };
    CHECK(meanDifference(*image, *wanted, isBlue) < 0.5); // only the edges between parts differ
    CHECK(meanDifference(*image, *wanted, isRed) < 3.0);
}

TEST_CASE("hints: what cannot be traced is reported", "[gl]")
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->setName("signs");
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setText("TEXT");
    text->setName("label");
    group->addChild(text.get());
    osg::ref_ptr<osg::Geometry> lines = unlitSquare(1.0f, osg::Vec4(1, 1, 1, 1));
    lines->setPrimitiveSet(0, new osg::DrawArrays(GL_LINE_LOOP, 0, 4));
    group->addChild(lines.get());
    group->addChild(new osg::Camera);
    static_cast<osg::Camera*>(group->getChild(2))->setRenderOrder(osg::Camera::POST_RENDER);

    Traced traced(group.get());
    traced.show();
    CHECK(traced.count("warned.trace-hint") == 0);
    RayTracedScene::setHint(group.get(), RayTracedScene::TRACE);
    traced.show();
    CHECK(traced.count("warned.trace-hint") == 3);
    const std::string report = traced.scene->getConversionReport();
    CHECK_THAT(report, Contains("3  trace hint"));
    CHECK_THAT(report, Contains("signs/label\n"));
    CHECK_THAT(report, Contains("signs/Camera\n"));
}

TEST_CASE("hints: files carry them", "[gl]")
{
    Balls balls;
    RayTracedScene::setHint(balls.right.get(), RayTracedScene::TRACE);
    for (const char* extension : {"osgt", "osgb"})
    {
        osgDB::ReaderWriter* format =
            osgDB::Registry::instance()->getReaderWriterForExtension(extension);
        REQUIRE(format);
        std::stringstream stream;
        REQUIRE(format->writeNode(*balls.group, stream).success());
        const osg::ref_ptr<osg::Node> read = format->readNode(stream).takeNode();
        REQUIRE(read);
        CHECK(Traced(read.get()).show().balls() == "gr");
    }
}
