// OccluderTest.cpp - what occluders hide from OSG, traced and rasterized. Layer: tests.
// SPDX-License-Identifier: MIT
#include "PicturePair.h"
#include "tests/Catch.h"

#include <osg/OccluderNode>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

const osg::Vec4 kRed(0.9f, 0.2f, 0.1f, 1.0f), kBlue(0.3f, 0.4f, 0.9f, 1.0f);

void lookAskew(TestViewer& view)
{
    normalize(view);
    view.look(osg::Vec3d(3.0, -6.0, 5.0), osg::Vec3d(0.2, 0.1, 0.0), osg::Vec3d(0.2, 0.0, 1.0));
}

osg::ref_ptr<osg::ShapeDrawable> box(const osg::Vec3& centre, float size, const osg::Vec4& color)
{
    osg::ref_ptr<osg::ShapeDrawable> drawable = new osg::ShapeDrawable(new osg::Box(centre, size));
    drawable->setColor(color);
    return drawable;
}

} // namespace

TEST_CASE("pairs: an occluder in a wall hides what the wall hides", "[gl]")
{
    const auto scene = [](bool withWall)
    {
        const osg::Vec3 corners[] = {
            {-0.5f, -2.3f, 0.2f}, {3.1f, -2.3f, 0.2f}, {3.1f, -2.3f, 3.8f}, {-0.5f, -2.3f, 3.8f}};
        osg::ref_ptr<osg::ConvexPlanarOccluder> polygon = new osg::ConvexPlanarOccluder;
        osg::ref_ptr<osg::Geometry> wall = new osg::Geometry;
        osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
        for (const osg::Vec3& corner : corners)
        {
            polygon->getOccluder().add(corner);
            vertices->push_back(corner);
        }
        wall->setVertexArray(vertices);
        wall->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, 4));
        wall->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        osg::ref_ptr<osg::OccluderNode> occluder = new osg::OccluderNode;
        occluder->setOccluder(polygon);
        if (withWall) occluder->addChild(wall);
        osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(occluder);
        root->addChild(box(osg::Vec3(0.2f, 0.1f, 0.0f), 0.6f, kRed));
        root->addChild(box(osg::Vec3(-2.2f, 0.5f, 0.0f), 1.0f, kBlue));
        return root;
    };
    const PicturePair pair = checkSame(
        "occluder-wall", [&] { return scene(true); }, lookAskew);
    CHECK(pair.count("approximated.occluder") == 1);
    // Without a wall OSG hides the red box, whoever looks at it, and rays do not.
    const PicturePair bare = picturePair(
        "occluder-alone", [&] { return scene(false); }, lookAskew, 2);
    CHECK(bare.count("approximated.occluder") == 1);
    const auto red = [](const osg::Image& image)
    {
        int count = 0;
        for (int y = 0; y < kPairHeight; ++y)
            for (int x = 0; x < kPairWidth; ++x)
                count += pixel(image, x, y).r() > 2.0f * pixel(image, x, y).b();
        return count;
    };
    CHECK(red(*bare.rasterized) == 0);
    CHECK(red(*bare.traced) > 100);
}
