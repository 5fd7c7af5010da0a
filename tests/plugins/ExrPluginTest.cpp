// ExrPluginTest.cpp - osgdb_exr and its channels. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "ExrFiles.h"
#include "tests/Catch.h"
#include "tests/plugins/TemporaryFolder.h"

#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <half.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <sys/resource.h>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float& valueAt(osg::Image& image, int x, int y, int component)
{
    return reinterpret_cast<float*>(image.data(x, y))[component];
}

void requireSamePixels(const osg::Image& a, const osg::Image& b)
{
    REQUIRE(a.s() == b.s());
    REQUIRE(a.t() == b.t());
    REQUIRE(a.getPixelFormat() == b.getPixelFormat());
    REQUIRE(a.getDataType() == b.getDataType());
    REQUIRE(a.getTotalSizeInBytes() == b.getTotalSizeInBytes());
    REQUIRE(std::memcmp(a.data(), b.data(), a.getTotalSizeInBytes()) == 0);
}

} // namespace

TEST_CASE("exr: float images come back bit by bit", "[exr]")
{
    const TemporaryFolder folder;
    const int sizes[][2] = {{1, 1}, {1, 7}, {9, 1}, {13, 5}, {70, 33}};
    const GLenum formats[] = {GL_RGB, GL_RGBA, GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_ALPHA};
    for (const std::string options : {"", "compression=zip", "compression=piz", "compression=none"})
    {
        for (const auto& size : sizes)
        {
            for (const GLenum format : formats)
            {
                INFO(options << " " << size[0] << " x " << size[1] << " format " << format);
                const osg::ref_ptr<osg::Image> image = makeImage(size[0], size[1], format);
                REQUIRE(writeImage(*image, folder / "a.exr", options).success());
                auto result = readImage(folder / "a.exr");
                REQUIRE(result.success());
                requireSamePixels(*image, *result.getImage());
            }
        }
    }
}

TEST_CASE("exr: negative, infinite, huge and tiny values and NaN survive as float", "[exr]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Image> image = makeImage(3, 2, GL_RGB);
    const float values[] = {-1.5f,
                            kInfinity,
                            -kInfinity,
                            3.4e38f,
                            1e-45f,
                            -0.0f,
                            std::numeric_limits<float>::quiet_NaN()};
    for (int i = 0; i < 7; ++i)
        valueAt(*image, i % 3, i / 3 % 2, i / 6) = values[i];
    REQUIRE(writeImage(*image, folder / "a.exr").success());
    auto result = readImage(folder / "a.exr");
    REQUIRE(result.success());
    requireSamePixels(*image, *result.getImage());
}

TEST_CASE("exr: half files hold halves, and the largest half in place of what is larger", "[exr]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Image> image = makeImage(40, 30);
    REQUIRE(writeImage(*image, folder / "float.exr", "compression=none").success());
    REQUIRE(writeImage(*image, folder / "half.exr", "half compression=none").success());
    REQUIRE(bytesOf(folder / "half.exr").size() < 0.6 * bytesOf(folder / "float.exr").size());
    requireSamePixels(*image, *readImage(folder / "half.exr").getImage());

    valueAt(*image, 0, 0, 0) = 1e38f;
    valueAt(*image, 0, 0, 1) = -1e38f;
    valueAt(*image, 0, 0, 2) = kInfinity;
    valueAt(*image, 0, 0, 3) = 65519.9f;
    REQUIRE(writeImage(*image, folder / "half.exr", "half").success());
    const osg::ref_ptr<osg::Image> read = readImage(folder / "half.exr").takeImage();
    REQUIRE(read);
    REQUIRE(valueAt(*read, 0, 0, 0) == 65504.0f);
    REQUIRE(valueAt(*read, 0, 0, 1) == -65504.0f);
    REQUIRE(valueAt(*read, 0, 0, 2) == kInfinity);
    REQUIRE(valueAt(*read, 0, 0, 3) == 65504.0f);
}

TEST_CASE("exr: half images are read on request and written as they are", "[exr]")
{
    const TemporaryFolder folder;
    REQUIRE(writeImage(*makeImage(17, 9), folder / "a.exr").success());
    const osg::ref_ptr<osg::Image> halves = readImage(folder / "a.exr", "half").takeImage();
    REQUIRE(halves);
    REQUIRE(halves->getDataType() == GL_HALF_FLOAT);
    REQUIRE(float(reinterpret_cast<half*>(halves->data(2, 1))[1]) == (9 - 3) / 16.0f);

    REQUIRE(writeImage(*halves, folder / "b.exr").success());
    requireSamePixels(*halves, *readImage(folder / "b.exr", "half").getImage());
    ExrImage file;
    REQUIRE(readExr(folder / "b.exr", file).empty());
    REQUIRE(file.channels.front().half);
    REQUIRE(writeImage(*halves, folder / "b.exr", "float").success());
    REQUIRE(readExr(folder / "b.exr", file).empty());
    REQUIRE_FALSE(file.channels.front().half);
}

TEST_CASE("exr: bytes are sRGB, their alpha is linear, and they come back the same", "[exr]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(256, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    for (int x = 0; x < 256; ++x)
        std::memset(image->data(x, 0), x, 4);
    REQUIRE(writeImage(*image, folder / "a.exr").success());

    const osg::ref_ptr<osg::Image> read = readImage(folder / "a.exr").takeImage();
    REQUIRE(read);
    // By IEC 61966-2-1 the middle of the bytes is a fifth of the light.
    REQUIRE(valueAt(*read, 128, 0, 0) == Approx(0.2158605).epsilon(1e-5));
    REQUIRE(valueAt(*read, 10, 0, 1) == Approx(10 / 255.0 / 12.92).epsilon(1e-5));
    REQUIRE(valueAt(*read, 255, 0, 2) == 1.0f);
    REQUIRE(valueAt(*read, 128, 0, 3) == Approx(128 / 255.0));

    for (const std::string options : {"srgb8", "half srgb8"})
    {
        REQUIRE(writeImage(*image, folder / "a.exr", options).success());
        requireSamePixels(*image, *readImage(folder / "a.exr", "srgb8").getImage());
    }
}

TEST_CASE("exr: bytes beyond 0 to 1 are clamped", "[exr]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Image> image = makeImage(1, 1);
    const float values[] = {-3.0f, 1e30f, std::numeric_limits<float>::quiet_NaN(), kInfinity};
    for (int i = 0; i < 4; ++i)
        valueAt(*image, 0, 0, i) = values[i];
    REQUIRE(writeImage(*image, folder / "a.exr").success());
    const osg::ref_ptr<osg::Image> read = readImage(folder / "a.exr", "srgb8").takeImage();
    REQUIRE(read);
    const unsigned char* bytes = read->data();
    REQUIRE(bytes[0] == 0);
    REQUIRE(bytes[1] == 255);
    REQUIRE(bytes[2] == 0);
    REQUIRE(bytes[3] == 255);
}

TEST_CASE("exr: other layouts of osg::Image are written right", "[exr]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Image> image = makeImage(3, 2, GL_BGRA);
    REQUIRE(writeImage(*image, folder / "a.exr").success());
    osg::ref_ptr<osg::Image> read = readImage(folder / "a.exr").takeImage();
    REQUIRE(read);
    REQUIRE(read->getPixelFormat() == GL_RGBA);
    REQUIRE(valueAt(*read, 1, 1, 0) == valueAt(*image, 1, 1, 2));

    // The rows have padding.
    const osg::ref_ptr<osg::Image> padded = new osg::Image;
    padded->allocateImage(3, 2, 1, GL_RGB, GL_UNSIGNED_BYTE, 8);
    std::memset(padded->data(), 77, padded->getTotalSizeInBytes());
    std::memset(padded->data(0, 1), 255, 9);
    REQUIRE(writeImage(*padded, folder / "a.exr").success());
    read = readImage(folder / "a.exr").takeImage();
    REQUIRE(read);
    REQUIRE(valueAt(*read, 0, 1, 0) == 1.0f);
    REQUIRE(valueAt(*read, 2, 1, 2) == 1.0f);

    // The image is stored from the top.
    const osg::ref_ptr<osg::Image> topDown = makeImage(3, 2, GL_RGB);
    topDown->setOrigin(osg::Image::TOP_LEFT);
    REQUIRE(writeImage(*topDown, folder / "a.exr").success());
    read = readImage(folder / "a.exr").takeImage();
    REQUIRE(read);
    REQUIRE(valueAt(*read, 1, 0, 1) == valueAt(*topDown, 1, 1, 1));
}

TEST_CASE("exr: what cannot be written is refused and leaves nothing behind", "[exr]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Image> image = makeImage(4, 4);
    writeBytes(folder / "old.exr", "old");

    const osg::ref_ptr<osg::Image> shorts = new osg::Image;
    shorts->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_SHORT);
    const osg::ref_ptr<osg::Image> volume = new osg::Image;
    volume->allocateImage(2, 2, 2, GL_RGB, GL_FLOAT);
    const osg::ref_ptr<osg::Image> empty = new osg::Image;
    for (const osg::ref_ptr<osg::Image>& bad : {shorts, volume, empty})
    {
        const auto result = writeImage(*bad, folder / "old.exr");
        REQUIRE_FALSE(result.success());
        REQUIRE_FALSE(result.statusMessage().empty());
    }
    REQUIRE_FALSE(writeImage(*image, folder / "old.exr", "compression=best").success());
    REQUIRE(bytesOf(folder / "old.exr") == "old");

    // The folder does not exist, a file has the name of the folder, or a folder has the name of the
    // file.
    REQUIRE_FALSE(writeImage(*image, folder / "missing/a.exr").success());
    REQUIRE_FALSE(writeImage(*image, folder / "old.exr/a.exr").success());
    std::filesystem::create_directory(folder / "folder.exr");
    REQUIRE_FALSE(writeImage(*image, folder / "folder.exr").success());
    REQUIRE(folder.fileNames() == std::vector<std::string>{"folder.exr", "old.exr"});
}

TEST_CASE("exr: a full disk leaves the old file and nothing else", "[exr]")
{
    const TemporaryFolder folder;
    writeBytes(folder / "a.exr", "old");
    const osg::ref_ptr<osg::Image> image = makeImage(200, 200);

    // A limit to the size of files fails as a full disk does.
    rlimit before = {};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
    std::vector<bool> successes;
    for (const rlim_t limitBytes : {0, 100, 1000, 50000, 100000})
    {
        const rlimit limit = {limitBytes, before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
        successes.push_back(writeImage(*image, folder / "a.exr", "compression=none").success());
        setrlimit(RLIMIT_FSIZE, &before);
    }
    std::signal(SIGXFSZ, oldHandler);

    REQUIRE(successes == std::vector<bool>(5, false));
    REQUIRE(bytesOf(folder / "a.exr") == "old");
    REQUIRE(folder.fileNames() == std::vector<std::string>{"a.exr"});
}

TEST_CASE("exr: streams are read and written wherever they stand", "[exr]")
{
    const osg::ref_ptr<osg::Image> image = makeImage(21, 12);
    std::stringstream stream;
    stream << "before";
    REQUIRE(plugin()->writeImage(*image, stream, makeOptions("").get()).success());
    stream << "after";

    stream.seekg(6);
    auto result = plugin()->readImage(stream, makeOptions("").get());
    REQUIRE(result.success());
    requireSamePixels(*image, *result.getImage());

    std::ostringstream broken;
    broken.setstate(std::ios::failbit);
    REQUIRE_FALSE(plugin()->writeImage(*image, broken, makeOptions("").get()).success());
    std::istringstream nothing;
    REQUIRE_FALSE(plugin()->readImage(nothing, makeOptions("").get()).success());
}

TEST_CASE("exr: a missing file is not found, other files are not handled", "[exr]")
{
    const TemporaryFolder folder;
    REQUIRE(readImage(folder / "none.exr").status() ==
            osgDB::ReaderWriter::ReadResult::FILE_NOT_FOUND);
    REQUIRE(readImage(folder / "none.tif").status() ==
            osgDB::ReaderWriter::ReadResult::FILE_NOT_HANDLED);
    const osg::ref_ptr<osg::Image> image = makeImage(1, 1);
    REQUIRE(writeImage(*image, folder / "a.tif").status() ==
            osgDB::ReaderWriter::WriteResult::FILE_NOT_HANDLED);
    REQUIRE(writeImage(*image, folder / "A.EXR").success());
    REQUIRE(readImage(folder / "A.EXR").success());
}

TEST_CASE("exr: channels of any name come back, in the order of their names", "[exr]")
{
    const TemporaryFolder folder;
    const ExrImage image = makeExrImage(7, 3, {"R", "depth.Z", "normal.X", "error"});
    REQUIRE(writeExr(folder / "a.exr", image).empty());
    ExrImage read;
    REQUIRE(readExr(folder / "a.exr", read).empty());
    REQUIRE(read.width == 7);
    REQUIRE(read.height == 3);
    REQUIRE(read.channels.size() == 4);
    for (const ExrChannel& channel : image.channels)
    {
        REQUIRE(read.find(channel.name));
        REQUIRE(read.find(channel.name)->values == channel.values);
    }
    REQUIRE(readExr(folder / "a.exr", read, {"depth.Z", "unknown"}).empty());
    REQUIRE(read.channels.size() == 1);
    REQUIRE(read.channels.front().name == "depth.Z");

    // Without a colour the file holds no picture.
    REQUIRE(writeExr(folder / "a.exr", makeExrImage(7, 3, {"depth.Z"})).empty());
    auto result = readImage(folder / "a.exr");
    REQUIRE_FALSE(result.success());
    REQUIRE_FALSE(result.statusMessage().empty());
}

TEST_CASE("exr: channels that do not fit together are refused", "[exr]")
{
    std::ostringstream stream;
    REQUIRE_FALSE(writeExr(stream, ExrImage()).empty());
    REQUIRE_FALSE(writeExr(stream, makeExrImage(2, 2, {})).empty());
    REQUIRE_FALSE(writeExr(stream, makeExrImage(2, 2, {"R", "R"})).empty());
    REQUIRE_FALSE(writeExr(stream, makeExrImage(2, 2, {""})).empty());
    ExrImage image = makeExrImage(2, 2, {"R", "G"});
    image.channels[1].values.pop_back();
    REQUIRE_FALSE(writeExr(stream, image).empty());
    image = makeExrImage(2, 2, {"R"});
    image.width = -2;
    image.height = -2;
    REQUIRE_FALSE(writeExr(stream, image).empty());
    REQUIRE(stream.str().empty());
}

#ifdef OSGRAYTRACE_TEST_OSGCONV
TEST_CASE("exr: osgconv converts from and to EXR", "[exr]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Image> image = makeImage(30, 20, GL_RGB);
    REQUIRE(writeImage(*image, folder / "a.exr").success());
    const auto convert = [&](const std::string& arguments)
    {
        return std::system(
            (OSGRAYTRACE_TEST_OSGCONV " " + arguments + " >" + (folder / "log")).c_str());
    };

    REQUIRE(convert((folder / "a.exr") + " " + (folder / "b.exr")) == 0);
    requireSamePixels(*image, *readImage(folder / "b.exr").getImage());

    REQUIRE(convert("-O srgb8 " + (folder / "a.exr") + " " + (folder / "b.png")) == 0);
    const osg::ref_ptr<osg::Image> png = osgDB::readRefImageFile(folder / "b.png");
    REQUIRE(png);
    requireSamePixels(*readImage(folder / "a.exr", "srgb8").getImage(), *png);
}
#endif
