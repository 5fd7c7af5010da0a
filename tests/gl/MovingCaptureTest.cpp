// MovingCaptureTest.cpp - what moves in captured subtrees is redone alone. Layer: tests.
// SPDX-License-Identifier: MIT
#include "CullNodes.h"
#include "CullView.h"
#include "tests/Catch.h"

#include <osg/LOD>
#include <osg/LightSource>

using namespace osgRayTrace;
using namespace osgRayTrace::test;
using namespace application;

namespace application
{

/// Is of a class that nobody knows.
class OwnGroup : public osg::Group
{
};

} // namespace application

namespace
{

constexpr int kSettled = 4; ///< frames until everything has left the static BVH
constexpr int kMoving = 6;  ///< frames in which something moves

/// Returns a group below which a callback pushes a colour.
osg::ref_ptr<osg::Group> colored(osg::Node* node, const osg::Vec4& color)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->setCullCallback(new StatePusher(unlitColor(color), unlitColor(color)));
    group->addChild(node);
    return group;
}

/// Moves things in each frame, and checks that they are redone alone and are shown where they are.
template <class Move> void checkMoves(View& view, const Move& move, uint64_t culled)
{
    int step = 0;
    for (int frame = 0; frame < kSettled; ++frame)
    {
        move(++step);
        view.viewer.frames(1);
    }
    const Statistics before = view.scene->getDrawable()->getStatistics();
    for (int frame = 0; frame < kMoving; ++frame)
    {
        move(++step);
        view.viewer.frames(1);
    }
    const Statistics after = view.scene->getDrawable()->getStatistics();
    CAPTURE(after.lastConversionReason, after.lastConversionPath);
    CHECK(after.conversions == before.conversions);
    CHECK(after.patches == before.patches + kMoving);
    CHECK(after.convertedMeshes <= before.convertedMeshes + culled * kMoving);
    CHECK(view.count("converted.culled") == culled);
    checkPicture(view);
}

} // namespace

TEST_CASE("moving captures: a rig below a callback", "[gl][cull]")
{
    const osg::ref_ptr<RigDrawable> rig = new RigDrawable(*plainSquare(0.7f));
    const osg::ref_ptr<osg::MatrixTransform> place = raised(rig.get(), 0.5f);
    View view(colored(place.get(), kRed).get());
    SECTION("is converted once at rest")
    {
        view.viewer.frames(3);
        CHECK(view.count("converted.culled") == 1);
        const uint64_t conversions = view.conversions();
        view.viewer.frames(5);
        CHECK(view.conversions() == conversions);
    }
    SECTION("bends")
    {
        checkMoves(
            view, [&](int step) { rig->bend(osg::Vec3(0.05f * float(step), 0.1f, 0.02f)); }, 1);
    }
    SECTION("walks")
    {
        checkMoves(
            view,
            [&](int step)
            { place->setMatrix(osg::Matrix::translate(0.05 * step, 0.02 * step, 0.5)); },
            1);
    }
    SECTION("bends and walks")
    {
        checkMoves(
            view,
            [&](int step)
            {
                rig->bend(osg::Vec3(0.05f * float(step), 0.1f, 0.02f));
                place->setMatrix(osg::Matrix::translate(-0.05 * step, 0.02 * step, 0.5));
            },
            1);
    }
    SECTION("bends and walks below nodes of the application's classes")
    {
        const osg::ref_ptr<osg::Group> own = new OwnGroup, inner = new OwnGroup;
        own->setCullCallback(new StatePusher(unlitColor(kBlue), unlitColor(kBlue)));
        own->addChild(place.get());
        inner->addChild(place.get());
        const osg::ref_ptr<osg::MatrixTransform> around = raised(own.get(), 0.1f);
        View other(around.get());
        other.root->addChild(raised(colored(inner.get(), kRed).get(), 0.3f));
        checkMoves(
            other,
            [&](int step)
            {
                rig->bend(osg::Vec3(0.03f * float(step), 0.1f, 0.02f));
                place->setMatrix(osg::Matrix::translate(-0.05 * step, 0.02 * step, 0.5));
                around->setMatrix(osg::Matrix::translate(0.0, 0.02 * step, 0.1));
            },
            2);
    }
    SECTION("walks with a light in a group of the application's class")
    {
        const osg::ref_ptr<osg::Group> own = new OwnGroup;
        own->setCullCallback(new StatePusher(unlitColor(kRed), unlitColor(kRed)));
        own->addChild(place.get());
        const osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
        own->addChild(lamp.get());
        View other(own.get());
        other.viewer.frames(2);
        const uint64_t conversions = other.conversions();
        lamp->getLight()->setDiffuse(kBlue);
        other.viewer.frames(1);
        CHECK(other.conversions() == conversions + 1); // only a conversion reads the light again
    }
    SECTION("has other colours")
    {
        view.viewer.frames(3);
        const uint64_t conversions = view.conversions();
        for (unsigned int frame : {0u, 1u})
        {
            osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array(osg::Array::BIND_OVERALL, 1);
            color->front() = kBlue;
            rig->pose(frame).setColorArray(color.get());
        }
        view.viewer.frames(1);
        CHECK(view.conversions() == conversions); // the mesh is made again
        checkPicture(view);
    }
}

TEST_CASE("moving captures: a rig of no group", "[gl][cull]")
{
    const osg::ref_ptr<RigDrawable> rig = new RigDrawable(*unlitSquare(0.7f, kRed));
    const osg::ref_ptr<osg::MatrixTransform> place = raised(rig.get(), 0.5f);
    View view(place.get());
    checkMoves(
        view,
        [&](int step)
        {
            rig->bend(osg::Vec3(0.05f * float(step), 0.1f, 0.02f));
            place->setMatrix(osg::Matrix::translate(-0.05 * step, 0.02 * step, 0.5));
        },
        1);
}

TEST_CASE("moving captures: geometries of nodes below a callback", "[gl][cull]")
{
    const osg::ref_ptr<osg::Geometry> square = plainSquare(0.4f);
    const osg::ref_ptr<osg::MatrixTransform> left = raised(square.get(), 0.5f),
                                             right = raised(square.get(), 0.5f);
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(left.get());
    both->addChild(right.get());
    View view(colored(both.get(), kRed).get());
    const auto move = [&](int step)
    {
        left->setMatrix(osg::Matrix::translate(-0.5, 0.05 * step, 0.5));
        right->setMatrix(osg::Matrix::translate(0.5, -0.04 * step, 0.4));
    };
    SECTION("on two paths, move")
    {
        checkMoves(view, move, 2);
    }
    SECTION("on two paths, move and are bent")
    {
        auto& vertices = static_cast<osg::Vec3Array&>(*square->getVertexArray());
        checkMoves(
            view,
            [&](int step)
            {
                move(step);
                vertices.front().x() -= 0.02f;
                vertices.dirty();
                square->dirtyBound();
            },
            2);
    }
    SECTION("and a rig that is on a path of its own, too")
    {
        const osg::ref_ptr<RigDrawable> rig = new RigDrawable(*unlitSquare(0.3f, kBlue));
        both->addChild(rig.get());
        view.root->addChild(raised(rig.get(), 0.9f));
        checkMoves(
            view,
            [&](int step)
            {
                move(step);
                rig->bend(osg::Vec3(0.0f, 0.03f * float(step), 0.0f));
            },
            4);
    }
}

TEST_CASE("moving captures: a rig beside what OSG draws is not drawn twice", "[gl][cull]")
{
    const osg::ref_ptr<RigDrawable> rig = new RigDrawable(*plainSquare(0.5f));
    const osg::ref_ptr<osg::Geometry> shaded = plainSquare(0.3f);
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                       "void main() { gl_FragColor = vec4(0.9, 0.1, 0.9, 1.0); }"));
    shaded->getOrCreateStateSet()->setAttributeAndModes(program.get());
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(raised(rig.get(), 0.5f));
    both->addChild(raised(shaded.get(), 0.8f));
    const osg::ref_ptr<CountedDraws> counted = new CountedDraws;
    for (unsigned int frame : {0u, 1u})
        rig->pose(frame).setDrawCallback(counted.get());
    View view(colored(both.get(), kRed).get());
    const auto bend = [&](int step) { rig->bend(osg::Vec3(0.03f * float(step), 0.0f, 0.0f)); };
    for (int step = 1; step < 5; ++step)
    {
        bend(step);
        view.viewer.frames(1);
    }
    CHECK(counted->draws == 0);
    CHECK(view.count("rasterized.cull-callback") == 1);
    CHECK(view.count("traced.proxy") == 1);
    checkMoves(view, bend, 1);
}

TEST_CASE("moving captures: a level of detail that moves with what is captured below it",
          "[gl][cull]")
{
    const osg::ref_ptr<osg::Group> pushing = new osg::Group;
    pushing->setCullCallback(new StatePusher(unlitColor(kRed), unlitColor(kRed)));
    pushing->addChild(plainSquare(0.7f));
    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->addChild(pushing, 0.0f, 1e6f);
    const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    place->addChild(levels);
    View view(place.get());
    const auto move = [&](int step)
    {
        place->setMatrix(osg::Matrix::translate(0.05 * step, 0.0, 0.5));
        view.viewer.frames(1);
    };
    for (int step = 0; step < 4; ++step)
        move(step);
    const uint64_t conversions = view.conversions();
    for (int step = 4; step < 9; ++step)
        move(step);
    CHECK(view.conversions() == conversions);
    checkPicture(view);
    pushing->getChild(0)->setNodeMask(0); // it must still be seen to change
    view.viewer.frames(2);
    CHECK(view.count("converted.culled") == 0);
}
