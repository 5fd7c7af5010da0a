// CaptureAtRestTest.cpp - captured subtrees at rest cost one cull traversal, and edits of them are
// seen in the next frame. Layer: tests.
// SPDX-License-Identifier: MIT
#include "CullNodes.h"
#include "CullView.h"
#include "tests/Catch.h"

#include <osg/Depth>

using namespace osgRayTrace;
using namespace osgRayTrace::test;
using namespace application;

namespace application
{

/// Counts the cull traversals that reach it.
class CountingGroup : public osg::Group
{
public:
    void traverse(osg::NodeVisitor& visitor) override
    {
        if (visitor.getVisitorType() == osg::NodeVisitor::CULL_VISITOR) ++culls;
        osg::Group::traverse(visitor);
    }
    int culls = 0;
};

} // namespace application

namespace
{

constexpr int kSettled = 4; ///< frames until everything has left the static BVH

/// Holds a square that is traced and one that OSG draws, below a callback that pushes one of two
/// state sets.
struct Captured
{
    explicit Captured(bool withShaded = true)
        : pusher(new StatePusher(unlitColor(kRed), unlitColor(kRed)))
    {
        above->addChild(group.get());
        group->setCullCallback(pusher.get());
        group->addChild(counting.get());
        counting->addChild(place.get());
        addProgram(*shaded);
        if (withShaded) counting->addChild(raised(shaded.get(), 0.9f));
    }

    const osg::ref_ptr<osg::Group> above = new osg::Group, group = new osg::Group;
    const osg::ref_ptr<CountingGroup> counting = new CountingGroup;
    const osg::ref_ptr<osg::Geometry> square = plainSquare(0.7f), shaded = plainSquare(0.4f);
    const osg::ref_ptr<osg::MatrixTransform> place = raised(square.get(), 0.5f);
    const osg::ref_ptr<StatePusher> pusher;
};

/// Returns the number of cull traversals in a frame after some at rest.
int cullsAtRest(Captured& content, View& view)
{
    view.viewer.frames(kSettled);
    const uint64_t conversions = view.conversions();
    const int before = content.counting->culls;
    view.viewer.frames(5);
    CHECK(view.conversions() == conversions);
    const int culls = content.counting->culls - before;
    CHECK(culls % 5 == 0);
    return culls / 5;
}

osg::Material& materialOf(osg::StateSet& stateSet)
{
    return static_cast<osg::Material&>(*stateSet.getAttribute(osg::StateAttribute::MATERIAL));
}

} // namespace

TEST_CASE("captures at rest: one cull traversal of what is traced, two of what OSG draws",
          "[gl][cull]")
{
    for (const bool withShaded : {false, true})
    {
        Captured content(withShaded);
        View view(content.above.get());
        CHECK(cullsAtRest(content, view) == (withShaded ? 2 : 1)); // state sets take turns
        content.pusher->states[1] = content.pusher->states[0];
        CHECK(cullsAtRest(content, view) == (withShaded ? 2 : 1));
        const int before = content.counting->culls;
        for (int frame = 1; frame <= 4; ++frame)
        {
            view.viewer.look(osg::Vec3d(1.0 - 0.1 * frame, -2.0, 8.0)); // places differ by rounding
            view.viewer.frames(1);
        }
        CHECK(content.counting->culls - before == 4 * (withShaded ? 2 : 1));
    }
}

TEST_CASE("captures at rest: uniforms that nobody reads are no change", "[gl][cull]")
{
    Captured content;
    for (osg::ref_ptr<osg::StateSet>& states : content.pusher->states)
    {
        states = new osg::StateSet(*content.pusher->states[0]); // the attributes are shared
        states->addUniform(new osg::Uniform("time", 0.0f));
    }
    View view(content.above.get());
    view.viewer.frames(kSettled);
    const uint64_t conversions = view.conversions();
    const int before = content.counting->culls;
    for (int frame = 0; frame < 6; ++frame)
    {
        content.pusher->states[frame % 2]->getUniform("time")->set(0.1f * float(frame));
        view.viewer.frames(1);
    }
    CHECK(view.conversions() == conversions);
    CHECK(content.counting->culls - before == 12);
}

TEST_CASE("captures at rest: an edit is seen in the next frame", "[gl][cull]")
{
    Captured content;
    View view(content.above.get());
    view.viewer.frames(kSettled);
    REQUIRE(view.count("converted.culled") == 1);
    uint64_t traced = 1;
    const auto recolour = [&](int turn)
    {
        materialOf(*content.pusher->states[turn])
            .setEmission(osg::Material::FRONT_AND_BACK, osg::Vec4(0.1f, 0.9f, 0.9f, 1.0f));
    };
    SECTION("values of the state that the callback pushes")
    {
        recolour(0);
        recolour(1);
    }
    SECTION("other state sets")
    {
        content.pusher->states[0] = content.pusher->states[1] = unlitColor(kBlue);
    }
    SECTION("a place")
    {
        content.place->setMatrix(osg::Matrix::translate(-0.5, 0.3, 0.6));
    }
    SECTION("a place, as the eye moves")
    {
        view.viewer.look(osg::Vec3d(0.5, -2.0, 8.0));
        view.viewer.frames(2);
        view.viewer.look(osg::Vec3d(0.4, -2.0, 8.0));
        content.place->setMatrix(osg::Matrix::translate(-0.5, 0.3, 0.6));
    }
    SECTION("vertices")
    {
        auto& vertices = static_cast<osg::Vec3Array&>(*content.square->getVertexArray());
        for (osg::Vec3& vertex : vertices)
            vertex += osg::Vec3(0.4f, 0.3f, 0.0f);
        vertices.dirty();
        content.square->dirtyBound();
    }
    SECTION("a program for what was traced")
    {
        addProgram(*content.square);
        traced = 0;
    }
    SECTION("a program in the state that the callback pushes")
    {
        for (osg::ref_ptr<osg::StateSet>& states : content.pusher->states)
            states->setAttributeAndModes(new osg::Program(static_cast<const osg::Program&>(
                *content.shaded->getStateSet()->getAttribute(osg::StateAttribute::PROGRAM))));
        traced = 0;
    }
    SECTION("a program above")
    {
        addProgram(*content.above);
        traced = 0;
    }
    SECTION("no program for what OSG drew")
    {
        content.shaded->setStateSet(nullptr);
        traced = 2;
    }
    SECTION("lines beside the triangles")
    {
        content.square->addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, 2));
        traced = 0;
    }
    SECTION("a hint")
    {
        RayTracedScene::setHint(content.square.get(), RayTracedScene::RASTERIZE);
        traced = 0;
    }
    SECTION("a drawable more")
    {
        content.counting->addChild(raised(plainSquare(0.2f).get(), 1.0f));
        traced = 2;
    }
    SECTION("a drawable less")
    {
        content.counting->removeChild(content.place.get());
        traced = 0;
    }
    checkPicture(view, {}, 1);
    CHECK(view.count("converted.culled") == traced);
}

TEST_CASE("cull content: what OSG alone draws of a node changes without conversions", "[gl][cull]")
{
    struct Sky : osg::Group // a class of the application's
    {
    };
    const osg::ref_ptr<osg::Geometry> square = unlitSquare(0.8f, kRed);
    const osg::ref_ptr<osg::MatrixTransform> place = raised(square.get(), 0.5f);
    addProgram(*place);
    place->getStateSet()->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0, 1, false));
    place->getStateSet()->setRenderBinDetails(11, "RenderBin"); // after what is traced
    const osg::ref_ptr<osg::Group> sky = new Sky;
    sky->addChild(place);
    const osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform;
    above->addChild(sky);
    View view(above.get());
    checkPicture(view);
    CHECK(view.count("traced.proxy") == 0);
    view.viewer.frames(2);
    const uint64_t conversions = view.conversions();
    for (int i = 1; i <= 4; ++i)
    {
        square->getColorArray()->dirty();
        (*static_cast<osg::Vec3Array*>(square->getVertexArray()))[0].x() -= 0.1f;
        square->getVertexArray()->dirty();
        square->dirtyBound();
        place->setMatrix(osg::Matrix::translate(0.1 * i, 0, 0.5));
        above->setMatrix(osg::Matrix::translate(0, 0.1 * i, 0));
        view.viewer.frames(1);
    }
    CHECK(view.conversions() == conversions);
    checkPicture(view);

    // What begins to hide others has a proxy, and what had no place gets one.
    place->getStateSet()->removeAttribute(osg::StateAttribute::DEPTH);
    view.viewer.frames(2);
    CHECK(view.count("traced.proxy") == 1);
    place->setStateSet(nullptr);
    view.viewer.frames(2);
    CHECK(view.count("rasterized.shader-program") == 0);
    above->setMatrix(osg::Matrix::scale(0, 0, 0));
    view.viewer.frames(2);
    CHECK(view.count("converted.instance") == 1);
    above->setMatrix(osg::Matrix::translate(0.2, 0.1, 0));
    checkPicture(view);
    CHECK(view.count("converted.instance") == 2);
}
