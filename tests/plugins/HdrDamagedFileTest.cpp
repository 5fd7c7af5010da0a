// HdrDamagedFileTest.cpp - Radiance files that end too early or state impossible values. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "HdrFiles.h"
#include "tests/Catch.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("hdr: every truncated file is an error with a message", "[hdr]")
{
    const Rgbe pixel{128, 64, 32, 130};
    const Pixels pixels = somePixels(9);
    for (const std::string& file :
         {headerOf("-Y 2 +X 9", "EXPOSURE=2\n") + newLine(pixels) + newRun(pixel, 9),
          headerOf("-Y 2 +X 9") + flat(pixels) + flat(pixels),
          headerOf("+X 2 -Y 9") + oldRun(pixel, 9) + flat({pixel, {1, 1, 1, 8}})})
    {
        REQUIRE(readHdr(file).success());
        for (std::size_t length = 0; length < file.size(); ++length)
        {
            INFO(length << " of " << file.size() << " bytes of " << file);
            auto result = readHdr(file.substr(0, length));
            REQUIRE(result.status() == osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE);
            REQUIRE_FALSE(result.message().empty());
        }
    }
}

TEST_CASE("hdr: what a file says that cannot be is named", "[hdr]")
{
    const Rgbe pixel{128, 64, 32, 130};
    const std::string eight = "-Y 1 +X 8";
    const auto lineOf = [](const std::string& text) { return headerOf("-Y 1 +X 8") + text; };
    std::string ofOther = newRun(pixel, 8);
    ofOther[3] = 9;
    struct Wrong
    {
        std::string file, message;
    };
    const Wrong wrongs[] = {
        {"", "no Radiance picture"},
        {"garbage", "no Radiance picture"},
        {"#!RADIANCE\n\n-Y 1 +X 1\n1234", "no Radiance picture"},
        {headerOf(eight, "EXPOSURE=0\n"), "EXPOSURE"},
        {headerOf(eight, "EXPOSURE=nan\n"), "EXPOSURE"},
        {headerOf(eight, "EXPOSURE=\n"), "EXPOSURE"},
        {headerOf(eight, "EXPOSURE=1e29\nEXPOSURE=1e29\n"), "EXPOSURE"},
        {headerOf(eight, "COLORCORR=1 2\n"), "COLORCORR"},
        {headerOf(eight, "GAMMA=-1\n"), "GAMMA"},
        {headerOf(eight, "FORMAT=32-bit_rle_ycbcr\n"), "format"},
        {headerOf(eight, std::string(2 << 20, 'x')), "no end"},
        {headerOf("-Y 1"), "resolution"},
        {headerOf("-Y 1 +Y 1"), "resolution"},
        {headerOf("-Y 1 +Z 1"), "resolution"},
        {headerOf("Y 1 X 1"), "resolution"},
        {headerOf("-Y 1 +X 1 1"), "resolution"},
        {headerOf("-Y 99999999999999999999 +X 1"), "resolution"},
        {headerOf("-Y 0 +X 1"), "empty or too large"},
        {headerOf("-Y 1 +X -1"), "empty or too large"},
        {headerOf("-Y 1 +X 1048577"), "empty or too large"},
        {headerOf("-Y 16385 +X 16384"), "empty or too large"},
        {headerOf("-Y 2147483647 +X 2147483647"), "empty or too large"},
        {lineOf(ofOther), "another length"},
        {lineOf(newRun(pixel, 8).substr(0, 4) + std::string("\x89\x01", 2) + std::string(20, 1)),
         "longer than its line"},
        {lineOf(newRun(pixel, 8).substr(0, 4) + std::string("\x7f\x01", 2) + std::string(200, 1)),
         "longer than its line"},
        {lineOf(newRun(pixel, 8).substr(0, 4) + std::string(40, '\0')), "empty"},
        {lineOf(flat({{1, 1, 1, 8}})), "begins with a run"},
        {lineOf(flat({pixel, {1, 1, 1, 8}})), "longer than its line"},
        {lineOf(flat({pixel, {1, 1, 1, 0}, {1, 1, 1, 255}})), "longer than its line"},
        {lineOf(flat({pixel, {1, 1, 1, 0}, {1, 1, 1, 0}, {1, 1, 1, 0}, {1, 1, 1, 0}})),
         "longer than its line"}};
    for (const Wrong& wrong : wrongs)
    {
        INFO(wrong.file.substr(0, 200));
        auto result = readHdr(wrong.file);
        REQUIRE(result.status() == osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE);
        INFO(result.message());
        REQUIRE(result.message().find(wrong.message) != std::string::npos);
    }
}

TEST_CASE("hdr: a size that the file cannot hold is refused before memory is taken", "[hdr]")
{
    // Lines of sixteen bytes claim a million pixels each.
    std::string file = headerOf("-Y 256 +X 1048576");
    for (int y = 0; y < 256; ++y)
        file += oldRun({0, 0, 0, 0}, 1 << 20);
    auto result = readHdr(file);
    REQUIRE_FALSE(result.success());
    CHECK(result.message().find("too short") != std::string::npos);
    // A few such lines are accepted.
    std::string small = headerOf("-Y 4 +X 1048576");
    for (int y = 0; y < 4; ++y)
        small += oldRun({128, 0, 0, 129}, 1 << 20);
    const auto image = imageOf(small);
    CHECK(valuesAt(*image, (1 << 20) - 1, 3)[0] == 1);
}
