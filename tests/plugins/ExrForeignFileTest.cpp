// ExrForeignFileTest.cpp - OpenEXR files as other programs write them. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/plugins/TemporaryFolder.h"

#include "osgPlugins/exr/ExrImage.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputFile.h>

using namespace osgRayTrace::engine;

namespace
{

/// Returns the value that the tests write at a place of the data window: y counts down from the
/// top.
float pattern(int x, int y)
{
    return x * 1.0f + y * 100.0f;
}

struct Pixels
{
    explicit Pixels(const Imath::Box2i& window)
    {
        for (int y = window.min.y; y <= window.max.y; ++y)
        {
            for (int x = window.min.x; x <= window.max.x; ++x)
                values.push_back(pattern(x, y));
        }
    }

    Imf::Slice slice(const Imath::Box2i& window)
    {
        return Imf::Slice::Make(Imf::FLOAT, values.data(), window);
    }

    std::vector<float> values;
};

void writeScanlines(const std::string& path, const Imath::Box2i& display, const Imath::Box2i& data,
                    Imf::LineOrder order = Imf::INCREASING_Y,
                    Imf::Compression compression = Imf::ZIP_COMPRESSION)
{
    Imf::Header header(display, data, 1, Imath::V2f(0, 0), 1, order, compression);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    Pixels pixels(data);
    Imf::FrameBuffer frameBuffer;
    frameBuffer.insert("Y", pixels.slice(data));
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frameBuffer);
    file.writePixels(data.max.y - data.min.y + 1);
}

/// Requires that the image is the display window: it has the pattern in the data window, 0
/// elsewhere, and row 0 at the bottom.
void requirePattern(const std::string& path, const Imath::Box2i& display, const Imath::Box2i& data)
{
    ExrImage image;
    REQUIRE(readExr(path, image) == "");
    REQUIRE(image.width == display.max.x - display.min.x + 1);
    REQUIRE(image.height == display.max.y - display.min.y + 1);
    REQUIRE(image.find("Y"));
    for (int y = display.min.y; y <= display.max.y; ++y)
    {
        for (int x = display.min.x; x <= display.max.x; ++x)
        {
            const float expected = data.intersects(Imath::V2i(x, y)) ? pattern(x, y) : 0.0f;
            const int row = display.max.y - y;
            const int column = x - display.min.x;
            INFO(x << ", " << y);
            REQUIRE(image.find("Y")->values[row * image.width + column] == expected);
        }
    }
}

Imath::Box2i box(int minX, int minY, int maxX, int maxY)
{
    return Imath::Box2i(Imath::V2i(minX, minY), Imath::V2i(maxX, maxY));
}

} // namespace

TEST_CASE("exr: the image is the display window, wherever the data window lies", "[exr]")
{
    const TemporaryFolder folder;
    const Imath::Box2i display = box(0, 0, 9, 7);
    const Imath::Box2i windows[] = {display,           box(2, 1, 5, 3),     box(-3, -4, 12, 11),
                                    box(-3, 2, 4, 30), box(20, 20, 22, 25), box(9, 7, 9, 7)};
    for (const Imath::Box2i& data : windows)
    {
        writeScanlines(folder / "a.exr", display, data);
        requirePattern(folder / "a.exr", display, data);
    }

    const Imath::Box2i shifted = box(-1000000, 5000, -999990, 5020);
    writeScanlines(folder / "a.exr", shifted, shifted);
    requirePattern(folder / "a.exr", shifted, shifted);
}

TEST_CASE("exr: every lossless compression and both orders of rows are read", "[exr]")
{
    const TemporaryFolder folder;
    const Imath::Box2i window = box(0, 0, 39, 69);
    for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y})
    {
        for (const Imf::Compression compression :
             {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
              Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION})
        {
            writeScanlines(folder / "a.exr", window, window, order, compression);
            requirePattern(folder / "a.exr", window, window);
        }
    }
}

TEST_CASE("exr: tiles are read, with and without smaller levels", "[exr]")
{
    const TemporaryFolder folder;
    const Imath::Box2i window = box(-2, 3, 40, 30);
    for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS})
    {
        Imf::Header header(window, window);
        header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
        header.setTileDescription(Imf::TileDescription(16, 8, mode));
        {
            Pixels pixels(window);
            Imf::TiledOutputFile file((folder / "a.exr").c_str(), header);
            Imf::FrameBuffer frameBuffer;
            frameBuffer.insert("Y", pixels.slice(window));
            file.setFrameBuffer(frameBuffer);
            for (int level = 0; level < file.numLevels(); ++level)
            {
                file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
            }
        }
        requirePattern(folder / "a.exr", window, window);
    }
}

TEST_CASE("exr: the first part of a file with several is read", "[exr]")
{
    const TemporaryFolder folder;
    const Imath::Box2i window = box(0, 0, 8, 6);
    std::vector<Imf::Header> headers;
    for (const char* name : {"first", "second"})
    {
        Imf::Header header(window, window);
        header.setName(name);
        header.setType(Imf::SCANLINEIMAGE);
        header.channels().insert(headers.empty() ? "Y" : "Z", Imf::Channel(Imf::FLOAT));
        headers.push_back(header);
    }
    {
        Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), headers.data(), 2);
        for (int i = 0; i < 2; ++i)
        {
            Pixels pixels(window);
            Imf::OutputPart part(file, i);
            Imf::FrameBuffer frameBuffer;
            frameBuffer.insert(i == 0 ? "Y" : "Z", pixels.slice(window));
            part.setFrameBuffer(frameBuffer);
            part.writePixels(7);
        }
    }
    requirePattern(folder / "a.exr", window, window);
}

TEST_CASE("exr: integers become floats; a channel of lower resolution is refused", "[exr]")
{
    const TemporaryFolder folder;
    std::vector<unsigned int> ids = {0, 1, 70000, 16777216};
    {
        Imf::Header header(2, 2);
        header.channels().insert("id", Imf::Channel(Imf::UINT));
        Imf::FrameBuffer frameBuffer;
        frameBuffer.insert("id", Imf::Slice(Imf::UINT, reinterpret_cast<char*>(ids.data()), 4, 8));
        Imf::OutputFile file((folder / "a.exr").c_str(), header);
        file.setFrameBuffer(frameBuffer);
        file.writePixels(2);
    }
    ExrImage image;
    REQUIRE(readExr(folder / "a.exr", image) == "");
    REQUIRE(image.find("id")->values == std::vector<float>{70000.0f, 16777216.0f, 0.0f, 1.0f});

    {
        Imf::Header header(2, 2);
        header.channels().insert("RY", Imf::Channel(Imf::UINT, 2, 2));
        Imf::FrameBuffer frameBuffer;
        frameBuffer.insert("RY",
                           Imf::Slice(Imf::UINT, reinterpret_cast<char*>(ids.data()), 4, 8, 2, 2));
        Imf::OutputFile file((folder / "a.exr").c_str(), header);
        file.setFrameBuffer(frameBuffer);
        file.writePixels(2);
    }
    REQUIRE(readExr(folder / "a.exr", image).find("RY") != std::string::npos);
}
