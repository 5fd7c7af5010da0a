// LiveSignsTest.cpp - edits that are easily missed, and requests that are easily lost. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osg/ClipNode>
#include <osg/Depth>
#include <osg/Fog>
#include <osg/Geometry>
#include <osg/NodeVisitor>
#include <osg/Program>

#include <algorithm>
#include <stdexcept>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// Checks that an edit since the last image, which was a first pass, is visible and looks as in a
/// fresh conversion.
void checkShown(LiveView& view, const osg::Node& root)
{
    const std::vector<float> before = view.lastImage();
    CHECK(wrongPixels(view, root) <= kRoundedPixels);
    CHECK(view.passes() == 1); // as before: the noise is the same
    CHECK(differentPixels(view.lastImage(), before) > kRoundedPixels);
}

/// A group that cannot be traversed while it is broken.
struct Broken : osg::Group
{
    void traverse(osg::NodeVisitor& visitor) override
    {
        if (broken && visitor.getVisitorType() == osg::NodeVisitor::NODE_VISITOR)
            throw std::runtime_error("broken");
        osg::Group::traverse(visitor);
    }
    bool broken = false;
};

void raiseWithoutSign(osg::Geometry& tile)
{
    for (osg::Vec3& v : static_cast<osg::Vec3Array&>(*tile.getVertexArray()))
        v.set(v.x() + 0.2f, v.y(), v.z() + 0.3f);
}

} // namespace

TEST_CASE("live signs: vertex arrays that are exchanged in each frame do not pile up", "[bridge]")
{
    LiveGraph graph;
    LiveView view(graph.root.get());
    view.image();
    osg::Geometry& tile = graph.geometry(2);
    std::vector<osg::observer_ptr<osg::Array>> arrays;
    for (int i = 0; i < 12; ++i)
    {
        tile.setVertexArray(osg::clone(tile.getVertexArray(), osg::CopyOp::DEEP_COPY_ALL));
        graph.deform(2, 0.02f * float(i));
        arrays.emplace_back(tile.getVertexArray());
        view.update();
        view.image();
    }
    CHECK(view.statistics().patches == 12);
    const auto alive = std::count_if(arrays.begin(), arrays.end(),
                                     [](const auto& array) { return array.valid(); });
    CHECK(alive <= 3);     // the tile's array, and those in meshes of the last version
    graph.deform(2, 0.3f); // the last array is watched
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    CHECK(view.statistics().patches == 13);
}

TEST_CASE("live signs: clip planes that are turned on when nothing was clipped", "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
    clip->addClipPlane(new osg::ClipPlane(3, osg::Plane(-1.0, 0.0, 0.0, 0.5)));
    clip->setLocalStateSetModes(osg::StateAttribute::OFF);
    graph.root->addChild(clip);
    LiveView view(graph.root.get());
    view.image();
    graph.objects[0]->setMatrix(osg::Matrixd::translate(0.1, 0.1, 0.1));
    checkShown(view, *graph.root);
    REQUIRE(view.statistics().patches == 1);
    SECTION("of a tile that is there")
    {
        graph.objects[0]->getStateSet()->setMode(GL_CLIP_PLANE0 + 3, osg::StateAttribute::ON);
        checkShown(view, *graph.root);
    }
    SECTION("of one that comes")
    {
        osg::ref_ptr<osg::MatrixTransform> added = graph.newObject(1, 0.1, -0.9);
        added->getStateSet()->setMode(GL_CLIP_PLANE0 + 3, osg::StateAttribute::ON);
        graph.root->addChild(added);
        checkShown(view, *graph.root);
    }
}

TEST_CASE("live signs: fog that drifts is a change once the drift can be seen", "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(osg::Fog::EXP);
    fog->setDensity(0.1f);
    fog->setColor({0.9f, 0.1f, 0.6f, 1.0f});
    graph.root->getOrCreateStateSet()->setAttributeAndModes(fog);
    LiveView view(graph.root.get());
    view.image();
    const auto scene = view.scene();
    for (int frame = 1; frame <= 5; ++frame)
    {
        fog->setColor({0.9f + 2e-6f * float(frame), 0.1f, 0.6f, 1.0f});
        fog->setDensity(0.1f + 1e-7f * float(frame));
        view.update();
        CHECK(view.scene() == scene);
    }
    const auto drift = GENERATE(0.1f, -0.1f);
    for (int frame = 1; frame <= 20; ++frame)
    {
        fog->setColor({0.9f, 0.1f, 0.6f + drift * float(frame) / 20.0f, 1.0f});
        view.update();
    }
    CHECK(view.scene() != scene);
    checkShown(view, *graph.root);
    fog->setDensity(0.102f);
    checkShown(view, *graph.root);
}

TEST_CASE("live signs: the look of what OSG alone draws is no change, and what decides on it is",
          "[bridge]")
{
    LiveGraph graph;
    osg::StateSet& sky = *graph.objects[2]->getStateSet();
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::VERTEX, "void main() {}"));
    sky.setAttributeAndModes(program);
    sky.setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, false));
    const osg::Vec4 blue(0.2f, 0.3f, 0.9f, 1.0f);
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(1, &blue);
    graph.geometry(2).setColorArray(colors, osg::Array::BIND_OVERALL);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(osg::Material::DIFFUSE);
    sky.setAttributeAndModes(material);
    LiveView view(graph.root.get());
    view.image();
    REQUIRE(view.statistics().conversion.count("traced.proxy") == 0);
    const Statistics before = view.statistics();
    for (int frame = 1; frame <= 3; ++frame)
    {
        material->setDiffuse(osg::Material::FRONT_AND_BACK,
                             osg::Vec4(0.2f * float(frame), 0, 0, 1));
        colors->front().x() = 0.2f * float(frame);
        colors->dirty();
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    }
    CHECK(view.statistics().conversions == before.conversions);
    sky.removeAttribute(osg::StateAttribute::PROGRAM);
    sky.removeAttribute(osg::StateAttribute::DEPTH);
    checkShown(view, *graph.root);
    CHECK(view.statistics().conversions == before.conversions + 1);
    colors->front().y() = 0.1f;
    colors->dirty();
    checkShown(view, *graph.root);
    CHECK(view.statistics().conversions == before.conversions + 2);
}

TEST_CASE("live signs: what is written without a sign shows once the scene is said to be dirty",
          "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<Broken> node = new Broken;
    graph.root->addChild(node);
    LiveView view(graph.root.get());
    view.image();
    const uint64_t meshes = view.statistics().convertedMeshes;
    SECTION("vertices")
    {
        raiseWithoutSign(graph.geometry(0));
    }
    SECTION("an image")
    {
        std::fill_n(graph.image->data(), 64, static_cast<unsigned char>(255));
    }
    SECTION("also if what is said is heard in vain at first")
    {
        raiseWithoutSign(graph.geometry(0));
        node->broken = true;
        view.setDirty();
        view.update();
        CHECK_FALSE(view.statistics().ok);
        node->broken = false;
        checkShown(view, *graph.root);
        return;
    }
    const auto scene = view.scene();
    view.update();
    CHECK(view.scene() == scene);
    view.setDirty();
    checkShown(view, *graph.root);
    CHECK(view.statistics().convertedMeshes == meshes + LiveGraph::kObjects);
}

TEST_CASE("live signs: first vertices of primitive sets, whose setters mark nothing", "[bridge]")
{
    LiveGraph graph;
    osg::Geometry& tile = graph.geometry(4);
    osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (int i = 0; i < 2; ++i)
        for (const osg::Vec2 p :
             {osg::Vec2(0.0f, 0.0f), osg::Vec2(0.4f, 0.0f), osg::Vec2(0.0f, 0.8f)})
            corners->push_back(osg::Vec3(p.x() + 0.4f * float(i), p.y(), 0.0f));
    tile.setVertexArray(corners);
    tile.removePrimitiveSet(0);
    SECTION("with lengths")
    {
        osg::ref_ptr<osg::DrawArrayLengths> set = new osg::DrawArrayLengths(GL_TRIANGLES, 0, 1);
        set->front() = 3;
        tile.addPrimitiveSet(set);
        LiveView view(graph.root.get());
        view.image();
        set->setFirst(3);
        checkShown(view, *graph.root);
    }
    SECTION("several in one")
    {
        osg::ref_ptr<osg::MultiDrawArrays> set = new osg::MultiDrawArrays(GL_TRIANGLES);
        set->add(0, 3);
        set->add(3, 0);
        tile.addPrimitiveSet(set);
        LiveView view(graph.root.get());
        view.image();
        set->setFirsts({3, 3});
        checkShown(view, *graph.root);
        set->setFirsts({0, 3});
        set->setCounts({0, 3});
        view.update(); // the triangle is the same
        set->setCounts({3, 0});
        checkShown(view, *graph.root);
    }
}
