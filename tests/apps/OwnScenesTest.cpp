// OwnScenesTest.cpp - our own scenes as viewers open them that know of no stored view, and without
// the scenes' files.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"

#include <osgRayTrace/Renderer>

#include <osg/ShapeDrawable>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

using Catch::Matchers::Contains;
using namespace osgRayTrace;

namespace
{

constexpr int kWidth = 64, kHeight = 48;

osg::ref_ptr<osg::Node> ownScene(const std::string& name)
{
    const osg::ref_ptr<osg::Node> scene =
        osgDB::readRefNodeFile(OSGRAYTRACE_TEST_SOURCE "/data/" + name + ".osgt");
    REQUIRE(scene);
    return scene;
}

/// Returns what camera rays through the pixels of osgviewer's first picture meet: numbers of pixels
/// by the names of geodes.
std::map<std::string, int> seenFirst(osg::Node& scene, const Renderer& renderer)
{
    const osg::Matrixd worldFromClip =
        osg::Matrixd::inverse(renderer.getViewMatrix() * renderer.getProjectionMatrix());
    std::map<std::string, int> pixels;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
        {
            const double u = 2.0 * (x + 0.5) / kWidth - 1.0, v = 2.0 * (y + 0.5) / kHeight - 1.0;
            const osg::ref_ptr<osgUtil::LineSegmentIntersector> ray =
                new osgUtil::LineSegmentIntersector(osg::Vec3d(u, v, -1.0) * worldFromClip,
                                                    osg::Vec3d(u, v, 1.0) * worldFromClip);
            osgUtil::IntersectionVisitor visitor(ray);
            scene.accept(visitor);
            if (!ray->containsIntersections()) continue;
            const osg::NodePath path = ray->getFirstIntersection().nodePath;
            for (const osg::Node* node : path)
                if (!node->getName().empty()) ++pixels[node->getName()];
        }
    return pixels;
}

double meanOf(const osg::Image& image)
{
    double sum = 0.0;
    for (int y = 0; y < image.t(); ++y)
        for (int x = 0; x < image.s(); ++x)
            for (int c = 0; c < 3; ++c)
                sum += image.data(x, y)[c];
    return sum / (3.0 * image.s() * image.t());
}

struct Opening
{
    const char* scene;
    std::vector<const char*> seen; ///< each in 1 % of the pixels at least
};

} // namespace

TEST_CASE("our own scenes open in a plain viewer with what they are about in sight, and lit",
          "[apps][long]")
{
    const Opening openings[] = {
        {"cornell_box",
         {"back wall", "left wall", "right wall", "floor", "short block", "tall block"}},
        {"cornell_box_mirror", {"back wall", "short block", "tall block"}},
        {"cornell_box_tall_mirror", {"back wall", "short block", "tall block"}},
        {"cornell_box_glass", {"back wall", "glass sphere"}},
        {"furnace", {"room"}},
        {"glasses", {"glass sphere", "glass", "left wall", "right wall"}},
        {"grids", {"low grid", "high grid", "standing grid", "floor"}},
        {"prism", {"prism", "light planks", "dark planks"}},
        {"rings", {"gold ring", "silver ring", "copper ring", "looking-glass"}},
        {"terrace", {"chrome", "glass", "plaster", "gold", "pale tiles"}},
    };
    for (const Opening& opening : openings)
    {
        CAPTURE(opening.scene);
        const osg::ref_ptr<osg::Node> scene = ownScene(opening.scene);
        const osg::ref_ptr<Renderer> renderer = new Renderer;
        renderer->setScene(scene);
        renderer->setSize(kWidth, kHeight);
        renderer->setHomeView();
        const std::map<std::string, int> seen = seenFirst(*scene, *renderer);
        for (const char* name : opening.seen)
        {
            const auto found = seen.find(name);
            CAPTURE(name);
            CHECK((found == seen.end() ? 0 : found->second) >= kWidth * kHeight / 100);
        }

        // The light must come from within, not from an outer wall nor from the background.
        renderer->setClearColor(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
        renderer->getSettings()->setMaxPasses(4);
        REQUIRE(renderer->render());
        CHECK(meanOf(*renderer->getDisplayImage()) > 20.0);
    }
}

TEST_CASE("osgraytrace: a stored bound that is smaller than the scene cuts nothing off", "[apps]")
{
    const TemporaryFolder folder;
    // The balls are before and behind the unit sphere for which the view from (0, -4, 0) is made.
    for (const osg::Vec4 ball : {osg::Vec4(0, -2.5f, 0, 0.6f), osg::Vec4(0, 40, 0, 30)})
    {
        CAPTURE(ball.y());
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(new osg::ShapeDrawable(
            new osg::Sphere(osg::Vec3(ball.x(), ball.y(), ball.z()), ball.w())));
        scene->setInitialBound(osg::BoundingSphere(osg::Vec3(), 1.0f));
        scene->setComputeBoundingSphereCallback(new osg::Node::ComputeBoundingSphereCallback);
        REQUIRE(osgDB::writeNodeFile(*scene, folder / "ball.osgt"));
        REQUIRE(osgraytrace(folder, "ball.osgt --size 8 8 --passes 1 -o ball.png").exitCode == 0);
        const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(folder / "ball.png");
        REQUIRE(picture);
        // The ball is grey, unlike the blue background.
        const osg::Vec4 middle = picture->getColor(4u, 4u);
        CHECK(middle.r() > 0.5f);
        CHECK(middle.r() == Approx(middle.b()).margin(0.02));
    }
}

TEST_CASE("osgraytrace: files that a scene names and that are missing are named, and what lacks "
          "them is seen",
          "[apps]")
{
    const TemporaryFolder folder;
    std::filesystem::copy_file(OSGRAYTRACE_TEST_SOURCE "/data/terrace.osgt",
                               folder / "terrace.osgt");
    const Outcome sky =
        osgraytrace(folder, "terrace.osgt --size 16 12 --passes 2 -o terrace.png --report");
    CHECK(sky.exitCode == 0);
    CHECK_THAT(sky.output, Contains("Files that cannot be read:\n         1  environment image\n"
                                    "              sky.exr\n"));
    CHECK_THAT(sky.errors, Contains("sky.exr"));
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(folder / "terrace.png");
    REQUIRE(picture);
    const osg::Vec4 above = picture->getColor(8u, 11u); // magenta in place of the sky
    CHECK(above.r() > 0.9f);
    CHECK(above.g() < 0.1f);
    CHECK(above.b() > 0.9f);

    osg::ref_ptr<osg::Geometry> wall =
        osg::createTexturedQuadGeometry(osg::Vec3(), osg::Vec3(1, 0, 0), osg::Vec3(0, 0, 1));
    wall->setName("wall");
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    image->setFileName("stones.png");
    wall->getOrCreateStateSet()->setTextureAttributeAndModes(0, new osg::Texture2D(image));
    const osg::ref_ptr<osgDB::Options> external = new osgDB::Options("WriteImageHint=UseExternal");
    REQUIRE(osgDB::writeNodeFile(*wall, folder / "wall.osgt", external));
    for (const char* model : {"wall.osgt", "wall.osgt.raytrace"})
    {
        const Outcome texture = osgraytrace(folder, std::string(model) + " --report");
        CAPTURE(model, texture.errors);
        CHECK(texture.exitCode == 0);
        CHECK_THAT(texture.output,
                   Contains("Files that cannot be read:\n         1  texture image\n"
                            "              stones.png, for "));
    }
}
