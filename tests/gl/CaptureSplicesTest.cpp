// CaptureSplicesTest.cpp - what a cull traversal begins or ceases to draw by programs is redone
// alone. Layer: tests.
// SPDX-License-Identifier: MIT
#include "CullNodes.h"
#include "CullView.h"
#include "tests/Catch.h"

#include <osg/CullFace>
#include <osg/LightSource>
#include <osg/PolygonOffset>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace application
{

/// Shows a part of the children of a group, as terrain shows the tiles near the eye, with a uniform
/// for their program.
class Window : public osg::NodeCallback
{
public:
    Window() { states->addUniform(new osg::Uniform("brightness", 1.0f)); }

    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        osg::Group& group = *node->asGroup();
        osgUtil::CullVisitor* cull = visitor->asCullVisitor();
        if (!cull)
        {
            traverse(node, visitor);
            return;
        }
        cull->pushStateSet(states.get());
        for (unsigned int i = first; i < first + count; ++i)
            group.getChild(i % group.getNumChildren())->accept(*visitor);
        cull->popStateSet();
    }
    const osg::ref_ptr<osg::StateSet> states = new osg::StateSet;
    unsigned int first = 0, count = 3;
};

} // namespace application

namespace
{

constexpr int kTiles = 8;

/// Holds a floor in the sun, and tiles above it that OSG draws, of which a callback shows some.
struct Terrain
{
    Terrain()
    {
        const osg::ref_ptr<osg::LightSource> sun = new osg::LightSource;
        sun->getLight()->setPosition(osg::Vec4(0.0, 0.0, 1.0, 0.0));
        sun->getLight()->setDiffuse(osg::Vec4(1, 1, 1, 1));
        root->addChild(sun);
        root->addChild(osg::createTexturedQuadGeometry(
            osg::Vec3(-3.0f, -3.0f, 0.0f), osg::Vec3(6.0f, 0.0f, 0.0f), osg::Vec3(0, 6.0f, 0)));
        for (int i = 0; i < kTiles; ++i)
            tiles->addChild(newTile(i));
        addProgram(*tiles);
        tiles->setCullCallback(window.get());
        root->addChild(tiles);
    }

    static osg::ref_ptr<osg::MatrixTransform> newTile(int number)
    {
        const osg::ref_ptr<osg::MatrixTransform> tile = new osg::MatrixTransform(
            osg::Matrix::translate(0.6 * number - 2.1, number % 2 ? 0.4 : -0.4, 1.0));
        tile->addChild(plainSquare(0.25f));
        return tile;
    }

    const osg::ref_ptr<osg::Group> root = new osg::Group, tiles = new osg::Group;
    const osg::ref_ptr<application::Window> window = new application::Window;
};

struct TerrainView
{
    explicit TerrainView(const Terrain& terrain)
        : scene(tracedScene(terrain.root.get())), viewer(kViewSize, kViewSize, scene.get())
    {
        scene->getSettings()->setShadows(true);
        scene->getSettings()->setKeepUnchanged(false); // as a view that has just been opened
        viewer.look(osg::Vec3d(2.0, -6.0, 6.0));
    }
    Statistics statistics() { return scene->getDrawable()->getStatistics(); }

    osg::ref_ptr<RayTracedScene> scene;
    TestViewer viewer;
};

constexpr int kFrames = 12; ///< passes until edges are smooth

/// Draws frames, checks that they show and count what a view does that has just been opened, and
/// returns the picture.
osg::ref_ptr<osg::Image> checkAsFresh(const Terrain& terrain, TerrainView& view)
{
    const osg::ref_ptr<osg::Image> picture = view.viewer.frames(kFrames);
    TerrainView fresh(terrain);
    const osg::ref_ptr<osg::Image> wanted = fresh.viewer.frames(kFrames);
    CHECK(meanDifference(*picture, *wanted) < 0.05);
    CHECK(view.statistics().conversion == fresh.statistics().conversion);
    return picture;
}

/// Checks that an edit was a patch, or a conversion.
template <class Edit>
void checkEdit(const Terrain& terrain, TerrainView& view, bool patched, const Edit& edit)
{
    const Statistics before = view.statistics();
    const osg::ref_ptr<osg::Image> then = view.viewer.frames(1);
    edit();
    const osg::ref_ptr<osg::Image> now = checkAsFresh(terrain, view);
    CAPTURE(view.statistics().lastConversionReason, view.statistics().lastConversionPath);
    CHECK(meanDifference(*then, *now) > 0.5);
    CHECK((view.statistics().conversions == before.conversions) == patched);
    CHECK((view.statistics().patches > before.patches) == patched);
}

} // namespace

TEST_CASE("capture splices: a terrain that shows other tiles by programs redoes them alone",
          "[gl][cull]")
{
    Terrain terrain;
    TerrainView view(terrain);
    checkAsFresh(terrain, view);
    REQUIRE(view.statistics().conversion["traced.proxy"] == 3);
    const auto show = [&](unsigned int first, unsigned int count)
    {
        terrain.window->first = first;
        terrain.window->count = count;
    };
    const uint64_t meshes = view.statistics().convertedMeshes;
    checkEdit(terrain, view, true, [&] { show(1, 3); });
    CHECK(view.statistics().convertedMeshes == meshes + 1);
    checkEdit(terrain, view, true, [&] { show(2, 4); });
    checkEdit(terrain, view, true, [&] { show(5, 3); });
    CHECK(view.statistics().conversion["traced.proxy"] == 3);
    CHECK(view.statistics().conversion["rasterized.shader-program"] == 3);
    checkEdit(terrain, view, true, [&] { show(0, 8); });
    checkEdit(terrain, view, true, [&] { show(3, 1); });
    const osg::ref_ptr<osg::MatrixTransform> tile =
        static_cast<osg::MatrixTransform*>(terrain.tiles->getChild(3));
    checkEdit(terrain, view, true, [&] { tile->setMatrix(osg::Matrix::translate(0.0, 1.0, 0.8)); });
    for (unsigned int first = 0; first < 6; ++first) // tiles come back
    {
        show(first, 3);
        view.viewer.frames(1);
    }
    checkEdit(terrain, view, true, [&] { show(2, 2); });
}

TEST_CASE("capture splices: what is traced or in two places is redone alone", "[gl][cull]")
{
    Terrain terrain;
    terrain.window->count = 1;
    const auto child = [&](int number) { return terrain.tiles->getChild(unsigned(number)); };
    const auto next = [&] { ++terrain.window->count; };
    SECTION("tiles that are traced")
    {
        RayTracedScene::setHint(child(1)->asGroup()->getChild(0), RayTracedScene::TRACE);
        child(1)->getOrCreateStateSet()->setAttributeAndModes(
            new osg::Program, osg::StateAttribute::OVERRIDE | osg::StateAttribute::ON);
        TerrainView view(terrain);
        checkAsFresh(terrain, view);
        checkEdit(terrain, view, true, next);
    }
    SECTION("one drawable in two places")
    {
        child(1)->asGroup()->setChild(0, child(0)->asGroup()->getChild(0));
        TerrainView view(terrain);
        checkAsFresh(terrain, view);
        checkEdit(terrain, view, true, next);
        checkEdit(terrain, view, true, next);
        checkEdit(terrain, view, true, [&] { terrain.window->count = 1; });
    }
}

TEST_CASE("capture splices: lines and points that come are counted, and nothing is converted",
          "[gl][cull]")
{
    Terrain terrain;
    for (unsigned int i = 1; i < kTiles; ++i)
        terrain.tiles->getChild(i)->asGroup()->getChild(0)->asGeometry()->setPrimitiveSet(
            0, new osg::DrawArrays(GL_LINE_LOOP, 0, 4));
    terrain.window->count = 2;
    TerrainView view(terrain);
    checkAsFresh(terrain, view);
    const uint64_t conversions = view.statistics().conversions;
    for (const unsigned int count : {4u, 3u, 8u})
    {
        terrain.window->count = count;
        checkAsFresh(terrain, view);
    }
    CHECK(view.statistics().conversions == conversions);
}

TEST_CASE("capture splices: raised squares that are traced come, move and go alone", "[gl][cull]")
{
    Terrain terrain;
    terrain.tiles->getStateSet()->removeAttribute(osg::StateAttribute::PROGRAM);
    terrain.tiles->getStateSet()->setAttributeAndModes(new osg::PolygonOffset(-1.0f, -1.0f));
    terrain.tiles->getStateSet()->setAttributeAndModes(new osg::CullFace);
    const osg::ref_ptr<osg::StateSet> red = application::unlitColor(osg::Vec4(1, 0, 0, 1));
    terrain.window->states->setAttributeAndModes(red->getAttribute(osg::StateAttribute::MATERIAL));
    TerrainView view(terrain);
    checkAsFresh(terrain, view);
    REQUIRE(view.statistics().conversion["converted.culled"] == 3);
    const auto tile = static_cast<osg::MatrixTransform*>(terrain.tiles->getChild(2));
    checkEdit(terrain, view, true, [&] { terrain.window->count = 5; });
    checkEdit(terrain, view, true, [&] { terrain.window->first = 1; });
    checkEdit(terrain, view, true, [&] { tile->setMatrix(osg::Matrix::translate(0.0, 1.0, 0.8)); });
    checkEdit(terrain, view, true, [&] { tile->setMatrix(osg::Matrix::translate(0.0, 1.5, 0.9)); });
    checkEdit(terrain, view, true, [&] { terrain.window->count = 1; });
}

TEST_CASE("capture splices: content that takes turns is never converted", "[gl][cull]")
{
    Terrain terrain;
    const osg::ref_ptr<osg::Group> turning = new osg::Group;
    turning->addChild(Terrain::newTile(2));
    const osg::ref_ptr<application::StatePusher> pusher =
        new application::StatePusher(application::unlitColor(osg::Vec4(1, 0, 0, 1)),
                                     application::unlitColor(osg::Vec4(0, 0, 1, 1)));
    turning->setCullCallback(pusher.get());
    terrain.root->addChild(turning);
    TerrainView view(terrain);
    view.viewer.frames(2);
    const Statistics before = view.statistics();
    view.viewer.frames(6);
    CHECK(view.statistics().conversions == before.conversions);
    CHECK(view.statistics().patches >= before.patches + 5);
    pusher->states[1] = pusher->states[0];
    checkAsFresh(terrain, view);
    CHECK(view.statistics().conversions == before.conversions);
}

TEST_CASE("capture splices: squares that two nodes show are redone below one of them", "[gl][cull]")
{
    Terrain terrain;
    terrain.tiles->getStateSet()->removeAttribute(osg::StateAttribute::PROGRAM);
    const osg::ref_ptr<osg::StateSet> red = application::unlitColor(osg::Vec4(1, 0, 0, 1));
    const osg::ref_ptr<osg::MatrixTransform> aside =
        new osg::MatrixTransform(osg::Matrix::translate(0.0, 1.4, 0.4));
    const osg::ref_ptr<osg::Group> others = new osg::Group;
    for (int i = 0; i < kTiles; ++i)
        others->addChild(terrain.tiles->getChild(unsigned(i)));
    const osg::ref_ptr<application::Window> window = new application::Window;
    for (const auto& shown : {window, terrain.window})
        shown->states->setAttributeAndModes(red->getAttribute(osg::StateAttribute::MATERIAL));
    others->setCullCallback(window.get());
    aside->addChild(others);
    terrain.root->addChild(aside);
    TerrainView view(terrain);
    checkAsFresh(terrain, view);
    REQUIRE(view.statistics().conversion["converted.culled"] == 6);
    const auto move = [&](unsigned int number, double y)
    {
        const auto tile = static_cast<osg::MatrixTransform*>(terrain.tiles->getChild(number));
        tile->setMatrix(osg::Matrix::translate(0.6 * number - 2.1, y, 0.8));
    };
    checkEdit(terrain, view, true, [&] { terrain.window->first = 1; });
    checkEdit(terrain, view, true, [&] { move(2, -1.2); }); // below both
    checkEdit(terrain, view, true, [&] { window->first = 2; });
    checkEdit(terrain, view, true, [&] { move(3, -1.4); });
    checkEdit(terrain, view, true, [&] { terrain.window->count = 1; });
    checkEdit(terrain, view, true, [&] { move(4, 0.9); }); // below one
    checkEdit(terrain, view, true, [&] { terrain.window->count = 4; });
    checkEdit(terrain, view, true, [&] { move(4, -0.9); });
}
