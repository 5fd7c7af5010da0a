// LiveLevelsTest.cpp - what is kept beside the scene of content below levels of detail. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/RasterizedParts.h"
#include "osgRayTrace/bridge/pick/PickIndex.h"
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/RayTracedScene>

#include <osg/LOD>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// Extends the live graph by a level of detail that is always shown.
struct LevelGraph : LiveGraph
{
    explicit LevelGraph(osg::Node* page)
    {
        levels->addChild(page, 0.0f, 1e6f);
        root->addChild(levels);
    }

    osg::ref_ptr<osg::LOD> levels = new osg::LOD;
};

osg::ref_ptr<osg::MatrixTransform> raised(osg::Node* node)
{
    const osg::ref_ptr<osg::MatrixTransform> place =
        new osg::MatrixTransform(osg::Matrixd::translate(0.5, 0.4, 0.9));
    place->addChild(node);
    return place;
}

osg::ref_ptr<osg::Geometry> newTile()
{
    const LiveGraph graph;
    return graph.objects[0]->getChild(0)->asGeometry();
}

/// Returns what OSG draws in place of the geometry; null: it does not.
const osg::Geometry* restOf(const LiveView& view, const osg::Geometry& geometry)
{
    const SceneVersion version = view.version();
    if (!version.rasterized) return nullptr;
    for (const RasterizedPart& part : *version.rasterized)
        if (!part.path.empty() && part.path.back() == &geometry && part.inPlace)
            return part.inPlace->asGeometry();
    return nullptr;
}

template <class Array> osg::ref_ptr<Array> copyOf(const osg::Array& array)
{
    return new Array(dynamic_cast<const Array&>(array));
}

/// Counts the instances that picks would find on a geometry.
int picksOf(const LiveView& view, const osg::Geometry& geometry)
{
    const SceneVersion version = view.version();
    int found = 0;
    for (uint32_t i = 0; i < version.inputs.scene->scene().instances.size(); ++i)
    {
        const PickIndex::Use use = version.pickIndex->use(i);
        found += use.geometry != kInvalid && &version.pickIndex->geometry(use) == &geometry;
    }
    return found;
}

} // namespace

TEST_CASE("levels: lines beside triangles have the arrays of now", "[bridge]")
{
    const osg::ref_ptr<osg::Geometry> tile = newTile();
    const auto count = tile->getVertexArray()->getNumElements();
    tile->setTexCoordArray(0, new osg::Vec2Array(count));
    tile->setColorArray(new osg::Vec4Array(count), osg::Array::BIND_PER_VERTEX);
    tile->addPrimitiveSet(new osg::DrawArrays(GL_LINES, 0, 4));
    LevelGraph graph(raised(tile));
    LiveView view(graph.root);
    const auto check = [&](const char* what)
    {
        INFO(what);
        view.update();
        CAPTURE(view.statistics().lastConversionReason);
        CHECK(view.statistics().conversions == 1);
        const osg::Geometry* rest = restOf(view, *tile);
        REQUIRE(rest);
        CHECK(rest->getNumPrimitiveSets() == 1);
        CHECK(rest->getVertexArray() == tile->getVertexArray());
        CHECK(rest->getNormalArray() == tile->getNormalArray());
        CHECK(rest->getColorArray() == tile->getColorArray());
        CHECK(rest->getTexCoordArray(0) == tile->getTexCoordArray(0));
    };
    check("as it came");
    tile->setColorArray(copyOf<osg::Vec4Array>(*tile->getColorArray()));
    check("other colours");
    tile->setTexCoordArray(0, copyOf<osg::Vec2Array>(*tile->getTexCoordArray(0)));
    check("other texture coordinates");
    const auto vertices = copyOf<osg::Vec3Array>(*tile->getVertexArray());
    vertices->front().z() += 0.1f;
    tile->setVertexArray(vertices);
    check("other vertices");
}

TEST_CASE("levels: what a page has left to OSG is forgotten with it", "[bridge]")
{
    const osg::ref_ptr<osg::Geometry> tile = newTile();
    const osg::ref_ptr<osg::Group> left = new osg::Group;
    RayTracedScene::setHint(left, RayTracedScene::RASTERIZE_ONLY);
    left->addChild(tile);
    LevelGraph graph(raised(left));
    LiveView view(graph.root);
    REQUIRE(view.version().rasterized);
    graph.levels->setChild(0, raised(newTile()));
    CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
    CHECK_FALSE(view.version().rasterized);
    // It is a geometry like any other now.
    const osg::ref_ptr<osg::MatrixTransform> place = raised(tile);
    place->setStateSet(graph.objects[1]->getStateSet());
    graph.root->addChild(place);
    for (const double x : {1.4, 1.6, 0.2})
    {
        place->setMatrix(osg::Matrixd::translate(x, 0.3, 1.1));
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
        CAPTURE(view.statistics().lastConversionReason);
        CHECK(view.statistics().conversions == 1);
    }
}

TEST_CASE("levels: picks find what has come in place of a page", "[bridge]")
{
    LevelGraph graph(raised(newTile()));
    LiveView view(graph.root);
    REQUIRE(view.versionToPick().pickIndex);
    const osg::ref_ptr<osg::Geometry> gone =
        graph.levels->getChild(0)->asGroup()->getChild(0)->asGeometry();
    CHECK(picksOf(view, *gone) == 1);
    const osg::ref_ptr<osg::Geometry> come = newTile();
    graph.levels->setChild(0, raised(come));
    const uint64_t before = view.statistics().conversions;
    view.update();
    CHECK(view.statistics().conversions == before);
    CHECK_FALSE(view.version().pickIndex);
    view.versionToPick();
    view.update();
    REQUIRE(view.version().pickIndex);
    CHECK(picksOf(view, *gone) == 0);
    CHECK(picksOf(view, *come) == 1);
}
