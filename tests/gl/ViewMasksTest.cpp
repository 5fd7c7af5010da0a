// ViewMasksTest.cpp - node masks that hide parts of a scene from some of its views. Layer: tests.
// SPDX-License-Identifier: MIT
#include "CullNodes.h"
#include "Squares.h"

#include <osg/LOD>

#include <memory>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// Gives the viewer a camera for each half of its window, with the cull masks 1 and 2. The picture
/// is that of one of them.
void splitByMask(TestViewer& view, int captured)
{
    for (int i = 0; i < 2; ++i)
    {
        osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setGraphicsContext(view.camera().getGraphicsContext());
        camera->setViewport(i * kSize / 2, 0, kSize / 2, kSize);
        camera->setClearColor(osg::Vec4(0, 0, 0, 1));
        camera->setRenderOrder(osg::Camera::POST_RENDER);
        camera->setComputeNearFarMode(osg::Camera::DO_NOT_COMPUTE_NEAR_FAR);
        camera->setCullMask(1u << i);
        if (i == captured) camera->addFinalDrawCallback(view.capture.get());
        view.viewer.addSlave(camera.get());
    }
}

/// Checks that each half of the window shows what OSG alone shows there. masked returns content.
template <class Masked> void checkHalves(const std::string& name, const Masked& masked)
{
    for (int captured = 0; captured < 2; ++captured)
    {
        CAPTURE(captured);
        const auto setUp = [captured](TestViewer& view) { splitByMask(view, captured); };
        const osg::ref_ptr<osg::Image> drawn = picture(masked().get(), setUp, 2);
        const osg::ref_ptr<RayTracedScene> scene = tracedScene(masked().get());
        scene->getSettings()->setPassesPerFrame(61);
        TestViewer view(kSize, kSize, scene.get());
        setUp(view);
        const osg::ref_ptr<osg::Image> traced = view.frames(3);
        CHECK(differenceInside(name, *drawn, *traced) == 0.0);
        CHECK(statistics(*scene).conversion["rasterized.view-mask"] == 2);
        CHECK(statistics(*scene).conversions <= 3); // one for each view of the first frame
    }
}

/// Draws a geometry in cull alone, as leaf nodes of applications do.
class DrawingLeaf : public osg::Node
{
public:
    explicit DrawingLeaf(osg::Geometry* geometry) : _geometry(geometry) { setCullingActive(false); }
    osg::BoundingSphere computeBound() const override { return {osg::Vec3(), 3.0f}; }
    const char* libraryName() const override { return "application"; }
    void traverse(osg::NodeVisitor& visitor) override
    {
        if (visitor.getVisitorType() == osg::NodeVisitor::CULL_VISITOR) _geometry->accept(visitor);
    }

private:
    osg::ref_ptr<osg::Geometry> _geometry;
};

uint64_t conversions(const RayTracedScene& scene)
{
    return statistics(scene).conversions;
}

} // namespace

TEST_CASE("view masks: what node masks hide from some views is OSG's", "[gl]")
{
    const auto masked = []
    {
        osg::ref_ptr<osg::Group> group = squares();
        group->getChild(0)->setNodeMask(1);
        group->getChild(1)->asGroup()->getChild(0)->setNodeMask(2);
        return group;
    };
    checkHalves("masks", masked);
}

TEST_CASE("view masks: what an application draws in cull is seen by its mask", "[gl][cull]")
{
    const bool rig = GENERATE(false, true);
    CAPTURE(rig);
    const osg::ref_ptr<osg::Geometry> white = unlitSquare(1.2f, osg::Vec4(1, 1, 1, 1));
    osg::ref_ptr<osg::Node> content = new DrawingLeaf(white.get());
    if (rig) content = new application::RigDrawable(*white);
    content->setNodeMask(2);
    const osg::ref_ptr<osg::Group> group = squares();
    group->addChild(content.get());
    for (int captured = 0; captured < 2; ++captured)
    {
        CAPTURE(captured);
        const auto setUp = [captured](TestViewer& view) { splitByMask(view, captured); };
        const osg::ref_ptr<osg::Image> drawn = picture(group.get(), setUp, 2);
        const osg::ref_ptr<RayTracedScene> scene = tracedScene(group.get());
        scene->getSettings()->setPassesPerFrame(61);
        TestViewer view(kSize, kSize, scene.get());
        setUp(view);
        const osg::ref_ptr<osg::Image> traced = view.frames(3);
        // Traced pixels at the edges of near squares hide what is drawn behind them.
        CHECK(differenceInside(rig ? "masked-rig" : "masked-leaf", *drawn, *traced) < 0.001);
        CHECK(statistics(*scene).conversion["converted.culled"] == 0);
    }
}

TEST_CASE("view masks: a view that changes its cull mask is converted for once", "[gl]")
{
    const osg::ref_ptr<RayTracedScene> scene = tracedSquares();
    scene->getChild(0)->asGroup()->getChild(0)->setNodeMask(1);
    TestViewer view(kSize, kSize, scene.get());
    view.frames(3);
    for (const unsigned int mask : {2u, 3u})
    {
        const uint64_t before = conversions(*scene);
        view.camera().setCullMask(mask);
        view.frames(4);
        CHECK(conversions(*scene) == before + 1);
        CHECK(statistics(*scene).conversion["rasterized.view-mask"] == 0);
    }
}

TEST_CASE("view masks: viewers that count frames by themselves need no conversions in turn", "[gl]")
{
    const osg::ref_ptr<RayTracedScene> scene = tracedSquares();
    std::vector<std::unique_ptr<TestViewer>> views;
    for (int i = 0; i < 3; ++i)
    {
        views.push_back(std::make_unique<TestViewer>(kSize, kSize, scene.get()));
        views.back()->camera().setCullMask(1u << i);
        views.back()->frames(1 + i);
    }
    const auto takeTurns = [&]
    {
        for (const std::unique_ptr<TestViewer>& view : views)
            view->frames();
    };
    takeTurns();
    const uint64_t before = conversions(*scene);
    for (int turn = 0; turn < 3; ++turn)
        takeTurns();
    CHECK(conversions(*scene) == before);
}

TEST_CASE("view masks: a node mask that hides a seen node from a view counts at once", "[gl]")
{
    const bool ofDrawable = GENERATE(false, true);
    CAPTURE(ofDrawable);
    const osg::ref_ptr<osg::Group> group = squares();
    osg::Node* node = group->getChild(1);
    if (ofDrawable) node = node->asGroup()->getChild(0);
    const osg::ref_ptr<RayTracedScene> scene = tracedScene(group.get());
    TestViewer view(kSize, kSize, scene.get());
    splitByMask(view, 0);
    view.frames(3);
    for (const unsigned int mask : {1u, 3u})
    {
        node->setNodeMask(mask);
        view.frames(2);
        CHECK(statistics(*scene).conversion["rasterized.view-mask"] == (mask == 1u ? 1u : 0u));
        const uint64_t before = conversions(*scene);
        view.frames(2);
        CHECK(conversions(*scene) == before);
    }
}

TEST_CASE("view masks: levels of detail are redone alone, unless OSG draws what is above", "[gl]")
{
    const bool masksAbove = GENERATE(false, true);
    CAPTURE(masksAbove);
    const osg::ref_ptr<osg::Group> group = squares(), above = new osg::Group;
    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    const auto newSquare = [](float x, unsigned int mask)
    {
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrixd::rotate(0.7, osg::Vec3d(0.3, 1.0, 0.0)) *
                                     osg::Matrixd::translate(x, 0.7, 7.0));
        place->addChild(unlitSquare(0.5f, osg::Vec4(1, 1, 1, 1)));
        place->setNodeMask(mask);
        return place;
    };
    levels->addChild(newSquare(0.2f, 3u), 0.0f, 1e6f);
    above->addChild(levels);
    above->setNodeMask(masksAbove ? 1u : 3u);
    group->addChild(above);
    const osg::ref_ptr<RayTracedScene> scene = tracedScene(group.get());
    scene->getSettings()->setPassesPerFrame(61);
    TestViewer view(kSize, kSize, scene.get());
    const auto setUp = [](TestViewer& other) { splitByMask(other, 0); };
    setUp(view);
    view.frames(3);
    const uint64_t before = conversions(*scene);
    const auto showsAsOsg = [&](const char* name, uint64_t left)
    {
        const osg::ref_ptr<osg::Image> traced = view.frames(3);
        const osg::ref_ptr<osg::Image> drawn = picture(group.get(), setUp, 2);
        // Traced pixels at the edges of near squares hide what is drawn behind them.
        CHECK(differenceInside(name, *drawn, *traced) < 0.001);
        CHECK(statistics(*scene).conversion["rasterized.view-mask"] == left);
        if (!masksAbove) CHECK(conversions(*scene) == before);
    };
    levels->setChild(0, newSquare(-0.9f, 3u));
    showsAsOsg("masks-level", masksAbove ? 1 : 0);
    levels->setChild(0, newSquare(0.4f, 1u));
    showsAsOsg("masks-level-hidden", 1);
    levels->setChild(0, newSquare(-0.5f, 3u));
    showsAsOsg("masks-level-seen", masksAbove ? 1 : 0);
}
