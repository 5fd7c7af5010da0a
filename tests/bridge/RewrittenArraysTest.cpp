// RewrittenArraysTest.cpp - arrays that are marked as modified although they keep their values.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/bridge/geometry/BufferContents.h"

#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osg/LOD>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// Does what osgAnimation does: it writes and marks positions in each frame, whether or not they
/// move.
void rewrite(LiveGraph& graph, float height)
{
    for (int i = 0; i < LiveGraph::kObjects; ++i)
        graph.deform(i, height);
}

void drawRewritten(LiveGraph& graph, LiveView& view, int frames)
{
    for (int i = 0; i < frames; ++i)
    {
        rewrite(graph, 0.1f);
        view.update();
        view.image();
    }
}

/// Checks that the image accumulates while the arrays keep their values, and begins again once one
/// value differs.
void checkConverges(LiveGraph& graph)
{
    LiveView view(graph.root.get());
    drawRewritten(graph, view, 5);
    const Statistics before = view.statistics();
    const int passes = view.passes();
    drawRewritten(graph, view, 6);
    const Statistics after = view.statistics();
    CHECK(view.passes() == passes + 6);
    CHECK(after.conversions == before.conversions);
    CHECK(after.patches == before.patches);
    CHECK(after.convertedMeshes == before.convertedMeshes);

    auto& positions = static_cast<osg::Vec3Array&>(*graph.geometry(2).getVertexArray());
    positions[40].z() += 0.2f;
    positions.dirty();
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    CHECK(view.passes() == 1);
}

} // namespace

TEST_CASE("rewritten arrays: equal values are no change", "[bridge]")
{
    LiveGraph graph;
    checkConverges(graph);
}

TEST_CASE("rewritten arrays: nor below nodes of classes that are not known one by one", "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->addChild(graph.group, 0.0f, 1e6f);
    graph.root->replaceChild(graph.group, levels);
    checkConverges(graph);
}

TEST_CASE("rewritten arrays: a conversion for another reason keeps their meshes", "[bridge]")
{
    LiveGraph graph;
    LiveView view(graph.root.get());
    drawRewritten(graph, view, 5);
    const Statistics before = view.statistics();
    for (int i = 0; i < 3; ++i)
    {
        osg::ref_ptr<osg::LightSource> light = new osg::LightSource; // lights the whole graph
        light->getLight()->setLightNum(1 + i);
        graph.root->addChild(light);
        drawRewritten(graph, view, 1);
    }
    CHECK(view.statistics().conversions == before.conversions + 3);
    CHECK(view.statistics().convertedMeshes == before.convertedMeshes);
}

TEST_CASE("rewritten arrays: a hash shows any word and any length", "[bridge]")
{
    std::vector<unsigned char> bytes(200);
    const uint64_t zero = memoryHash(bytes.data(), bytes.size());
    for (std::size_t i = 0; i < bytes.size(); ++i)
    {
        bytes[i] = 1;
        CHECK(memoryHash(bytes.data(), bytes.size()) != zero);
        bytes[i] = 0;
        CHECK(memoryHash(bytes.data(), i) != zero);
    }
    CHECK(memoryHash(bytes.data(), bytes.size()) == zero);
    CHECK(memoryHash(nullptr, 0) == memoryHash(bytes.data(), 0));
}
