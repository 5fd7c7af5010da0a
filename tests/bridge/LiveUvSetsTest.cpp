// LiveUvSetsTest.cpp - edits of textures that are looked up by units above 1. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/PhysicalMaterial>

#include <functional>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// Extends the live graph by a material on its first tile, which has coordinates on four units.
struct UvGraph : LiveGraph
{
    UvGraph()
    {
        const auto& first = static_cast<osg::Vec2Array&>(*geometry(0).getTexCoordArray(0));
        for (unsigned int unit = 1; unit < 4; ++unit)
        {
            const osg::ref_ptr<osg::Vec2Array> own = new osg::Vec2Array;
            for (const osg::Vec2& uv : first)
                own->push_back(osg::Vec2(uv.y() * (0.4f + 0.3f * float(unit)), 1.0f - uv.x()));
            geometry(0).setTexCoordArray(unit, own);
        }
        paint(200);
        material->setTexture(PhysicalMaterial::BASE_COLOR_TEXTURE, texture);
        objects[0]->getOrCreateStateSet()->setAttribute(material);
    }

    void setUnit(PhysicalMaterial& of, unsigned int unit) const
    {
        PhysicalMaterial::TexturePlace place;
        place.unit = unit;
        of.setTexturePlace(PhysicalMaterial::BASE_COLOR_TEXTURE, place);
    }

    osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
};

} // namespace

TEST_CASE("live uv sets: other units, other coordinates, another use, a new shape", "[bridge]")
{
    UvGraph graph;
    LiveView view(graph.root);
    view.image();
    const auto edit = [&](const char* what, const std::function<void()>& change)
    {
        INFO(what);
        change();
        const std::vector<float> before = view.lastImage();
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
        CHECK(differentPixels(view.lastImage(), before) > kRoundedPixels);
    };
    edit("unit 3", [&] { graph.setUnit(*graph.material, 3); });
    edit("coordinates",
         [&]
         {
             auto& uvs = static_cast<osg::Vec2Array&>(*graph.geometry(0).getTexCoordArray(3));
             for (osg::Vec2& uv : uvs)
                 uv *= 1.9f;
             uvs.dirty();
         });
    edit("a shape", [&] { graph.deform(0, 0.4f); });
    edit("a shape again", [&] { graph.deform(0, 0.1f); });
    edit("unit 2", [&] { graph.setUnit(*graph.material, 2); });
    edit("another use",
         [&]
         {
             const osg::ref_ptr<osg::MatrixTransform> use =
                 new osg::MatrixTransform(osg::Matrixd::translate(0.5, 0.5, 1.0));
             const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial(*graph.material);
             graph.setUnit(*material, 3);
             use->getOrCreateStateSet()->setAttribute(material);
             use->addChild(&graph.geometry(0));
             graph.group->addChild(use);
         });
    edit("unit 0", [&] { graph.setUnit(*graph.material, 0); });
}
