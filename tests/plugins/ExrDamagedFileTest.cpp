// ExrDamagedFileTest.cpp - files that end too early, are garbage or state wrong sizes. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "ExrFiles.h"
#include "tests/Catch.h"
#include "tests/plugins/TemporaryFolder.h"

#include <cstring>
#include <random>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("exr: every truncated file is an error with a message", "[exr]")
{
    const TemporaryFolder folder;
    for (const std::string options :
         {"compression=zip", "compression=piz", "compression=none half"})
    {
        REQUIRE(writeImage(*makeImage(20, 40), folder / "a.exr", options).success());
        const std::string bytes = bytesOf(folder / "a.exr");
        for (std::size_t length = 0; length < bytes.size(); ++length)
        {
            std::istringstream stream(bytes.substr(0, length));
            auto result = plugin()->readImage(stream, makeOptions("").get());
            INFO(options << ", " << length << " of " << bytes.size() << " bytes");
            REQUIRE_FALSE(result.success());
            REQUIRE_FALSE(result.statusMessage().empty());
        }
        writeBytes(folder / "b.exr", bytes.substr(0, bytes.size() - 1));
        REQUIRE(readImage(folder / "b.exr").status() ==
                osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE);
    }
}

TEST_CASE("exr: garbage is an error, and a damaged file at least no crash", "[exr]")
{
    std::mt19937 random(1);
    std::string garbage(5000, '\0');
    for (char& c : garbage)
        c = static_cast<char>(random());
    for (const std::string& bytes : {garbage, std::string("\x76\x2f\x31\x01", 4) + garbage})
    {
        std::istringstream stream(bytes);
        REQUIRE_FALSE(plugin()->readImage(stream, makeOptions("").get()).success());
    }

    std::ostringstream whole;
    REQUIRE(writeExr(whole, makeExrImage(20, 40, {"R", "G", "B", "A"}, true)).empty());
    const std::string bytes = whole.str();
    int errors = 0;
    for (int round = 0; round < 4000; ++round)
    {
        std::string damaged = bytes;
        // Half of the rounds damage the header, where damage has most effects.
        const std::size_t range = round % 2 ? bytes.size() : 400;
        for (int i = 0; i < 1 + round % 3; ++i)
            damaged[random() % range] = static_cast<char>(random());
        std::istringstream stream(damaged);
        ExrImage image;
        if (!readExr(stream, image).empty()) ++errors;
    }
    REQUIRE(errors > 2000);
}

TEST_CASE("exr: a size that the file cannot hold is refused before memory is taken", "[exr]")
{
    std::ostringstream whole;
    REQUIRE(writeExr(whole, makeExrImage(4, 4, {"Y"})).empty());

    // The values minX minY maxX maxY, little endian, stand behind the name, the type and the size.
    const auto withWindows = [&](std::int32_t maxX, std::int32_t maxY)
    {
        std::string bytes = whole.str();
        for (const std::string name : {"dataWindow", "displayWindow"})
        {
            const std::size_t value =
                bytes.find(name) + name.size() + 1 + std::strlen("box2i") + 1 + 4;
            std::memcpy(&bytes[value + 8], &maxX, 4);
            std::memcpy(&bytes[value + 12], &maxY, 4);
        }
        return bytes;
    };
    const std::int32_t windows[][2] = {
        {16383, 16383},           {16384, 16384}, {0x7fffffff, 3}, {3, 0x7fffffff},
        {0x7ffffffe, 0x7ffffffe}, {-2, 3},        {3, -2},         {1 << 20, 0}};
    for (const auto& window : windows)
    {
        INFO(window[0] << ", " << window[1]);
        std::istringstream stream(withWindows(window[0], window[1]));
        ExrImage image;
        REQUIRE_FALSE(readExr(stream, image).empty());
        REQUIRE(image.channels.empty());
    }
    std::istringstream unchanged(withWindows(3, 3));
    ExrImage image;
    REQUIRE(readExr(unchanged, image).empty());
}

TEST_CASE("exr: an attribute of another size than its type's is refused", "[exr]")
{
    std::ostringstream whole;
    REQUIRE(writeExr(whole, makeExrImage(4, 4, {"Y"})).empty());
    // OpenEXR reads the four bytes of a float whatever their number is, and goes on behind them.
    const std::string name = std::string("pixelAspectRatio") + '\0' + "float" + '\0';
    for (const int size : {0, 3, 5, 8})
    {
        std::string bytes = whole.str();
        const std::size_t at = bytes.find(name) + name.size();
        bytes[at] = static_cast<char>(size);
        std::istringstream stream(bytes);
        ExrImage image;
        CAPTURE(size);
        CHECK_THAT(readExr(stream, image), Catch::Contains("another size than its type"));
    }
    std::string channels = whole.str();
    const std::string list = std::string("channels") + '\0' + "chlist" + '\0';
    ++channels[channels.find(list) + list.size()];
    std::istringstream stream(channels);
    ExrImage image;
    CHECK_THAT(readExr(stream, image), Catch::Contains("another size than its type"));
}
