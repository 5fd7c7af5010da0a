// LivePatchesTest.cpp - edits that are redone alone look as in a fresh conversion. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/AreaLight>

#include <functional>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

TEST_CASE("live patches: lamps, shared state and tiles that change places are patched", "[bridge]")
{
    LiveGraph graph;
    osg::ref_ptr<AreaLight> lamp = new AreaLight;
    lamp->setCorner(osg::Vec3(0.0f, 0.0f, 3.0f));
    graph.root->addChild(lamp);
    LiveView view(graph.root.get());
    view.image();
    const auto edit = [&](const char* what, const std::function<void()>& change)
    {
        INFO(what);
        const Statistics before = view.statistics();
        change();
        view.update();
        const std::vector<float> image = view.image();
        CHECK(view.statistics().patches == before.patches + 1);
        CHECK(view.statistics().conversions == before.conversions);
        const int different = differentPixels(image, freshImage(*graph.root, view.passes()));
        CHECK(different >= 0);
        CHECK(different <= kRoundedPixels);
    };
    edit("radiance", [&] { lamp->setRadiance(osg::Vec3(7.0f, 2.0f, 1.0f)); });
    const osg::ref_ptr<osg::StateSet> shared = graph.objects[0]->getStateSet();
    edit("one state for all",
         [&]
         {
             for (const osg::ref_ptr<osg::MatrixTransform>& object : graph.objects)
                 object->setStateSet(shared);
         });
    edit("that state", [&] { shared->setTextureAttributeAndModes(0, graph.texture); });
    edit("its material", [&]
         { graph.materials[0]->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 0, 0, 1)); });
    const osg::ref_ptr<osg::MatrixTransform> moved = graph.objects[3];
    edit("out of the flat BVH", [&] { moved->setMatrix(osg::Matrixd::translate(0.2, 1.1, 0.3)); });
    edit("another parent",
         [&]
         {
             graph.group->removeChild(moved);
             graph.root->insertChild(0, moved);
         });
    edit("a state of its own", [&] { moved->setStateSet(new osg::StateSet); });
    edit("hidden", [&] { moved->setNodeMask(0); });
    edit("shown", [&] { moved->setNodeMask(0xffffffffu); });
}
