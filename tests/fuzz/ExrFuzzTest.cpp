// ExrFuzzTest.cpp - damaged OpenEXR files give an image or an error, and take memory within reason.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "CountedMemory.h"
#include "FuzzSeeds.h"
#include "tests/Catch.h"

#include <osg/Image>
#include <osg/Notify>
#include <osgDB/Registry>

#include <cstring>
#include <sstream>
#include <string>
#include <vector>

using namespace osgRayTrace::test;

namespace
{

constexpr int kFiles = 20000; ///< seeds

/// This is the plugin's limit for pictures that a file of a few KiB claims to hold, times the
/// number of channels and formats.
constexpr std::size_t kMostBytes = std::size_t(700) << 20;

osgDB::ReaderWriter* exrPlugin()
{
    static osgDB::ReaderWriter* plugin =
        osgDB::Registry::instance()->getReaderWriterForExtension("exr");
    return plugin;
}

/// Returns a file as our plugin writes it.
std::string validFile(Dice& dice)
{
    constexpr GLenum kFormats[] = {GL_RGBA, GL_RGB, GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_ALPHA};
    const char* const kOptions[] = {"", "half", "compression=piz", "compression=none half",
                                    "compression=none"};
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(1 + dice.below(40), 1 + dice.below(70), 1, dice.oneOf(kFormats), GL_FLOAT);
    auto* values = reinterpret_cast<float*>(image->data());
    const bool smooth = dice.oneIn(2); // smooth pictures compress well: the chunks are short
    for (unsigned int i = 0; i < image->getTotalSizeInBytes() / sizeof(float); ++i)
        values[i] =
            smooth ? static_cast<float>(i % 7) : static_cast<float>(dice.between(-1.0, 3.0));
    std::ostringstream stream;
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(dice.oneOf(kOptions));
    REQUIRE(exrPlugin()->writeImage(*image, stream, options).success());
    return stream.str();
}

/// Writes a number of 32 bits to a place of the file that holds one.
void putNumber(std::string& file, std::size_t at, uint32_t value)
{
    if (at + sizeof(value) <= file.size()) std::memcpy(&file[at], &value, sizeof(value));
}

/// Returns where the value of a header's attribute begins, or npos if the header has no such
/// attribute.
std::size_t valueOf(const std::string& file, const std::string& name, const std::string& type)
{
    const std::string key = name + '\0' + type + '\0';
    const std::size_t at = file.find(key);
    return at == std::string::npos ? at : at + key.size() + 4;
}

void editHeader(std::string& file, Dice& dice)
{
    struct Attribute
    {
        const char *name, *type;
        int numbers;
    };
    constexpr Attribute kAttributes[] = {
        {"dataWindow", "box2i", 4},       {"dataWindow", "box2i", 4},
        {"displayWindow", "box2i", 4},    {"compression", "compression", 1},
        {"lineOrder", "lineOrder", 1},    {"channels", "chlist", 8},
        {"pixelAspectRatio", "float", 1}, {"screenWindowWidth", "float", 1}};
    constexpr uint32_t kNumbers[] = {
        0u,       1u,          2u,          3u,          7u,          15u,
        31u,      255u,        4095u,       16383u,      65535u,      (1u << 20) - 1,
        1u << 20, 0x7fffffffu, 0x80000000u, 0xffffffffu, 0xfffffff0u, 0xfff00000u};
    const Attribute attribute = dice.oneOf(kAttributes);
    const std::size_t at = valueOf(file, attribute.name, attribute.type);
    if (at == std::string::npos) return;
    const std::size_t number = static_cast<std::size_t>(dice.below(attribute.numbers));
    if (dice.oneIn(12)) // changes the attribute's size
        putNumber(file, at - 4, dice.oneOf(kNumbers));
    else if (attribute.numbers == 1 && dice.oneIn(2))
        file[at] = static_cast<char>(dice.below(12));
    else
        putNumber(file, at + 4 * number, dice.oneOf(kNumbers));
}

void damage(std::string& file, Dice& dice)
{
    const int way = dice.below(6);
    way < kDamages ? damageBytes(file, way, dice) : editHeader(file, dice);
}

} // namespace

TEST_CASE("fuzz: a damaged .exr file gives an error or an image, and no absurd allocation",
          "[fuzz]")
{
    osg::setNotifyLevel(osg::FATAL);
    REQUIRE(exrPlugin());
    int images = 0, errors = 0;
    forEachSeed(kFiles,
                [&](uint32_t seed)
                {
                    Dice dice(seed);
                    std::string file = validFile(dice);
                    for (int i = 1 + dice.below(3); i > 0 && !file.empty(); --i)
                        damage(file, dice);
                    std::istringstream stream(file);
                    const char* const kOptions[] = {"", "half", "srgb8"};
                    const osg::ref_ptr<osgDB::Options> options =
                        new osgDB::Options(dice.oneOf(kOptions));
                    takeMemoryPeak();
                    osgDB::ReaderWriter::ReadResult result =
                        exrPlugin()->readImage(stream, options);
                    const MemoryPeak peak = takeMemoryPeak();
                    CAPTURE(peak.single, file.size());
                    REQUIRE(peak.total < kMostBytes);
                    if (result.success())
                    {
                        ++images;
                        REQUIRE(result.getImage()->s() > 0);
                        REQUIRE(result.getImage()->data());
                    }
                    else
                    {
                        ++errors;
                        REQUIRE_FALSE(result.message().empty());
                    }
                });
    // The damage is neither always fatal nor never.
    CHECK(images > seedCount(kFiles) / 50);
    CHECK(errors > seedCount(kFiles) / 4);
}
