// RasterizerMatchTest.cpp - plain lit models look as OpenGL draws them. Layer: tests.
// Set OSG_FILE_PATH to OpenSceneGraph's sample models.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/NodeVisitor>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgGA/TrackballManipulator>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kWidth = 640, kHeight = 480;

/// The cow is a chrome one: its texture is looked up by the reflected direction.
struct RemoveTextures : osg::NodeVisitor
{
    RemoveTextures() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Node& node) override
    {
        if (node.getStateSet())
            while (!node.getStateSet()->getTextureAttributeList().empty() ||
                   !node.getStateSet()->getTextureModeList().empty())
            {
                const auto unit = static_cast<unsigned int>(
                    std::max(node.getStateSet()->getTextureAttributeList().size(),
                             node.getStateSet()->getTextureModeList().size()) - 1);
                node.getStateSet()->getTextureAttributeList().resize(unit);
                node.getStateSet()->getTextureModeList().resize(unit);
            }
        traverse(node);
    }
};

bool covered(const osg::Image& depth, int x, int y)
{
    return *reinterpret_cast<const float*>(depth.data(x, y)) < 1.0f;
}

/// Away from the silhouette, where a pixel is covered in part.
bool coveredAround(const osg::Image& depth, int x, int y)
{
    if (x < 1 || y < 1 || x > depth.s() - 2 || y > depth.t() - 2) return false;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            if (!covered(depth, x + dx, y + dy)) return false;
    return true;
}

} // namespace

TEST_CASE("rasterizer match: plain lit models differ by less than 2/255", "[gl][osg-data]")
{
    const std::string name = GENERATE("cow.osgt", "cessna.osgt", "glider.osgt", "dumptruck.osgt");
    const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(name);
    if (!model)
    {
        WARN("skipped: " << name << " is not in OSG_FILE_PATH");
        return;
    }
    if (name == "cow.osgt")
    {
        RemoveTextures removeTextures;
        model->accept(removeTextures);
    }
    osg::ref_ptr<RayTracedScene> scene = tracedScene(model.get());
    scene->getSettings()->setPassesPerFrame(16);
    TestViewer view(kWidth, kHeight, scene.get());
    view.camera().setComputeNearFarMode(osg::Camera::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    osg::ref_ptr<osgGA::TrackballManipulator> manipulator = new osgGA::TrackballManipulator;
    view.viewer.setCameraManipulator(manipulator.get());
    view.frames();
    const osg::ref_ptr<osg::Image> traced = view.frames();
    REQUIRE(scene->getDrawable()->getStatistics().ok);
    const osg::ref_ptr<osg::Image> tracedDepth =
        new osg::Image(*view.capture->getDepthImage(), osg::CopyOp::DEEP_COPY_ALL);
    scene->setEnabled(false);
    const osg::ref_ptr<osg::Image> rasterized = view.frames();
    const osg::Image& rasterizedDepth = *view.capture->getDepthImage();

    const double difference = meanDifference(
        *traced, *rasterized, [&](int x, int y)
        { return covered(*tracedDepth, x, y) && covered(rasterizedDepth, x, y); });
    const double inside = meanDifference(
        *traced, *rasterized, [&](int x, int y)
        { return coveredAround(*tracedDepth, x, y) && coveredAround(rasterizedDepth, x, y); });
    int tracedPixels = 0, rasterizedPixels = 0, both = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
        {
            tracedPixels += covered(*tracedDepth, x, y);
            rasterizedPixels += covered(rasterizedDepth, x, y);
            both += covered(*tracedDepth, x, y) && covered(rasterizedDepth, x, y);
        }
    CAPTURE(name, difference, inside, tracedPixels, rasterizedPixels, both);
    CHECK(difference < 2.0);
    CHECK(both > 0.97 * rasterizedPixels);
    CHECK(both > 5000);
    osgDB::writeImageFile(*traced,"/tmp/display/t-"+name+".png");osgDB::writeImageFile(*rasterized,"/tmp/display/r-"+name+".png");
}
