// HdrFuzzTest.cpp - damaged Radiance pictures give an image or an error, and take memory within
// reason. Layer: tests.
// SPDX-License-Identifier: MIT
#include "CountedMemory.h"
#include "FuzzSeeds.h"
#include "tests/plugins/HdrFiles.h"

#include <osg/Notify>

#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;
using namespace osgRayTrace::test;

namespace
{

constexpr int kFiles = 40000; ///< seeds

/// The bytes of the file and of the image, for the 2^24 pixels that a small file may hold.
constexpr std::size_t kMostBytes = std::size_t(400) << 20;

Rgbe anyPixel(Dice& dice)
{
    Rgbe pixel;
    for (std::uint8_t& value : pixel)
        value = static_cast<std::uint8_t>(dice.oneIn(4) ? dice.below(3) : dice.below(256));
    return pixel;
}

std::string anyLine(int length, Dice& dice)
{
    const bool mayBeNew = length >= 8 && length <= 32767;
    if (mayBeNew && dice.oneIn(3)) return newRun(anyPixel(dice), length);
    if (dice.oneIn(3)) return oldRun(anyPixel(dice), length);
    Pixels pixels;
    for (int i = 0; i < length; ++i)
        pixels.push_back(anyPixel(dice));
    return mayBeNew && dice.oneIn(2) ? newLine(pixels) : flat(pixels);
}

/// Returns a file, which may be invalid even before it is damaged: pixels may have values with
/// which lines must not begin.
std::string anyFile(Dice& dice)
{
    const char* const kVariables[] = {"",
                                      "",
                                      "EXPOSURE=1.5\n",
                                      "COLORCORR=1 2 3\nGAMMA=2.2\n",
                                      "\tpcomb\nEXPOSURE=1e-30\n",
                                      "FORMAT=32-bit_rle_xyze\n"};
    const char* const kSigns[] = {"-", "-", "+"};
    constexpr int kSizes[] = {1, 2, 7, 8, 9, 40, 200, 1000};
    const bool columns = dice.oneIn(4);
    const int lines = 1 + dice.below(12), length = dice.oneOf(kSizes);
    std::string resolution = std::string(dice.oneOf(kSigns)) + (columns ? "X " : "Y ");
    resolution += std::to_string(lines) + " " + (dice.oneIn(3) ? "-" : "+") +
                  (columns ? "Y " : "X ") + std::to_string(length);
    std::string file = headerOf(resolution, dice.oneOf(kVariables));
    for (int i = 0; i < lines; ++i)
        file += anyLine(length, dice);
    return file;
}

/// Puts another size into the line of the resolution.
void editResolution(std::string& file, Dice& dice)
{
    const char* const kNumbers[] = {"0",
                                    "1",
                                    "3",
                                    "8",
                                    "-1",
                                    "32768",
                                    "1048576",
                                    "1048577",
                                    "4096",
                                    "16777216",
                                    "2147483647",
                                    "4294967297",
                                    "99999999999999999999",
                                    "x"};
    const std::size_t end = file.find("\n\n");
    if (end == std::string::npos) return;
    const std::size_t line = end + 2;
    const std::size_t from = file.find(' ', line), to = file.find_first_of(" \n", from + 1);
    if (from == std::string::npos || to == std::string::npos) return;
    if (dice.oneIn(2))
        file.replace(from + 1, to - from - 1, dice.oneOf(kNumbers));
    else
    {
        const std::size_t last = file.find('\n', line);
        if (last == std::string::npos || last < to) return;
        const std::size_t number = file.rfind(' ', last);
        file.replace(number + 1, last - number - 1, dice.oneOf(kNumbers));
    }
}

void damage(std::string& file, Dice& dice)
{
    const int way = dice.below(kDamages + 1);
    way < kDamages ? damageBytes(file, way, dice) : editResolution(file, dice);
}

} // namespace

TEST_CASE("fuzz: a damaged .hdr file gives an error or an image, and no absurd allocation",
          "[fuzz]")
{
    osg::setNotifyLevel(osg::FATAL);
    hdrPlugin();
    int images = 0, errors = 0;
    forEachSeed(kFiles,
                [&](uint32_t seed)
                {
                    Dice dice(seed);
                    std::string file = anyFile(dice);
                    for (int i = dice.below(4); i > 0 && !file.empty(); --i)
                        damage(file, dice);
                    const char* const kOptions[] = {"", "RAW", "RGB8 RGBMUL 2", "YFLIP"};
                    const char* options = dice.oneOf(kOptions);
                    takeMemoryPeak();
                    auto result = readHdr(file, options);
                    const MemoryPeak peak = takeMemoryPeak();
                    CAPTURE(peak.single, file.size());
                    REQUIRE(peak.total < kMostBytes);
                    if (!result.success())
                    {
                        ++errors;
                        REQUIRE_FALSE(result.message().empty());
                        return;
                    }
                    ++images;
                    const osg::Image& image = *result.getImage();
                    REQUIRE((image.s() > 0 && image.t() > 0 && image.data()));
                    if (image.getDataType() != GL_FLOAT) return;
                    const auto* values = reinterpret_cast<const float*>(image.data());
                    for (unsigned int i = 0; i < image.getTotalSizeInBytes() / sizeof(float); ++i)
                        if (!std::isfinite(values[i])) FAIL("value " << i << " is " << values[i]);
                });
    // The damage is neither always fatal nor never.
    CHECK(images > seedCount(kFiles) / 8);
    CHECK(errors > seedCount(kFiles) / 4);
}
