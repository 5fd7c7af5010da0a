// LiveReasonsTest.cpp - why edits make the whole graph be converted, and at which node. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/RayTracedScene>

#include <osg/CullFace>
#include <osg/LOD>
#include <osg/PolygonOffset>
#include <osg/Switch>

#include <functional>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// A view of a graph whose nodes have names, once it is converted.
class Reasons
{
public:
    Reasons() : _view(nameAll().get()) { _view.image(); }

    /// The edit converts the whole graph, for this reason and at this node.
    void converts(const std::function<void()>& edit, ConversionCause cause, const char* path)
    {
        const Statistics before = _view.statistics();
        edit();
        _view.update();
        const Statistics after = _view.statistics();
        CHECK(after.conversions == before.conversions + 1);
        CHECK(after.lastConversionReason == textOf(cause));
        CHECK(after.lastConversionPath == path);
        isPatched([this] { graph.deform(5, _height += 0.01f); });
    }

    /// The edit is redone alone, and the last reason stays.
    void isPatched(const std::function<void()>& edit)
    {
        const Statistics before = _view.statistics();
        edit();
        _view.update();
        const Statistics after = _view.statistics();
        CHECK(after.patches == before.patches + 1);
        CHECK(after.conversions == before.conversions);
        CHECK(after.lastConversionReason == before.lastConversionReason);
        CHECK(after.lastConversionPath == before.lastConversionPath);
    }

    osg::ref_ptr<osg::MatrixTransform> newObject(int number, const char* name) const
    {
        const osg::ref_ptr<osg::MatrixTransform> object = graph.newObject(number, 0.0, -0.9);
        object->setName(name);
        return object;
    }

    LiveView& view() { return _view; }

    LiveGraph graph;

    // Below the root from the beginning:
    osg::ref_ptr<osg::MatrixTransform> holder = new osg::MatrixTransform; ///< of levels
    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    osg::ref_ptr<osg::Switch> many = new osg::Switch;
    osg::ref_ptr<osg::MatrixTransform> twice = graph.newObject(2, 0.0, -0.9); ///< on two paths

private:
    osg::ref_ptr<osg::Group> nameAll()
    {
        graph.root->setName("root");
        graph.group->setName("group");
        graph.light->setName("lamp");
        for (int i = 0; i < LiveGraph::kObjects; ++i)
        {
            graph.objects[std::size_t(i)]->setName("object" + std::to_string(i));
            graph.geometry(i).setName("tile");
        }
        holder->setName("holder");
        levels->setName("levels");
        many->setName("many");
        twice->setName("twice");
        levels->addChild(graph.newObject(1, 0.0, -0.9), 0.0f, 1e6f);
        holder->addChild(levels);
        graph.root->addChild(holder);
        for (int i = 0; i < 300; ++i)
            many->addChild(new osg::Group);
        graph.root->addChild(many);
        graph.root->addChild(twice);
        holder->addChild(twice);
        return graph.root;
    }

    LiveView _view;
    float _height = 0.0f;
};

} // namespace

TEST_CASE("reasons: the first conversion has none, and patches make none", "[bridge]")
{
    Reasons reasons;
    CHECK(reasons.view().statistics().conversions == 1);
    CHECK(reasons.view().statistics().lastConversionReason.empty());
    reasons.isPatched([&] { reasons.graph.deform(1, 0.1f); });
    CHECK(reasons.view().statistics().lastConversionReason.empty());
    CHECK(reasons.view().statistics().lastConversionPath.empty());
}

TEST_CASE("reasons: edits of nodes", "[bridge]")
{
    Reasons reasons;
    LiveGraph& graph = reasons.graph;
    reasons.converts(
        [&]
        {
            graph.group->removeChild(graph.objects[0]);
            graph.group->addChild(graph.objects[0]);
        },
        ConversionCause::ChildOrder, "root/group");
    reasons.converts([&] { reasons.levels->getChild(0)->setNodeMask(0); },
                     ConversionCause::Untracked, "root/holder/levels");
    reasons.converts([&] { reasons.levels->getChild(0)->setNodeMask(~0u); },
                     ConversionCause::Untracked, "root/holder/levels");
    reasons.converts([&] { reasons.holder->setMatrix(osg::Matrixd::translate(0.1, 0.0, 0.0)); },
                     ConversionCause::MovedSpecial, "root/holder");
    reasons.converts(
        [&]
        { reasons.holder->getOrCreateStateSet()->setMode(GL_NORMALIZE, osg::StateAttribute::ON); },
        ConversionCause::UntrackedState, "root/holder/levels");
    reasons.converts([&] { reasons.many->setAllChildrenOff(); }, ConversionCause::ManyEdits,
                     "root/many/Group");
    reasons.converts([&] { reasons.holder->removeChild(reasons.twice); },
                     ConversionCause::SharedNode, "root/holder/twice");
    reasons.converts([&] { RayTracedScene::setHint(graph.objects[2], RayTracedScene::RASTERIZE); },
                     ConversionCause::Hint, "root/group/object2");
    reasons.converts([&] { graph.light->setReferenceFrame(osg::LightSource::ABSOLUTE_RF); },
                     ConversionCause::ReferenceFrame, "root/lamp");
    reasons.converts([&] { graph.root->removeChild(graph.light); }, ConversionCause::SpecialNode,
                     "root/lamp");
}

TEST_CASE("reasons: edits of geometry and of places", "[bridge]")
{
    Reasons reasons;
    LiveGraph& graph = reasons.graph;
    reasons.converts(
        [&]
        {
            auto& coordinates =
                static_cast<osg::Vec2Array&>(*graph.geometry(1).getTexCoordArray(0));
            coordinates[0].set(0.5f, 0.5f);
            coordinates.dirty();
        },
        ConversionCause::VertexAttributes, "root/group/object1/tile");
    reasons.converts([&] { graph.geometry(2).setDataVariance(osg::Object::STATIC); },
                     ConversionCause::DrawingMode, "root/group/object2/tile");
    reasons.converts([&] { graph.objects[3]->setMatrix(osg::Matrixd::scale(1.0, 0.0, 0.0)); },
                     ConversionCause::BadTransform, "root/group/object3/tile");
    reasons.converts([&]
                     { graph.geometry(4).addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, 2)); },
                     ConversionCause::LinesOrPoints, "root/group/object4/tile");
}

TEST_CASE("reasons: vertices that leave the frame of their mesh get another frame", "[bridge]")
{
    Reasons reasons;
    osg::Geometry& tile = reasons.graph.geometry(0);
    const auto shift = [&](float radii)
    {
        auto& vertices = static_cast<osg::Vec3Array&>(*tile.getVertexArray());
        for (osg::Vec3& v : vertices)
            v.x() += 0.57f * radii;
        vertices.dirty();
    };
    reasons.isPatched([&] { shift(1.0f); });
    reasons.isPatched([&] { shift(100.0f); });
    reasons.converts([&] { shift(100.0f); }, ConversionCause::Lengths, "root/group/object0/tile");
    reasons.isPatched([&] { shift(100.0f); });
}

TEST_CASE("reasons: the path is that of the one use that could not be redone", "[bridge]")
{
    Reasons reasons;
    LiveGraph& graph = reasons.graph;
    const osg::ref_ptr<osg::MatrixTransform> other = new osg::MatrixTransform;
    other->setName("other");
    other->addChild(graph.objects[0]->getChild(0)); // below object0 and below this
    // The mesh is in the static BVH: the second path makes it a mesh with instances.
    reasons.converts([&] { graph.root->addChild(other); }, ConversionCause::NotAnInstance,
                     "root/other/tile");
    reasons.converts([&] { other->setMatrix(osg::Matrixd::scale(1.0, 0.0, 0.0)); },
                     ConversionCause::BadTransform, "root/other/tile");
}

TEST_CASE("reasons: edits of state", "[bridge]")
{
    Reasons reasons;
    LiveGraph& graph = reasons.graph;
    reasons.converts(
        [&] {
            graph.objects[1]->getStateSet()->setAttributeAndModes(
                new osg::PolygonOffset(-1.0f, -1.0f));
        },
        ConversionCause::StateEffects, "root/group/object1/tile");
    reasons.isPatched([&] { graph.objects[1]->setMatrix(osg::Matrixd::translate(0.0, 0.0, 0.5)); });
    reasons.converts(
        [&] {
            reasons.twice->getStateSet()->setAttributeAndModes(
                new osg::PolygonOffset(-1.0f, -1.0f));
        },
        ConversionCause::StateEffects, "root/holder/twice/Geometry");
    reasons.converts([&] { reasons.twice->setMatrix(osg::Matrixd::translate(0.0, 0.0, 0.5)); },
                     ConversionCause::NotAlone, "root/holder/twice/Geometry");
    reasons.isPatched(
        [&] { graph.objects[2]->getStateSet()->setAttributeAndModes(new osg::CullFace); });
    reasons.converts([&] { graph.objects[2]->setMatrix(osg::Matrixd::scale(-1.0, 1.0, 1.0)); },
                     ConversionCause::Winding, "root/group/object2/tile");
    const osg::ref_ptr<osg::MatrixTransform> physical = reasons.newObject(2, "physical");
    physical->getStateSet()->setAttributeAndModes(new PhysicalMaterial);
    reasons.converts([&] { graph.root->addChild(physical); }, ConversionCause::ColorRule,
                     "root/physical/Geometry");
    reasons.converts([&] { graph.root->removeChild(physical); }, ConversionCause::LastOfState,
                     "root");
}

TEST_CASE("reasons: those of no single node", "[bridge]")
{
    Reasons reasons;
    reasons.converts([&] { reasons.view().setDirty(); }, ConversionCause::Dirty, "");
}
