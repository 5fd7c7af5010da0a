// RasterizedPartsTest.cpp - parts that are not ray traced stay where they were. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/BlendFunc>
#include <osg/ClipNode>
#include <osg/ColorMask>
#include <osg/LightSource>
#include <osg/LineWidth>
#include <osg/MatrixTransform>
#include <osg/Point>
#include <osg/PolygonMode>
#include <osg/PositionAttitudeTransform>
#include <osg/Program>
#include <osg/Stencil>
#include <osg/Texture2D>
#include <osgText/Text>

#include <atomic>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSize = 256;

osg::ref_ptr<osg::Geometry> strokes(GLenum mode, const osg::Vec4& color)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> points = new osg::Vec3Array;
    for (int i = 0; i < 12; ++i)
        points->push_back(osg::Vec3(std::cos(0.5f * i), std::sin(0.5f * i), 0.02f * i));
    geometry->setVertexArray(points.get());
    geometry->setColorArray(new osg::Vec4Array(1, &color), osg::Array::BIND_OVERALL);
    geometry->addPrimitiveSet(new osg::DrawArrays(mode, 0, 12));
    osg::StateSet* state = geometry->getOrCreateStateSet();
    state->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    state->setAttribute(new osg::LineWidth(3.0f));
    state->setAttribute(new osg::Point(6.0f));
    return geometry;
}

osg::ref_ptr<osgText::Text> label(const char* words)
{
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setCharacterSize(0.6f);
    text->setText(words);
    text->setColor(osg::Vec4(1.0f, 0.9f, 0.1f, 1.0f));
    text->setPosition(osg::Vec3(-1.2f, 0.2f, 0.3f));
    return text;
}

/// Returns a camera that draws into a corner of the window, whatever the view is.
osg::ref_ptr<osg::Camera> headUpDisplay()
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setProjectionMatrixAsOrtho2D(0, 4, 0, 4);
    camera->setViewMatrix(osg::Matrix::identity());
    camera->setClearMask(GL_DEPTH_BUFFER_BIT);
    camera->setRenderOrder(osg::Camera::POST_RENDER);
    camera->addChild(unlitSquare(1.0f, osg::Vec4(0.2f, 0.2f, 1.0f, 1.0f)));
    return camera;
}

/// Has no geometry that could be read: the drawable draws one of its own, and counts how often.
class CustomDrawable : public osg::Drawable
{
public:
    CustomDrawable() : _square(unlitSquare(0.5f, osg::Vec4(1.0f, 0.0f, 1.0f, 1.0f)))
    {
        setSupportsDisplayList(false);
        _square->setUseDisplayList(false);
    }
    CustomDrawable(const CustomDrawable& other, const osg::CopyOp& copyop)
        : osg::Drawable(other, copyop)
    {
    }
    META_Node(test, CustomDrawable)

    osg::BoundingBox computeBoundingBox() const override
    {
        return {-0.5f, -0.5f, 0.0f, 0.5f, 0.5f, 0.0f};
    }
    void drawImplementation(osg::RenderInfo& renderInfo) const override
    {
        ++draws;
        _square->drawImplementation(renderInfo);
    }

    mutable std::atomic<int> draws{0};

private:
    osg::ref_ptr<osg::Geometry> _square;
};

osg::ref_ptr<osg::MatrixTransform> at(const osg::Vec3& place, osg::Node* node)
{
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(osg::Matrix::translate(place));
    transform->addChild(node);
    return transform;
}

/// Returns the nodes in front of a traced wall; another traced square hides a part of each.
osg::ref_ptr<osg::Group> scene(const std::vector<osg::ref_ptr<osg::Node>>& nodes)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(unlitSquare(2.5f, osg::Vec4(0.1f, 0.5f, 0.2f, 1.0f)));
    group->addChild(at(osg::Vec3(0.6f, 0.0f, 0.15f),
                       unlitSquare(0.5f, osg::Vec4(0.6f, 0.6f, 0.6f, 1.0f)).get()));
    for (const auto& node : nodes)
        group->addChild(node.get());
    return group;
}

osg::ref_ptr<osg::Image> picture(osg::Node* content, bool enabled)
{
    osg::ref_ptr<RayTracedScene> traced = tracedScene(content);
    traced->setEnabled(enabled);
    TestViewer viewer(kSize, kSize, traced.get());
    viewer.look(osg::Vec3d(1.0, -2.0, 8.0));
    return viewer.frames(2);
}

/// Holds mean differences, 0 to 255, over the pixels that the nodes change in the rasterized
/// picture.
struct Compared
{
    double difference; ///< of the ray traced picture from the rasterized one
    double shown;      ///< of the rasterized picture from the one without the nodes
    long pixels;
    long others; ///< pixels that the nodes change in the ray traced picture alone
};

Compared compare(const std::vector<osg::ref_ptr<osg::Node>>& nodes)
{
    const osg::ref_ptr<osg::Group> with = scene(nodes), without = scene({});
    const auto rasterized = picture(with.get(), false), bare = picture(without.get(), false);
    const auto traced = picture(with.get(), true), bareTraced = picture(without.get(), true);
    Compared compared = {0.0, 0.0, 0, 0};
    const auto changed = [&](int x, int y)
    { return pixel(*rasterized, x, y) != pixel(*bare, x, y); };
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
        {
            const bool inTraced = pixel(*traced, x, y) != pixel(*bareTraced, x, y);
            compared.pixels += changed(x, y) ? 1 : 0;
            compared.others += inTraced && !changed(x, y) ? 1 : 0;
        }
    compared.difference = meanDifference(*traced, *rasterized, changed);
    compared.shown = meanDifference(*bare, *rasterized, changed);
    return compared;
}

void checkSame(const std::vector<osg::ref_ptr<osg::Node>>& nodes)
{
    const Compared compared = compare(nodes);
    CAPTURE(compared.difference, compared.shown, compared.pixels, compared.others);
    CHECK(compared.pixels > 200);
    CHECK(compared.others < 0.1 * compared.pixels); // edges of what is traced are smooth
    CHECK(compared.difference <
          0.02 * compared.shown); // where they cross the edge of what is traced
}

} // namespace

TEST_CASE("rasterized parts: text, lines and points", "[gl]")
{
    SECTION("text")
    {
        checkSame({at(osg::Vec3(0, 0.4f, 0), label("TEXT").get())});
    }
    SECTION("lines")
    {
        checkSame({at(osg::Vec3(0, 0, 0.1f), strokes(GL_LINES, osg::Vec4(1, 0, 0, 1)).get())});
    }
    SECTION("points")
    {
        checkSame({at(osg::Vec3(0, 0, 0.1f), strokes(GL_POINTS, osg::Vec4(1, 0, 0, 1)).get())});
    }
    SECTION("lines and triangles of one geometry")
    {
        osg::ref_ptr<osg::Geometry> both = strokes(GL_LINE_STRIP, osg::Vec4(1, 0.5f, 0, 1));
        both->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 6));
        checkSame({at(osg::Vec3(-1, 0.4f, 0.1f), both.get())});
    }
}

TEST_CASE("rasterized parts: cameras and drawables of others", "[gl]")
{
    SECTION("a head-up display")
    {
        checkSame({headUpDisplay()});
    }
    SECTION("a custom drawable")
    {
        osg::ref_ptr<CustomDrawable> drawable = new CustomDrawable;
        drawable->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        checkSame({at(osg::Vec3(0, 0, 0.3f), drawable.get())});
        CHECK(drawable->draws == 4);
    }
}

TEST_CASE("rasterized parts: state, transforms and masks on the way", "[gl]")
{
    osg::ref_ptr<osg::Geometry> lines = strokes(GL_LINE_LOOP, osg::Vec4(1, 1, 1, 1));
    osg::ref_ptr<osg::PositionAttitudeTransform> turned = new osg::PositionAttitudeTransform;
    turned->setAttitude(osg::Quat(0.5, osg::Vec3d(1, 0, 0)));
    turned->setScale(osg::Vec3d(1.5, 0.7, 1.0));
    turned->addChild(lines.get());
    SECTION("transforms below each other")
    {
        checkSame({at(osg::Vec3(0.2f, 0, 1), turned.get())});
    }
    SECTION("state of a parent overrides")
    {
        turned->getOrCreateStateSet()->setAttribute(new osg::LineWidth(9.0f),
                                                    osg::StateAttribute::OVERRIDE);
        checkSame({turned});
    }
    SECTION("masked out by a parent")
    {
        osg::ref_ptr<osg::Group> hidden = at(osg::Vec3(), turned.get());
        hidden->setNodeMask(0);
        CHECK(equal(*picture(scene({hidden}).get(), true), *picture(scene({}).get(), true)));
    }
}

TEST_CASE("rasterized parts: states that OpenGL draws", "[gl]")
{
    osg::ref_ptr<osg::Drawable> ball =
        sphere(osg::Vec3(-0.4f, 0.3f, 0.8f), 0.7f, osg::Vec4(0.9f, 0.4f, 0.1f, 1));
    osg::StateSet* state = ball->getOrCreateStateSet();
    SECTION("wire frame")
    {
        state->setAttribute(
            new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, osg::PolygonMode::LINE));
        checkSame({ball});
    }
    SECTION("additive blending, lit by a light in the graph")
    {
        state->setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE));
        state->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
        osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
        light->getLight()->setPosition(osg::Vec4(0, 0, 1, 1));
        light->getLight()->setDiffuse(osg::Vec4(1, 1, 1, 1));
        light->getLight()->setLightNum(2);
        osg::ref_ptr<osg::Group> lit = new osg::Group;
        lit->getOrCreateStateSet()->setMode(GL_LIGHT2, osg::StateAttribute::ON);
        lit->addChild(at(osg::Vec3(2, 2, 1), light.get()));
        lit->addChild(ball);
        checkSame({lit});
    }
    SECTION("a shader program")
    {
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(
            osg::Shader::FRAGMENT, "void main() { gl_FragColor = vec4(0.9, 0.1, 0.9, 1.0); }"));
        state->setAttributeAndModes(program.get());
        checkSame({ball});
    }
    SECTION("a colour mask")
    {
        state->setAttribute(new osg::ColorMask(true, false, true, true));
        checkSame({ball});
    }
    SECTION("a stencil that one writes and the other is cut out by, in bins of their own")
    {
        osg::ref_ptr<osg::Stencil> writes = new osg::Stencil;
        writes->setFunction(osg::Stencil::ALWAYS, 1, ~0u);
        writes->setOperation(osg::Stencil::KEEP, osg::Stencil::KEEP, osg::Stencil::REPLACE);
        state->setAttributeAndModes(writes.get());
        state->setAttribute(new osg::ColorMask(false, false, false, false));
        state->setRenderBinDetails(2, "RenderBin");
        osg::ref_ptr<osg::Stencil> cut = new osg::Stencil;
        cut->setFunction(osg::Stencil::EQUAL, 1, ~0u);
        const osg::ref_ptr<osg::Node> wall =
            at(osg::Vec3(0, 0, 1.6f), unlitSquare(1.5f, osg::Vec4(0.9f, 0.9f, 0.2f, 1.0f)).get());
        wall->getOrCreateStateSet()->setAttributeAndModes(cut.get());
        wall->getStateSet()->setRenderBinDetails(3, "RenderBin");
        checkSame({ball, wall});
    }
}

TEST_CASE("rasterized parts: a texture that a camera of the graph renders", "[gl]")
{
    const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(64, 64);
    texture->setInternalFormat(GL_RGBA);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setRenderOrder(osg::Camera::PRE_RENDER);
    camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    camera->attach(osg::Camera::COLOR_BUFFER, texture.get());
    camera->setViewport(0, 0, 64, 64);
    camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    camera->setProjectionMatrixAsOrtho2D(-1, 1, -1, 1);
    camera->setClearColor(osg::Vec4(0.9f, 0.2f, 0.2f, 1.0f));
    camera->addChild(unlitSquare(0.5f, osg::Vec4(0.2f, 0.9f, 0.9f, 1.0f)));
    const osg::ref_ptr<osg::Geometry> screen = osg::createTexturedQuadGeometry(
        osg::Vec3(-1.5f, -1.0f, 0.4f), osg::Vec3(2, 0, 0), osg::Vec3(0, 2, 0));
    screen->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture.get());
    screen->getStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    checkSame({camera, screen});
}

// Conversion keeps the nodes that OSG goes on drawing, and must not keep the decorator by them.
TEST_CASE("rasterized parts: the scene is freed with its owner", "[gl]")
{
    osg::observer_ptr<RayTracedScene> observed;
    {
        osg::ref_ptr<osg::Group> content = scene({headUpDisplay()});
        osg::ref_ptr<RayTracedScene> traced = tracedScene(content.get());
        observed = traced;
        TestViewer viewer(kSize, kSize, traced.get());
        viewer.frames(2);
    }
    CHECK_FALSE(observed.valid());
}

// An edited scene draws its present parts, and releases the others.
TEST_CASE("rasterized parts: added and removed while drawn", "[gl]")
{
    osg::ref_ptr<osg::Group> content = scene({});
    osg::ref_ptr<RayTracedScene> traced = tracedScene(content.get());
    TestViewer viewer(kSize, kSize, traced.get());
    const osg::ref_ptr<osg::Image> before = viewer.frames(2);

    osg::ref_ptr<osg::Node> lines =
        at(osg::Vec3(0, 0, 0.5f), strokes(GL_LINE_LOOP, osg::Vec4(1, 1, 1, 1)).get());
    content->addChild(lines.get());
    CHECK(meanDifference(*before, *viewer.frames(1)) > 0.5);
    content->removeChild(lines.get());
    CHECK(meanDifference(*before, *viewer.frames(1)) < 0.2); // edges go on being refined
    CHECK(lines->referenceCount() == 1);
}
