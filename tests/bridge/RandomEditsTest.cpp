// RandomEditsTest.cpp - a thousand edits of all kinds while frames are drawn. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/GraphEditor.h"
#include "tests/bridge/LiveGraph.h"
#include "tests/fuzz/FuzzSeeds.h"

#include <random>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

/// Edits a graph; the nodes that the editor adds are its own, and can be removed again.
class Editor
{
public:
    explicit Editor(LiveGraph& graph) : _graph(graph) { graph.root->addChild(_added); }

    void edit()
    {
        switch (number(10))
        {
        case 0:
            add();
            break;
        case 1:
            if (_added->getNumChildren() > 0) _added->removeChild(number(_added->getNumChildren()));
            break;
        case 2:
            object().setMatrix(osg::Matrixd::rotate(real(), 0.0, 0.0, 1.0) *
                               osg::Matrixd::translate(2.0 * real(), 2.0 * real(), real()));
            break;
        case 3:
            _graph.group->setPosition(osg::Vec3d(0.1 * real(), 0.1 * real(), 0.1 * real()));
            break;
        case 4:
            deformTile(*object().getChild(0)->asGeometry(), 0.2f * float(real()));
            break;
        case 5:
            swapStates(object(), object());
            break;
        case 6:
            _graph.materials[number(3)]->setDiffuse(
                osg::Material::FRONT_AND_BACK,
                osg::Vec4(float(real()), float(real()), float(real()), 1.0f));
            break;
        case 7:
            _graph.paint(int(number(256)));
            break;
        case 8:
            _graph.light->getLight()->setPosition(
                osg::Vec4(float(real()), -float(real()), 2.0f + float(real()), 1.0f));
            break;
        case 9:
            object().setNodeMask(number(2) ? 0xffffffffu : 0u);
            break;
        }
    }

    /// Restores the nodes of the beginning; deformed tiles stay as they are.
    void removeAll() { _added->removeChildren(0, _added->getNumChildren()); }

    /// Changes every node of the beginning, so that all of them are dynamic or deforming.
    void touchAll()
    {
        for (int i = 0; i < LiveGraph::kObjects; ++i)
        {
            _graph.objects[std::size_t(i)]->setNodeMask(0xffffffffu);
            _graph.deform(i, 0.1f + 0.01f * float(number(8)));
        }
        _graph.group->setPosition(osg::Vec3d(0.0, 0.0, 0.01 * real()));
    }

private:
    unsigned int number(unsigned int count) { return _random() % count; }
    double real() { return double(_random()) / 4294967296.0; }

    osg::MatrixTransform& object()
    {
        const unsigned int which = number(LiveGraph::kObjects + _added->getNumChildren());
        if (which < LiveGraph::kObjects) return *_graph.objects[which];
        return static_cast<osg::MatrixTransform&>(*_added->getChild(which - LiveGraph::kObjects));
    }

    static void swapStates(osg::Node& a, osg::Node& b)
    {
        const osg::ref_ptr<osg::StateSet> state = a.getStateSet();
        a.setStateSet(b.getStateSet());
        b.setStateSet(state);
    }

    /// Adds a new tile, or one more path to an existing tile.
    void add()
    {
        if (_added->getNumChildren() >= 20) return;
        osg::ref_ptr<osg::MatrixTransform> fresh =
            _graph.newObject(int(number(8)), 2.0 * real(), 2.0 * real());
        fresh->postMult(osg::Matrixd::translate(0.0, 0.0, real())); // in a plane of its own
        if (number(3) == 0) fresh->setChild(0, object().getChild(0));
        _added->insertChild(number(_added->getNumChildren() + 1), fresh);
    }

    LiveGraph& _graph;
    osg::ref_ptr<osg::Group> _added = new osg::Group;
    std::mt19937 _random{20240611};
};

} // namespace

TEST_CASE("random edits: a thousand, and each twentieth picture is that of a fresh conversion",
          "[bridge]")
{
    LiveGraph graph;
    Editor editor(graph);
    LiveView view(graph.root.get());
    int worst = 0;
    for (int i = 0; i < 1000; ++i)
    {
        editor.edit();
        if (i % 7 == 0) editor.edit(); // two edits in one frame
        view.update();
        const std::vector<float> image = view.image();
        if (i % 20) continue;
        CAPTURE(i);
        REQUIRE(view.statistics().ok);
        const int different = differentPixels(image, freshImage(*graph.root, view.passes()));
        worst = std::max(worst, different);
        REQUIRE(different >= 0);
        REQUIRE(different <= kRoundedPixels);
    }
    INFO("most pixels that rounding changed: " << worst);
    const Statistics done = view.statistics();
    CHECK(done.patches > 800); // nearly all edits; some change nothing and need no patch
    CHECK(done.conversions < 50);
    CHECK(done.conversions > 5); // a tile of the static BVH has become shared
    CHECK(done.refitMeshes > 10);
}

TEST_CASE("random edits: objects that are replaced by others at their addresses",
          "[bridge][live-edits]")
{
    forEachSeed(2,
                [](uint32_t seed)
                {
                    osg::ref_ptr<osg::Group> root = new osg::Group;
                    GraphEditor editor(*root, seed);
                    LiveView view(root.get());
                    for (int frame = 1; frame <= 1500; ++frame)
                    {
                        editor.edit();
                        if (frame % 7 == 0) editor.edit(); // two edits in one frame
                        view.update();
                        if (frame % 50) continue;
                        CAPTURE(seed, frame, editor.last());
                        REQUIRE(view.statistics().ok);
                        const std::vector<float>& image = view.image();
                        const int different =
                            differentPixels(image, freshImage(*root, view.passes()));
                        REQUIRE(different >= 0);
                        REQUIRE(different <= kRoundedPixels);
                    }
                });
}

TEST_CASE("random edits: memory comes back", "[bridge]")
{
    LiveGraph graph;
    Editor editor(graph);
    LiveView view(graph.root.get());
    const auto settle = [&]
    {
        for (int i = 0; i < 6; ++i) // each part has two copies
        {
            editor.removeAll();
            editor.touchAll();
            view.update();
            view.image();
        }
        return view.statistics().embreeBytes;
    };
    for (int i = 0; i < 50; ++i)
    {
        editor.edit();
        view.update();
        view.image();
    }
    const uint64_t before = settle();
    for (int round = 0; round < 3; ++round)
    {
        for (int i = 0; i < 100; ++i)
        {
            editor.edit();
            view.update();
            view.image();
        }
        CHECK(settle() <= before + before / 20);
    }
}
