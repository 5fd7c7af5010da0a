// OpacityMatchTest.cpp - blending, alpha test, culled faces and polygon offset look as OpenGL draws
// them.
// SPDX-License-Identifier: MIT
#include "StateScenes.h"

#include <osg/AlphaFunc>
#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/FrontFace>
#include <osg/PolygonOffset>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

osg::ref_ptr<osg::Geometry> pane(const osg::Vec4& color, float half, float z)
{
    const auto geometry = unlit(square(half, color, 1.0f, z));
    osg::StateSet& state = *geometry->getStateSet();
    state.setMode(GL_BLEND, kOn);
    state.setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    return geometry;
}

osg::ref_ptr<osg::Geometry> floorSquare()
{
    return unlit(square(3.2f, osg::Vec4(0.9f, 0.8f, 0.2f, 1.0f), 1.0f, -1.0f));
}

/// Returns a box without a lid, into which the eye looks: its inner faces are back faces.
osg::ref_ptr<osg::Node> box()
{
    osg::ref_ptr<osg::ShapeDrawable> shape =
        new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 3.0f));
    shape->setColor(osg::Vec4(0.8f, 0.5f, 0.3f, 1.0f));
    return placed(osg::Matrixd::rotate(0.6, osg::Vec3d(1, 1, 0.3)), shape);
}

} // namespace

TEST_CASE("match: straight alpha, several panes over each other and over the background",
          "[gl][coverage]")
{
    const auto root = groupOf({floorSquare(), pane({0.1f, 0.2f, 0.9f, 0.5f}, 3.0f, 0.0f),
                               pane({0.9f, 0.1f, 0.1f, 0.3f}, 2.0f, 0.5f),
                               pane({0.0f, 0.9f, 0.1f, 0.8f}, 1.0f, 1.0f)});
    CHECK(matches("blend-panes", root));
    CHECK(matches("blend-over-background", groupOf({pane({0.1f, 0.2f, 0.9f, 0.5f}, 3.0f, 0.0f)})));
}

TEST_CASE("match: alpha of the vertices and of the texture", "[gl][coverage]")
{
    const auto front = pane({1, 1, 1, 0.8f}, 3.0f, 0.5f);
    const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (const float alpha : {0.0f, 0.3f, 0.7f, 1.0f})
        colors->push_back(osg::Vec4(0.9f, 0.2f, 0.5f, alpha));
    front->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    CHECK(matches("blend-vertices", groupOf({floorSquare(), front})));
    front->getStateSet()->setTextureAttributeAndModes(0, textureOf(patchwork(8)));
    CHECK(matches("blend-texture", groupOf({floorSquare(), front})));
}

TEST_CASE("match: all functions of the alpha test", "[gl][coverage]")
{
    const std::pair<const char*, osg::AlphaFunc::ComparisonFunction> functions[] = {
        {"never", osg::AlphaFunc::NEVER},     {"less", osg::AlphaFunc::LESS},
        {"equal", osg::AlphaFunc::EQUAL},     {"lequal", osg::AlphaFunc::LEQUAL},
        {"greater", osg::AlphaFunc::GREATER}, {"notequal", osg::AlphaFunc::NOTEQUAL},
        {"gequal", osg::AlphaFunc::GEQUAL},   {"always", osg::AlphaFunc::ALWAYS}};
    for (const auto& [name, function] : functions)
    {
        const auto front = unlit(square(3.0f, {1, 1, 1, 1}, 1.0f, 0.5f));
        osg::StateSet& state = *front->getStateSet();
        state.setTextureAttributeAndModes(
            0, textureOf(patchwork(8), osg::Texture::REPEAT, osg::Texture::NEAREST));
        // The reference 1 is a value that the texture has.
        const float reference =
            function == osg::AlphaFunc::EQUAL || function == osg::AlphaFunc::NOTEQUAL ||
                    function == osg::AlphaFunc::LEQUAL || function == osg::AlphaFunc::GEQUAL
                ? 1.0f
                : 0.5f;
        state.setAttributeAndModes(new osg::AlphaFunc(function, reference));
        CHECK(matches(std::string("alpha-test-") + name, groupOf({floorSquare(), front})));
    }
}

TEST_CASE("match: culled faces, turned winding and mirrored transforms", "[gl][coverage]")
{
    struct Case
    {
        const char* name;
        osg::CullFace::Mode cull;
        osg::FrontFace::Mode front;
        double mirror;
    };
    const Case cases[] = {
        {"back", osg::CullFace::BACK, osg::FrontFace::COUNTER_CLOCKWISE, 1.0},
        {"front", osg::CullFace::FRONT, osg::FrontFace::COUNTER_CLOCKWISE, 1.0},
        {"back-clockwise", osg::CullFace::BACK, osg::FrontFace::CLOCKWISE, 1.0},
        {"back-mirrored", osg::CullFace::BACK, osg::FrontFace::COUNTER_CLOCKWISE, -1.0},
        {"front-clockwise-mirrored", osg::CullFace::FRONT, osg::FrontFace::CLOCKWISE, -1.0}};
    for (const Case& c : cases)
        for (const bool shared : {false, true})
        {
            const osg::ref_ptr<osg::Node> thing = box();
            osg::StateSet& state = *thing->getOrCreateStateSet();
            state.setAttributeAndModes(new osg::CullFace(c.cull));
            state.setAttribute(new osg::FrontFace(c.front));
            const auto matrix = osg::Matrixd::scale(c.mirror, 1.0, 1.0);
            auto root = groupOf({placed(matrix, thing)});
            if (shared) // instances of one mesh are handled in another way than a mesh of its own
                root->addChild(placed(matrix * osg::Matrixd::translate(2.0, 1.0, -3.0), thing));
            CHECK(matches(std::string("cull-") + c.name + (shared ? "-shared" : ""), root));
        }
    const auto sides = box();
    sides->getOrCreateStateSet()->setAttributeAndModes(
        new osg::CullFace(osg::CullFace::FRONT_AND_BACK));
    CHECK(matches("cull-both", groupOf({floorSquare(), sides})));
}

TEST_CASE("match: polygon offset puts decals before what they lie on", "[gl][coverage]")
{
    const auto decal = [](float half, const osg::Vec4& color, float units)
    {
        const auto geometry = unlit(square(half, color));
        if (units != 0.0f)
            geometry->getStateSet()->setAttributeAndModes(new osg::PolygonOffset(units, units));
        return geometry;
    };
    MatchSetup setup;
    setup.view = [](TestViewer& view) { view.look({3.0, 5.0, 6.0}); };
    // Without offsets, chance would decide whether the decal that is drawn last is visible; the
    // order of the graph is not that of the layers.
    const auto layers = groupOf({decal(1.0f, {0.1f, 0.1f, 0.9f, 1.0f}, -2.0f),
                                 decal(3.0f, {0.8f, 0.8f, 0.8f, 1.0f}, 0.0f),
                                 decal(2.0f, {0.9f, 0.1f, 0.1f, 1.0f}, -1.0f)});
    CHECK(matches("polygon-offset-front", layers, setup));
    const auto base = groupOf(
        {decal(2.0f, {0.9f, 0.1f, 0.1f, 1.0f}, 0.0f), decal(3.0f, {0.8f, 0.8f, 0.8f, 1.0f}, 1.0f)});
    CHECK(matches("polygon-offset-back", base, setup));
    // The geometry is shared, so that it becomes instances: one of its two uses has the offset.
    const auto shared = unlit(square(1.0f, {0.1f, 0.9f, 0.1f, 1.0f}));
    const auto raised = placed(osg::Matrixd::translate(1.0, 0.5, 0.0), shared);
    raised->getOrCreateStateSet()->setAttributeAndModes(new osg::PolygonOffset(-1.0f, -1.0f));
    CHECK(matches("polygon-offset-shared",
                  groupOf({decal(3.0f, {0.8f, 0.8f, 0.8f, 1.0f}, 0.0f), raised,
                           placed(osg::Matrixd::translate(-1.0, -0.5, 0.5), shared)}),
                  setup));
}
