// HdrPluginTest.cpp - osgdb_hdr: what Radiance's files state, and what OSG's own plugin made of
// them. Layer: tests.
// SPDX-License-Identifier: MIT
#include "HdrFiles.h"
#include "tests/Catch.h"
#include "tests/plugins/TemporaryFolder.h"

#include <osg/Texture>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <locale>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns (1, 1/2, 1/4) times 2^n.
Rgbe colored(int n = 0)
{
    return {128, 64, 32, static_cast<std::uint8_t>(129 + n)};
}

osg::Vec3 colorAt(const osg::Image& image, int x, int y)
{
    const float* values = valuesAt(image, x, y);
    return {values[0], values[1], values[2]};
}

osg::ref_ptr<osg::Image> floatImage(int width, int height, GLenum format = GL_RGB)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, format, GL_FLOAT);
    if (format == GL_RGB) image->setInternalTextureFormat(GL_RGB32F_ARB);
    return image;
}

std::string writtenOf(const osg::Image& image, const std::string& options = "")
{
    std::ostringstream stream;
    const osg::ref_ptr<osgDB::Options> parsed = new osgDB::Options(options);
    const auto result = hdrPlugin()->writeImage(image, stream, parsed);
    INFO(result.message());
    REQUIRE(result.success());
    return stream.str();
}

} // namespace

TEST_CASE("hdr: an image as OSG's own plugin makes it: floats, the lowest row first", "[hdr]")
{
    const TemporaryFolder folder;
    std::ofstream(folder / "a.hdr", std::ios::binary)
        << headerOf("-Y 2 +X 1") + flat({colored(3), {255, 0, 1, 128}});
    const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(folder / "a.hdr");
    REQUIRE(image);
    CHECK((image->s() == 1 && image->t() == 2 && image->r() == 1));
    CHECK(image->getPixelFormat() == GL_RGB);
    CHECK(image->getDataType() == GL_FLOAT);
    CHECK(image->getInternalTextureFormat() == GL_RGB32F_ARB);
    CHECK(image->getOrigin() == osg::Image::BOTTOM_LEFT);
    CHECK(image->getFileName() == folder / "a.hdr");
    CHECK(colorAt(*image, 0, 1) == osg::Vec3(8, 4, 2));
    CHECK(colorAt(*image, 0, 0) == osg::Vec3(255.0f / 256, 0, 1.0f / 256));
}

TEST_CASE("hdr: flat, old and new lines hold the same", "[hdr]")
{
    const int lengths[] = {1, 7, 8, 9, 127, 128, 129, 300, 32767, 32768, 70000};
    for (const int length : lengths)
    {
        CAPTURE(length);
        const std::string header = headerOf("-Y 1 +X " + std::to_string(length));
        const Pixels pixels = somePixels(static_cast<std::size_t>(length));
        const auto plain = imageOf(header + flat(pixels));
        CHECK(valuesAt(*plain, length - 1, 0)[0] ==
              std::ldexp(float(pixels.back()[0]), pixels.back()[3] - 136));
        const auto run = imageOf(header + oldRun(colored(), length));
        CHECK(colorAt(*run, 0, 0) == osg::Vec3(1, 0.5f, 0.25f));
        CHECK(colorAt(*run, length - 1, 0) == osg::Vec3(1, 0.5f, 0.25f));
        if (length < 8 || length > 32767) continue;
        const auto lines = imageOf(header + newLine(pixels));
        CHECK(std::memcmp(plain->data(), lines->data(), plain->getTotalSizeInBytes()) == 0);
        const auto newRuns = imageOf(header + newRun(colored(), length));
        CHECK(std::memcmp(run->data(), newRuns->data(), run->getTotalSizeInBytes()) == 0);
    }
    // Each line is of another kind, and a run may follow any pixel.
    const auto mixed = imageOf(headerOf("-Y 3 +X 8") + newRun(colored(), 8) + flat(somePixels(8)) +
                               flat({colored(1), colored(2), {1, 1, 1, 6}}));
    CHECK(colorAt(*mixed, 7, 2) == osg::Vec3(1, 0.5f, 0.25f));
    CHECK(colorAt(*mixed, 0, 0) == osg::Vec3(2, 1, 0.5f));
    CHECK(colorAt(*mixed, 7, 0) == osg::Vec3(4, 2, 1));
}

TEST_CASE("hdr: all eight orientations", "[hdr]")
{
    // The rows give the places of the first two pixels of the file; the picture is three wide and
    // two high.
    struct Order
    {
        const char* resolution;
        int firstX, firstY, secondX, secondY;
    };
    const Order orders[] = {{"-Y 2 +X 3", 0, 1, 1, 1}, {"-Y 2 -X 3", 2, 1, 1, 1},
                            {"+Y 2 +X 3", 0, 0, 1, 0}, {"+Y 2 -X 3", 2, 0, 1, 0},
                            {"+X 3 +Y 2", 0, 0, 0, 1}, {"+X 3 -Y 2", 0, 1, 0, 0},
                            {"-X 3 +Y 2", 2, 0, 2, 1}, {"-X 3 -Y 2", 2, 1, 2, 0}};
    for (const Order& order : orders)
    {
        CAPTURE(order.resolution);
        const auto image =
            imageOf(headerOf(order.resolution) +
                    flat({colored(0), colored(1), colored(2), colored(3), colored(4), colored(5)}));
        REQUIRE((image->s() == 3 && image->t() == 2));
        CHECK(colorAt(*image, order.firstX, order.firstY).x() == 1);
        CHECK(colorAt(*image, order.secondX, order.secondY).x() == 2);
        CHECK(colorAt(*image, 2 - order.firstX, 1 - order.firstY).x() == 32);
        float sum = 0;
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 3; ++x)
                sum += colorAt(*image, x, y).x();
        CHECK(sum == 63);
    }
}

TEST_CASE("hdr: exposure, colour correction and gamma are undone", "[hdr]")
{
    const auto read = [](const std::string& variables)
    { return colorAt(*imageOf(headerOf("-Y 1 +X 1", variables) + flat({colored()})), 0, 0); };
    CHECK(read("EXPOSURE=4\n") == osg::Vec3(0.25f, 0.125f, 0.0625f));
    CHECK(read("EXPOSURE= 4.0e+00\nEXPOSURE=.5\n") == osg::Vec3(0.5f, 0.25f, 0.125f));
    CHECK(read("COLORCORR=1 2 0.5\nEXPOSURE=2\n") == osg::Vec3(0.5f, 0.125f, 0.25f));
    CHECK(read("GAMMA=2\n") == osg::Vec3(1, 0.25f, 0.0625f));
    // Values of pictures that this one was made from are indented and do not count; the other lines
    // are for other programs.
    CHECK(read("\tEXPOSURE=4\n# EXPOSURE=4\nSOFTWARE=EXPOSURE=4\npfilt -e 1\nVIEW= -vtv\n") ==
          osg::Vec3(1, 0.5f, 0.25f));
    // Numbers are read as files write them, whatever the locale says.
    struct Comma : std::numpunct<char>
    {
        char do_decimal_point() const override { return ','; }
    };
    const std::locale before = std::locale::global(std::locale(std::locale(), new Comma));
    CHECK(read("EXPOSURE=.5\n") == osg::Vec3(2, 1, 0.5f));
    std::locale::global(before);
    // Values are never infinite.
    const auto bright =
        imageOf(headerOf("-Y 1 +X 1", "EXPOSURE=1e-20\n") + flat({{255, 255, 0, 255}}));
    CHECK(colorAt(*bright, 0, 0).x() == std::numeric_limits<float>::max());
}

TEST_CASE("hdr: X, Y, Z become red, green and blue", "[hdr]")
{
    std::string header = headerOf("-Y 1 +X 1");
    header.replace(header.find("rgbe"), 4, "xyze");
    // White of 179 candelas is radiance 1: D65 is (0.9505, 1, 1.089).
    const auto image = imageOf(header + flat({{170, 179, 195, 136}}));
    const osg::Vec3 color = colorAt(*image, 0, 0);
    for (int c = 0; c < 3; ++c)
        CHECK(std::fabs(color[c] - 1) < 5e-3);
}

TEST_CASE("hdr: headers as others write them", "[hdr]")
{
    const std::string pixel = flat({colored()});
    for (const std::string header :
         {"#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", "#?RADIANCE\n\n-Y 1 +X 1\n",
          "#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n",
          "#?RADIANCE\nFORMAT = x\nFORMAT=  32-bit_rle_rgbe \n# Made\n\n-Y  1  +X  1\n",
          "#?AUTOPANO\nGAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n"})
    {
        CAPTURE(header);
        CHECK(colorAt(*imageOf(header + pixel), 0, 0) == osg::Vec3(1, 0.5f, 0.25f));
        CHECK(colorAt(*imageOf(header + pixel + "what follows"), 0, 0).x() == 1);
    }
}

TEST_CASE("hdr: the options of OSG's own plugin", "[hdr]")
{
    const std::string file = headerOf("-Y 2 +X 1") + flat({colored(), {51, 102, 255, 0}});
    const auto raw = imageOf(file, "RAW");
    CHECK(raw->getPixelFormat() == GL_RGBA);
    CHECK(raw->getDataType() == GL_FLOAT);
    CHECK(raw->getInternalTextureFormat() == GL_RGBA8);
    CHECK(valuesAt(*raw, 0, 0)[1] == 0.4f);
    CHECK(valuesAt(*raw, 0, 1)[3] == 129 / 255.0f);
    const auto bytes = imageOf(file, "RGB8 RGBMUL 0.5");
    CHECK(bytes->getPixelFormat() == GL_RGB);
    CHECK(bytes->getDataType() == GL_UNSIGNED_BYTE);
    CHECK(int(bytes->data(0, 1)[0]) == 127);
    CHECK(int(bytes->data(0, 1)[2]) == 31);
    CHECK(int(imageOf(file, "RGB8 RGBMUL 9")->data(0, 1)[0]) == 255);
    CHECK(colorAt(*imageOf(file, "YFLIP"), 0, 0).x() == 1);
}

TEST_CASE("hdr: what is written comes back", "[hdr]")
{
    for (const int width : {1, 7, 8, 200, 32767, 32768})
    {
        CAPTURE(width);
        const int height = width > 1000 ? 2 : 5;
        const auto image = floatImage(width, height);
        const Pixels pixels = somePixels(std::size_t(width) * std::size_t(height));
        for (std::size_t i = 0; i < pixels.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                reinterpret_cast<float*>(image->data())[3 * i + c] = std::ldexp(
                    float(pixels[i / 9 % 2 ? i : 3][c]), pixels[i / 9 % 2 ? i : 3][3] - 136);
        const auto again = imageOf(writtenOf(*image));
        REQUIRE((again->s() == width && again->t() == height));
        CHECK(std::memcmp(image->data(), again->data(), image->getTotalSizeInBytes()) == 0);
    }
    // The writer finds runs: it writes two bytes for 127 values.
    const auto black = floatImage(1000, 4);
    std::memset(black->data(), 0, black->getTotalSizeInBytes());
    CHECK(writtenOf(*black).size() < 4 * (4 + 4 * 16) + 80);

    const TemporaryFolder folder;
    REQUIRE(osgDB::writeImageFile(*black, folder / "a.hdr"));
    CHECK(osgDB::readRefImageFile(folder / "a.hdr")->s() == 1000);
}

TEST_CASE("hdr: any value is written as one that a file can hold, to 1/256 of the largest", "[hdr]")
{
    const float inf = std::numeric_limits<float>::infinity();
    const auto image = floatImage(9, 1);
    const float values[9][3] = {
        {1, 0.3f, 0.01f},    {255.9f, 255.4f, 0}, {-1, 2, -0.0f}, {std::nanf(""), 1, 1},
        {inf, 1, 1},         {3e38f, 1, 1},       {1e-39f, 0, 0}, {1e-45f, 1e-45f, 1e-45f},
        {0.998f, 0.9981f, 1}};
    std::memcpy(image->data(), values, sizeof values);
    const auto again = imageOf(writtenOf(*image));
    for (int x = 0; x < 9; ++x)
        for (int c = 0; c < 3; ++c)
        {
            CAPTURE(x, c);
            const float value = values[x][c], most = 255.0f * 0x1p119f;
            const float expected = value > 0 ? std::fmin(value, most) : 0;
            float largest = 0;
            for (const float other : values[x])
                largest = std::fmax(largest, std::fmin(other, most));
            CHECK(std::fabs(valuesAt(*again, x, 0)[c] - expected) <= largest / 255 + 1e-38f);
        }
}

TEST_CASE("hdr: writing takes floats of any layout, bytes as they are, and the options of OSG",
          "[hdr]")
{
    const auto rgba = floatImage(1, 2, GL_RGBA);
    const float values[] = {1, 2, 3, 0.5f, 4, 5, 6, 0.5f};
    std::memcpy(rgba->data(), values, sizeof values);
    CHECK(colorAt(*imageOf(writtenOf(*rgba)), 0, 0) == osg::Vec3(1, 2, 3));
    CHECK(colorAt(*imageOf(writtenOf(*rgba, "NO_YFLIP")), 0, 0) == osg::Vec3(4, 5, 6));
    rgba->setOrigin(osg::Image::TOP_LEFT);
    CHECK(colorAt(*imageOf(writtenOf(*rgba)), 0, 0) == osg::Vec3(4, 5, 6));
    const auto gray = floatImage(1, 1, GL_LUMINANCE);
    *reinterpret_cast<float*>(gray->data()) = 3;
    CHECK(colorAt(*imageOf(writtenOf(*gray)), 0, 0) == osg::Vec3(3, 3, 3));

    // Pixels that readers would take for a run are written as well.
    const std::string file = headerOf("-Y 1 +X 2") + flat({{12, 200, 3, 140}, {2, 2, 2, 129}});
    CHECK(writtenOf(*imageOf(file, "RAW"), "RAW") == file);
    osg::ref_ptr<osg::Image> bytes = new osg::Image;
    bytes->allocateImage(1, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::memcpy(bytes->data(), "\x01\x01\x01\x82", 4);
    CHECK(colorAt(*imageOf(writtenOf(*bytes, "RAW")), 0, 0).x() == std::ldexp(1.0f, 130 - 136));

    // An image that cannot be written leaves the file as it was.
    const TemporaryFolder folder;
    std::ofstream(folder / "a.hdr") << "before";
    for (const std::string options : {"", "RAW"})
    {
        const osg::ref_ptr<osgDB::Options> parsed = new osgDB::Options(options);
        osg::ref_ptr<osg::Image> wrong = new osg::Image;
        wrong->allocateImage(1, 1, 1, GL_RGB, GL_UNSIGNED_BYTE);
        const auto result = hdrPlugin()->writeImage(*wrong, folder / "a.hdr", parsed);
        CHECK_FALSE(result.success());
        CHECK_FALSE(result.message().empty());
    }
    std::string text;
    std::ifstream(folder / "a.hdr") >> text;
    CHECK(text == "before");
}
