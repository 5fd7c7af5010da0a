// LiveClipsTest.cpp - clip planes that move cost what they cut, and nothing where they cut nothing.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osg/ClipNode>
#include <osg/LOD>
#include <osgParticle/PrecipitationEffect>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

osg::ref_ptr<osg::ClipNode> clipNode(double distance, osg::Node* child)
{
    osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
    clip->addClipPlane(new osg::ClipPlane(0, osg::Plane(-1.0, 0.0, 0.0, distance)));
    clip->addChild(child);
    return clip;
}

void setPlane(osg::ClipNode& clip, double distance)
{
    clip.getClipPlane(0)->setClipPlane(-1.0, 0.0, 0.0, distance);
}

/// Holds the tiles of a LiveGraph, two of them below a clip node whose plane cuts both.
struct ClippedGraph : LiveGraph
{
    ClippedGraph()
    {
        for (const int i : {1, 4})
        {
            group->removeChild(objects[i]);
            clip->addChild(objects[i]);
        }
        root->addChild(clip);
    }
    osg::ref_ptr<osg::ClipNode> clip = clipNode(1.1, new osg::Group);
};

/// Checks that an update has made so many patches and conversions and shows what is there.
void checkUpdate(LiveView& view, const osg::Node& root, uint64_t patches, uint64_t conversions)
{
    const Statistics before = view.statistics();
    const int wrong = wrongPixels(view, root);
    CHECK(wrong <= kRoundedPixels);
    CAPTURE(view.statistics().lastConversionReason);
    CHECK(view.statistics().patches == before.patches + patches);
    CHECK(view.statistics().conversions == before.conversions + conversions);
}

} // namespace

TEST_CASE("live clips: planes over rain alone move with the eye and change nothing", "[bridge]")
{
    LiveGraph graph;
    const osg::ref_ptr<osg::ClipNode> clip = clipNode(-1.0, new osgParticle::PrecipitationEffect);
    clip->setReferenceFrame(osg::ClipNode::ABSOLUTE_RF);
    SECTION("in a graph of known classes")
    {
        graph.root->addChild(clip);
    }
    SECTION("below a node of another class")
    {
        osg::ref_ptr<osg::LOD> lod = new osg::LOD;
        lod->addChild(clip, 0.0f, 1e9f);
        graph.root->addChild(lod);
    }
    LiveView view(graph.root.get());
    view.image();
    const auto scene = view.scene();
    const Statistics before = view.statistics();
    REQUIRE(before.conversion.at("not-traced.particles") == 1);
    for (int frame = 1; frame <= 4; ++frame)
    {
        view.recordEye(osg::Vec3d(1.2, -1.5, 4.0 + 0.01 * frame));
        setPlane(*clip, -1.0 - frame);
        view.update();
        CHECK(view.scene() == scene);
    }
    CHECK(view.statistics().conversions == before.conversions);
    CHECK(view.statistics().patches == before.patches);
    graph.objects[0]->setMatrix(osg::Matrixd::translate(0.1, 0.1, 0.1));
    checkUpdate(view, *graph.root, 1, 0);
}

TEST_CASE("live clips: planes redo what they cut, and nothing else", "[bridge]")
{
    ClippedGraph graph;
    LiveView view(graph.root.get());
    const std::vector<float> first = view.image();
    const uint64_t meshes = view.statistics().convertedMeshes;
    setPlane(*graph.clip, 1.25);
    checkUpdate(view, *graph.root, 1, 0);
    CHECK(view.statistics().convertedMeshes == meshes + 2);
    CHECK(differentPixels(first, view.lastImage()) > 10 * kRoundedPixels);
    for (const double distance : {1.3, 1.05, 1.15})
    {
        setPlane(*graph.clip, distance);
        checkUpdate(view, *graph.root, 1, 0);
    }
    graph.objects[0]->setMatrix(osg::Matrixd::translate(0.1, 0.1, 0.1)); // below no plane
    checkUpdate(view, *graph.root, 1, 0);
    setPlane(*graph.clip, 1.2);
    graph.objects[2]->setMatrix(osg::Matrixd::translate(2.1, 0.1, 0.1));
    checkUpdate(view, *graph.root, 1, 0);
    graph.objects[4]->setMatrix(osg::Matrixd::translate(0.7, 0.8, 0.1)); // below one
    checkUpdate(view, *graph.root, 0, 1);
    setPlane(*graph.clip, 1.25);
    checkUpdate(view, *graph.root, 1, 0);
}

TEST_CASE("live clips: what comes or goes whole takes a conversion", "[bridge]")
{
    ClippedGraph graph;
    LiveView view(graph.root.get());
    view.image();
    setPlane(*graph.clip, -5.0);
    checkUpdate(view, *graph.root, 0, 1);
    CHECK(view.statistics().conversion.at("not-traced.clipped-away") == 2);
    setPlane(*graph.clip, -6.0);
    checkUpdate(view, *graph.root, 1, 0);
    setPlane(*graph.clip, 1.2);
    checkUpdate(view, *graph.root, 0, 1);
    CHECK(view.statistics().conversion.count("not-traced.clipped-away") == 0);
    setPlane(*graph.clip, 9.0); // no plane cuts anything
    checkUpdate(view, *graph.root, 1, 0);
}

TEST_CASE("live clips: planes below transforms, in eye space, and set by several nodes", "[bridge]")
{
    LiveGraph graph;
    const osg::ref_ptr<osg::ClipNode> clip = clipNode(0.1, new osgParticle::PrecipitationEffect);
    const osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrixd::translate(1.0, 0.0, 0.0));
    graph.root->insertChild(0, place);
    place->addChild(clip);
    graph.group->getOrCreateStateSet()->setMode(GL_CLIP_PLANE0, osg::StateAttribute::ON);
    SECTION("a transform moves it")
    {
        LiveView view(graph.root.get());
        view.image();
        place->setMatrix(osg::Matrixd::translate(1.15, 0.0, 0.0));
        checkUpdate(view, *graph.root, 1, 0);
    }
    SECTION("it is of eye space")
    {
        clip->setReferenceFrame(osg::ClipNode::ABSOLUTE_RF);
        LiveView view(graph.root.get());
        view.image();
        setPlane(*clip, -0.1);
        checkUpdate(view, *graph.root, 1, 0);
    }
    SECTION("a later node sets the same plane")
    {
        const osg::ref_ptr<osg::ClipNode> later =
            clipNode(1.2, new osgParticle::PrecipitationEffect);
        graph.root->addChild(later);
        LiveView view(graph.root.get());
        view.image();
        setPlane(*clip, 0.5);
        checkUpdate(view, *graph.root, 1, 0); // nothing is cut anew
        setPlane(*later, 1.3);
        checkUpdate(view, *graph.root, 1, 0);
    }
    SECTION("a later node of another class sets the same plane")
    {
        osg::ref_ptr<osg::LOD> lod = new osg::LOD;
        const osg::ref_ptr<osg::ClipNode> later =
            clipNode(1.2, new osgParticle::PrecipitationEffect);
        lod->addChild(later, 0.0f, 1e9f);
        graph.root->addChild(lod);
        LiveView view(graph.root.get());
        view.image();
        setPlane(*clip, 0.5);
        checkUpdate(view, *graph.root, 0, 1);
        setPlane(*later, 1.3);
        checkUpdate(view, *graph.root, 0, 1);
    }
    SECTION("planes come and go")
    {
        LiveView view(graph.root.get());
        view.image();
        place->removeChild(clip);
        checkUpdate(view, *graph.root, 0, 1);
        place->addChild(clip);
        checkUpdate(view, *graph.root, 0, 1);
    }
}
