// EnvironmentsTest.cpp - EnvironmentLight nodes: axes, rotation, images of all kinds, wrong ones.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/shading/PlacedEnvironment.h"

#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"
#include "tests/plugins/TemporaryFolder.h"

#include <osgRayTrace/EnvironmentLight>

#include <osg/Switch>
#include <osgDB/ReadFile>

#include <cmath>
#include <fstream>
#include <limits>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

osg::ref_ptr<osg::Image> floatImage(int width, int height, osg::Vec3 value = {1, 1, 1})
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGB, GL_FLOAT);
    auto* pixels = reinterpret_cast<osg::Vec3*>(image->data());
    std::fill(pixels, pixels + width * height, value);
    return image;
}

/// Returns an image as osgDB leaves it if the file is missing: it has a name and nothing else.
osg::ref_ptr<osg::Image> missingImage()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setFileName("sky.hdr");
    return image;
}

osg::Vec3& pixel(osg::Image& image, int x, int y)
{
    return *reinterpret_cast<osg::Vec3*>(
        image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y)));
}

/// Returns an image of 8 x 4 pixels, black but for the pixel right of the middle above the horizon,
/// and the row at the zenith.
osg::ref_ptr<osg::Image> marked()
{
    osg::ref_ptr<osg::Image> image = floatImage(8, 4, {0, 0, 0});
    pixel(*image, 4, 2) = {1, 2, 3};
    for (int x = 0; x < 8; ++x)
        pixel(*image, x, 3) = {0, 0, 5};
    return image;
}

const Vec3 kMark = glm::normalize(Vec3(0.1f, 1.0f, 0.1f)); ///< direction of the marked pixel

/// Holds a triangle and an environment below a transform.
struct SkyScene
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform;
    osg::ref_ptr<EnvironmentLight> light;
    SceneConverter converter;

    explicit SkyScene(osg::Image* image) : light(new EnvironmentLight(image))
    {
        light->setName("sky");
        root->addChild(triangleGeometry());
        root->addChild(transform);
        transform->addChild(light);
    }

    ConversionResult convert() { return converter.convert(inputFor(root)); }

    /// Returns the radiance from a direction of the world.
    Vec3 radiance(Vec3 direction)
    {
        const ConversionResult result = convert();
        REQUIRE(result.scene->lights.size() == 1);
        return PlacedEnvironment(result.scene->lights[0], 0, nullptr)
            .radiance(glm::normalize(direction));
    }
};

bool near(Vec3 a, Vec3 b)
{
    return glm::length(a - b) < 1e-5f;
}

} // namespace

TEST_CASE("environment light: axes, scale, and a linear scene", "[bridge]")
{
    SkyScene scene(marked());
    CHECK(near(scene.radiance(kMark), Vec3(1, 2, 3)));
    CHECK(near(scene.radiance(Vec3(0, 0, 1)), Vec3(0, 0, 5)));
    CHECK(near(scene.radiance(Vec3(0, 0, -1)), Vec3(0, 0, 0)));
    scene.light->setScale({2.0f, 0.5f, 1.0f});
    CHECK(near(scene.radiance(kMark), Vec3(2, 1, 3)));
    const ConversionResult result = scene.convert();
    CHECK_FALSE(result.scene->displayReferred);
    CHECK(countOf(result, "converted.environment-light") == 1);
    CHECK(result.scene->lights[0].kind == LightKind::Environment);
    CHECK(result.scene->lights[0].environment.visible);
    scene.light->setVisible(false);
    CHECK_FALSE(scene.convert().scene->lights[0].environment.visible);
}

TEST_CASE(
    "environment light: turned by itself and by transforms, whose scale and place do not matter",
    "[bridge]")
{
    SkyScene scene(marked());
    // The rotation takes +y to +x, then the transform takes +x to +z.
    scene.light->setRotation(osg::Quat(-osg::PI_2, osg::Vec3d(0, 0, 1)) * 3.0);
    CHECK(near(scene.radiance(Vec3(1.0f, -0.1f, 0.1f)), Vec3(1, 2, 3)));
    scene.transform->setMatrix(osg::Matrixd::scale(1e3, 1e3, 1e3) *
                               osg::Matrixd::rotate(-osg::PI_2, osg::Vec3d(0, 1, 0)) *
                               osg::Matrixd::translate(1e6, 5.0, -3.0));
    CHECK(near(scene.radiance(Vec3(-0.1f, -0.1f, 1.0f)), Vec3(1, 2, 3)));
    CHECK(countOf(scene.convert(), "approximated.environment-transform") == 0);

    // The transform mirrors: +x becomes -x.
    scene.light->setRotation(osg::Quat());
    scene.transform->setMatrix(osg::Matrixd::scale(-2.0, 2.0, 2.0));
    CHECK(near(scene.radiance(Vec3(-0.1f, 1.0f, 0.1f)), Vec3(1, 2, 3)));
    CHECK(near(scene.radiance(kMark), Vec3(0.0f)));

    // The scale is uneven: the zenith goes where the transform takes it, and the other axes are
    // made perpendicular to it.
    scene.transform->setMatrix(osg::Matrixd::scale(1.0, 2.0, 50.0));
    CHECK(near(scene.radiance(kMark), Vec3(1, 2, 3)));
    CHECK(countOf(scene.convert(), "approximated.environment-transform") == 1);

    // The transform leaves a line: the environment cannot be placed at all.
    scene.transform->setMatrix(osg::Matrixd::scale(0.0, 0.0, 1.0));
    const ConversionResult result = scene.convert();
    CHECK(result.scene->lights.empty());
    CHECK(countOf(result, "skipped.singular-transform") == 1);
}

TEST_CASE("environment light: pixels of all formats; floats are never decoded, bytes are",
          "[bridge]")
{
    osg::ref_ptr<osg::Image> image = floatImage(4, 2, {0.25f, 0.5f, 7.0f});
    CHECK(near(SkyScene(image).radiance(kMark), Vec3(0.25f, 0.5f, 7.0f)));

    osg::ref_ptr<osg::Image> bytes = new osg::Image;
    bytes->allocateImage(4, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::fill(bytes->data(), bytes->data() + 32, static_cast<unsigned char>(188));
    CHECK(glm::length(SkyScene(bytes).radiance(kMark) - Vec3(0.5029f)) < 1e-3f);

    osg::ref_ptr<osg::Image> halfs = new osg::Image;
    halfs->allocateImage(4, 2, 1, GL_RGB, GL_HALF_FLOAT);
    auto* half = reinterpret_cast<uint16_t*>(halfs->data());
    std::fill(half, half + 24, uint16_t(0x3800)); // 1/2
    half[0] = 0x7c00;                             // infinite
    SkyScene halfScene(halfs);
    CHECK(near(halfScene.radiance(kMark), Vec3(0.5f)));
    CHECK(countOf(halfScene.convert(), "repaired.environment-not-finite") == 1);

    osg::ref_ptr<osg::Image> upsideDown = marked();
    upsideDown->setOrigin(osg::Image::TOP_LEFT);
    CHECK(near(SkyScene(upsideDown).radiance(Vec3(0.1f, 1.0f, -0.1f)), Vec3(1, 2, 3)));
    CHECK(near(SkyScene(upsideDown).radiance(Vec3(0, 0, -1)), Vec3(0, 0, 5)));
}

TEST_CASE("environment light: the first row of a .hdr file is the zenith", "[bridge]")
{
    // This is Radiance's format without run lengths: red, green, blue, and an exponent with an
    // offset of 136.
    std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
    for (const char* pixel :
         {"\x80\x40\x20\x8b", "\x80\x80\x80\x81"}) // (1024, 512, 256), (1, 1, 1)
        for (int x = 0; x < 4; ++x)
            file += pixel;
    const TemporaryFolder folder;
    std::ofstream(folder / "sky.hdr", std::ios::binary) << file;
    const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(folder / "sky.hdr");
    REQUIRE(image);
    SkyScene scene(image);
    CHECK(near(scene.radiance(Vec3(0.1f, 1.0f, 0.3f)), Vec3(1024, 512, 256)));
    CHECK(near(scene.radiance(Vec3(0.1f, 1.0f, -0.3f)), Vec3(1, 1, 1)));
}

TEST_CASE("environment light: a cube map has OpenGL's faces", "[bridge]")
{
    // Each face has its own colour; the quarter of +x at s = t = 0 is white: it lies towards (1, 1,
    // 1).
    osg::ref_ptr<osg::TextureCubeMap> cube = new osg::TextureCubeMap;
    for (unsigned int face = 0; face < 6; ++face)
        cube->setImage(face, floatImage(8, 8, {float(face), 0, 0}));
    for (int k = 0; k < 16; ++k)
        pixel(*cube->getImage(0), k % 4, k / 4) = {9, 9, 9};
    SkyScene scene(nullptr);
    scene.light->setCubeMap(cube);
    const Vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int face = 0; face < 6; ++face)
        CHECK(near(scene.radiance(axes[face] + Vec3(0, -0.2f, -0.2f) * float(face == 0)),
                   Vec3(float(face), 0, 0)));
    CHECK(near(scene.radiance(Vec3(1.0f, 0.5f, 0.5f)), Vec3(9.0f)));
    CHECK(near(scene.radiance(Vec3(1.0f, -0.5f, 0.5f)), Vec3(0.0f)));
    CHECK(near(scene.radiance(Vec3(1.0f, 0.5f, -0.5f)), Vec3(0.0f)));
    CHECK(scene.convert().scene->lights[0].environment.image->width == 32);

    cube->setImage(3, floatImage(4, 8));
    CHECK(countOf(scene.convert(), "skipped.environment-light") == 1);
    cube->setImage(3, nullptr);
    CHECK(countOf(scene.convert(), "skipped.environment-light") == 1);
    CHECK(near(scene.radiance(kMark), Vec3(1, 0, 1)));
    cube->setImage(3, missingImage());
    CHECK(countOf(scene.convert(), "missing.environment-image") == 1);
}

TEST_CASE("environment light: bad pixels are replaced and counted", "[bridge][stability 30]")
{
    osg::ref_ptr<osg::Image> image = floatImage(8, 4);
    pixel(*image, 4, 2) = {1.0f, kNan, 1.0f};
    pixel(*image, 5, 2) = {kInf, 1.0f, 1.0f};
    pixel(*image, 3, 2) = {-1.0f, 2.0f, 1.0f};
    pixel(*image, 2, 2) = {3e38f, 2.0f, 1.0f};
    SkyScene scene(image);
    CHECK(near(scene.radiance(kMark), Vec3(0.0f)));
    CHECK(near(scene.radiance(Vec3(-0.1f, 1.0f, 0.1f)), Vec3(0, 2, 1)));
    for (int again = 0; again < 2; ++again) // the second time the image is not converted anew
    {
        const ConversionResult result = scene.convert();
        CHECK(countOf(result, "repaired.environment-not-finite") == 2);
        CHECK(countOf(result, "repaired.environment-negative") == 1);
        CHECK(countOf(result, "repaired.environment-too-bright") == 1);
    }
    for (const Vec3& p : scene.convert().scene->lights[0].environment.image->radiance)
        CHECK((isFinite(p) && p.x >= 0.0f && p.y >= 0.0f && p.z >= 0.0f));
}

TEST_CASE("environment light: a scale that no float can hold is limited and named", "[bridge]")
{
    SkyScene scene(floatImage(4, 2, {1e20f, 1.0f, 0.0f}));
    scene.light->setScale(osg::Vec3(1e9f, 1e9f, 1e38f));
    CHECK(countOf(scene.convert(), "repaired.environment-scale") == 0);
    scene.light->setScale(osg::Vec3(1e30f, 1e9f, 1e38f));
    const ConversionResult result = scene.convert();
    CHECK(countOf(result, "repaired.environment-scale") == 1);
    const Vec3 radiance = result.scene->lights.at(0).radiance;
    CHECK(radiance.x == Approx(1e10f));
    CHECK(radiance.y == 1e9f);
    CHECK(radiance.z == 1e38f); // the image has no blue at all
}

// A compressed image is read as blocks: even if its type is a float, its bytes must not be searched
// for values that are not finite.
TEST_CASE("environment light: the data type of a compressed image does not matter", "[bridge]")
{
    std::vector<unsigned char> blocks(1024, 0xff);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->setImage(8, 4, 1, GL_COMPRESSED_RGB_S3TC_DXT1_EXT, GL_COMPRESSED_RGB_S3TC_DXT1_EXT,
                    GL_FLOAT, blocks.data(), osg::Image::NO_DELETE);
    SkyScene scene(image);
    const ConversionResult result = scene.convert();
    CHECK(countOf(result, "converted.environment-light") == 1);
    CHECK(countOf(result, "repaired.environment-not-finite") == 0);
}

TEST_CASE("environment light: without a usable image it is named, and magenta stands for it",
          "[bridge]")
{
    osg::ref_ptr<osg::Image> empty = new osg::Image;
    osg::ref_ptr<osg::Image> unreadable = new osg::Image;
    unreadable->allocateImage(4, 2, 1, GL_RGB, GL_DOUBLE);
    for (osg::Image* image : {static_cast<osg::Image*>(nullptr), empty.get(), unreadable.get()})
    {
        SkyScene scene(image);
        const ConversionResult result = scene.convert();
        CHECK(near(scene.radiance(kMark), Vec3(1, 0, 1)));
        CHECK(countOf(result, "skipped.environment-light") == 1);
        CHECK(countOf(result, "converted.environment-light") == 0);
    }
    SkyScene lost(missingImage());
    const ConversionResult result = lost.convert();
    CHECK(near(lost.radiance(kMark), Vec3(1, 0, 1)));
    CHECK(countOf(result, "skipped.environment-light") == 0);
    CHECK(countOf(result, "missing.environment-image") == 1);
    CHECK(result.paths.at("missing.environment-image") == std::vector<std::string>{"sky.hdr"});
    SkyScene pixel(floatImage(1, 1, {4, 5, 6}));
    CHECK(near(pixel.radiance(Vec3(0.3f, -0.2f, 0.8f)), Vec3(4, 5, 6)));
}

TEST_CASE("environment light: the first that can be converted counts", "[bridge]")
{
    SkyScene scene(nullptr); // the light has no image
    for (const float value : {2.0f, 3.0f})
        scene.root->addChild(new EnvironmentLight(floatImage(4, 2, {value, value, value})));
    CHECK(near(scene.radiance(kMark), Vec3(2.0f)));
    const ConversionResult result = scene.convert();
    CHECK(countOf(result, "converted.environment-light") == 1);
    CHECK(countOf(result, "skipped.environment-light") == 2);
}

TEST_CASE("environment light: every edit makes a new scene, none keeps the image and its tables",
          "[bridge]")
{
    SkyScene scene(marked());
    osg::ref_ptr<osg::Switch> parent = new osg::Switch;
    parent->addChild(scene.transform);
    scene.root->removeChild(scene.transform);
    scene.root->addChild(parent);
    const ViewingConditions conditions;
    auto last = scene.convert().scene;
    auto hash = graphHash(*scene.root, conditions);
    CHECK(scene.convert().scene == last);
    const auto changed = [&](const char* what, bool keepsImage)
    {
        INFO(what);
        const uint64_t now = graphHash(*scene.root, conditions);
        CHECK(now != hash);
        hash = now;
        const auto next = scene.convert().scene;
        CHECK(next != last);
        if (!next->lights.empty() && !last->lights.empty())
            CHECK((next->lights[0].environment.image == last->lights[0].environment.image) ==
                  keepsImage);
        last = next;
    };
    scene.light->setScale({2, 2, 2});
    changed("scale", true);
    scene.light->setVisible(false);
    changed("visible", true);
    scene.light->setRotation(osg::Quat(1.0, osg::Vec3d(0, 0, 1)));
    changed("rotation", true);
    scene.transform->setMatrix(osg::Matrixd::rotate(1.0, osg::Vec3d(1, 0, 0)));
    changed("transform", true);
    pixel(*scene.light->getImage(), 0, 0) = {7, 7, 7};
    scene.light->getImage()->dirty();
    changed("pixels", false);
    scene.light->setImage(floatImage(2, 1));
    changed("image", false);
    parent->setAllChildrenOff();
    changed("switched off", false);
    CHECK(last->lights.empty());
    parent->setAllChildrenOn();
    changed("switched on", false);
    CHECK(last->lights.size() == 1);
}

TEST_CASE("environment light: values that make no sense are refused, copies are whole", "[bridge]")
{
    osg::ref_ptr<EnvironmentLight> light = new EnvironmentLight(marked());
    light->setScale({1, 2, 3});
    light->setScale({kNan, 1, 1});
    CHECK(light->getScale() == osg::Vec3(1, 2, 3));
    light->setScale({-1, 2, 3});
    CHECK(light->getScale() == osg::Vec3(0, 2, 3));
    light->setRotation(osg::Quat(0.5, osg::Vec3d(0, 1, 0)));
    const osg::Quat rotation = light->getRotation();
    light->setRotation(osg::Quat(0, 0, 0, 0));
    light->setRotation(osg::Quat(double(kNan), 0, 0, 1));
    CHECK(light->getRotation() == rotation);
    light->setVisible(false);
    light->setCubeMap(new osg::TextureCubeMap);
    const osg::ref_ptr<EnvironmentLight> copy = osg::clone(light.get());
    CHECK(copy->getImage() == light->getImage());
    CHECK(copy->getCubeMap() == light->getCubeMap());
    CHECK(copy->getRotation() == rotation);
    CHECK(copy->getScale() == osg::Vec3(0, 2, 3));
    CHECK_FALSE(copy->getVisible());
    CHECK(std::string(copy->className()) == "EnvironmentLight");
    CHECK_FALSE(copy->getBound().valid());
}
