// ManyPathsTest.cpp - shared subgraphs with more paths than any traversal could follow, and nodes
// that change the graph while it is traversed. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/changes/GraphWatch.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"
#include "osgRayTrace/bridge/graph/PathBudget.h"

#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/LOD>
#include <osg/ShapeDrawable>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// Returns a graph in which each level has the next one twice: 2^levels paths lead to the leaf.
osg::ref_ptr<osg::Group> doubled(int levels, osg::Node* leaf)
{
    osg::ref_ptr<osg::Group> top = new osg::Group;
    top->addChild(leaf);
    for (int i = 0; i < levels; ++i)
    {
        osg::ref_ptr<osg::Group> outer = new osg::Group;
        outer->addChild(top);
        outer->addChild(top);
        outer->setName("level " + std::to_string(i + 1));
        top = outer;
    }
    return top;
}

osg::ref_ptr<osg::Geometry> smallQuad()
{
    return osg::createTexturedQuadGeometry(osg::Vec3(), osg::Vec3(1.0f, 0.0f, 0.0f),
                                           osg::Vec3(0.0f, 1.0f, 0.0f));
}

uint64_t countOf(const ConversionResult& result, const std::string& what)
{
    const auto found = result.counts.find(what);
    return found == result.counts.end() ? 0 : found->second;
}

ConversionResult converted(osg::Node& root, bool rasterizesRest)
{
    ConversionInput input;
    input.root = &root;
    input.rasterizesRest = rasterizesRest;
    return SceneConverter().convert(input);
}

/// A group that removes children when it is traversed: before or after it traverses them.
class Shedding : public osg::Group
{
public:
    explicit Shedding(bool before) : _before(before) {}
    const char* className() const override { return "Shedding"; }

    void traverse(osg::NodeVisitor& visitor) override
    {
        if (_before && getNumChildren() > 0) removeChildren(0, 1);
        osg::Group::traverse(visitor);
        if (!_before) removeChildren(0, getNumChildren());
    }

private:
    bool _before;
};

} // namespace

TEST_CASE("many paths: a conversion ends, names what it leaves out, and leaves to OSG what can be",
          "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(doubled(40, smallQuad()));
    root->addChild(smallQuad());
    root->getChild(1)->setName("behind");
    const ConversionResult result = converted(*root, true);
    CHECK(countOf(result, "converted.instance") > kMostPaths / 4);
    CHECK(countOf(result, "converted.instance") <= kMostPaths);
    CHECK(countOf(result, "skipped.too-many-paths") > 10); // 2^39 paths below one of them
    CHECK(countOf(result, "rasterized.too-many-paths") >= 10);
    const std::vector<std::string>& left = result.paths.at("skipped.too-many-paths");
    CHECK(left.front().find("level ") != std::string::npos);
    REQUIRE(result.rasterized);
    CHECK(result.rasterized->size() == countOf(result, "rasterized.too-many-paths"));
}

TEST_CASE("many paths: so do the watch, hashes and bounds", "[bridge]")
{
    const osg::ref_ptr<osg::Group> many = doubled(40, smallQuad());
    const ViewingConditions conditions;
    GraphWatch watch;
    watch.record(*many, conditions);
    CHECK(watch.look(*many, conditions).none());
    many->addChild(smallQuad());
    CHECK(watch.look(*many, conditions).convert);

    const osg::ref_ptr<osg::LOD> levels = new osg::LOD;
    levels->addChild(many, 0.0f, 1e6f);
    CHECK(graphHash(*levels, conditions) == graphHash(*levels, conditions));

    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->addChild(many);
    CHECK(scene->getBound().valid());
    CHECK(scene->getDrawable()->getBoundingBox().contains(osg::Vec3(0.5f, 0.5f, 0.0f)));
}

TEST_CASE("many paths: what real scenes have is taken as it was", "[bridge]")
{
    const osg::ref_ptr<osg::Group> shared = doubled(10, smallQuad());
    const ConversionResult result = converted(*shared, true);
    CHECK(countOf(result, "converted.instance") == 1024u);
    CHECK(countOf(result, "skipped.too-many-paths") == 0);
    CHECK(countOf(result, "rasterized.too-many-paths") == 0);
}

TEST_CASE("nodes that remove their children while they are traversed do no harm", "[bridge]")
{
    const bool before = GENERATE(false, true);
    LiveGraph graph;
    LiveView view(graph.root.get());
    for (int i = 0; i < 30; ++i)
    {
        osg::ref_ptr<Shedding> shedding = new Shedding(before);
        for (int k = 0; k < 3; ++k)
            shedding->addChild(graph.newObject(k, 0.5 * k, 0.3));
        shedding->addChild(new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 0.2f)));
        graph.root->addChild(shedding);
        view.update();
        view.image();
        CHECK(view.statistics().ok);
        view.setDirty(); // converts the whole graph
        view.update();
        view.image();
        CHECK(view.statistics().ok);
        if (i % 3 == 2) graph.root->removeChild(shedding);
    }
    graph.root->removeChildren(3, graph.root->getNumChildren() - 3);
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
}
