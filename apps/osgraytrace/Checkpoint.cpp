// Checkpoint.cpp - sums as channels of 32 bits. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Checkpoint.h"

#include "apps/common/Failure.h"
#include "apps/common/Output.h"
#include "osgPlugins/exr/ExrPlanes.h"
#include "osgRayTrace/base/NumberText.h"

#include <osgRayTrace/RayTraceSettings>

#include <sstream>

namespace osgRayTrace::app
{

namespace
{

using engine::ExrPlanes;

// Attributes of the header.
const char* const kFormat = "osgRayTrace.sums"; ///< the version of the layout
const char* const kPasses = "osgRayTrace.passes";
const char* const kPicture = "osgRayTrace.picture";
/// Display-referred, exposure, clear colour, the tone curve if it is not sRGB's, and whether media
/// veil the background.
const char* const kShown = "osgRayTrace.shown";
const char* const kVersion = "1";

const char* const kHalves[] = {"even", "odd"};
const char* const kChannels[] = {"R", "G", "B", "A"};

/// Returns the name of a channel of sums. part: "low" or "high"; word: 0 has the lower 32 bits.
std::string nameOf(const std::string& part, int half, int channel, int word)
{
    return std::string("sum.") + kHalves[half] + '.' + kChannels[channel] + '.' + part +
           (word == 0 ? "0" : "1");
}

void addSums(const std::string& part, const std::vector<std::int64_t>& sums, std::size_t pixels,
             ExrPlanes& planes)
{
    for (int plane = 0; plane < 8; ++plane)
        for (int word = 0; word < 2; ++word)
        {
            engine::ExrIntegers channel;
            channel.name = nameOf(part, plane / 4, plane % 4, word);
            channel.values.resize(pixels);
            const std::int64_t* from = &sums[static_cast<std::size_t>(plane) * pixels];
            for (std::size_t i = 0; i < pixels; ++i)
                channel.values[i] =
                    static_cast<std::uint32_t>(static_cast<std::uint64_t>(from[i]) >> (32 * word));
            planes.integers.push_back(std::move(channel));
        }
}

/// Returns the sums of a part; empty if one of their channels is missing.
std::vector<std::int64_t> sumsOf(const std::string& part, const ExrPlanes& planes,
                                 std::size_t pixels)
{
    std::vector<std::int64_t> sums(8 * pixels);
    for (int plane = 0; plane < 8; ++plane)
    {
        const auto* lower = planes.find(nameOf(part, plane / 4, plane % 4, 0));
        const auto* upper = planes.find(nameOf(part, plane / 4, plane % 4, 1));
        if (!lower || !upper) return {};
        std::int64_t* to = &sums[static_cast<std::size_t>(plane) * pixels];
        for (std::size_t i = 0; i < pixels; ++i)
            to[i] = static_cast<std::int64_t>(static_cast<std::uint64_t>(upper->values[i]) << 32 |
                                              lower->values[i]);
    }
    return sums;
}

void addColors(const PassSums& sums, std::size_t pixels, ExrPlanes& planes)
{
    const osg::ref_ptr<osg::Image> colors = sums.getColorImage();
    if (!colors) throw std::bad_alloc();
    const auto* values = reinterpret_cast<const float*>(colors->data());
    for (std::size_t c = 0; c < 4; ++c)
    {
        engine::ExrChannel channel{kChannels[c], false, std::vector<float>(pixels)};
        for (std::size_t i = 0; i < pixels; ++i)
            channel.values[i] = values[4 * i + c];
        planes.picture.channels.push_back(std::move(channel));
    }
    planes.picture.channels.push_back({"depth.Z", false, sums.depth});
}

std::string shownText(const Checkpoint& checkpoint)
{
    std::string text = checkpoint.sums.displayReferred ? "1" : "0";
    text += ' ' + engine::numberText(checkpoint.exposureEv);
    for (int i = 0; i < 4; ++i)
        text += ' ' + engine::numberText(checkpoint.clearColor[i]);
    if (checkpoint.toneCurve != "srgb" || checkpoint.sums.veiled)
        text += ' ' + checkpoint.toneCurve;
    if (checkpoint.sums.veiled) text += " veiled";
    return text;
}

/// Takes over a text of shownText(). Returns whether it is one.
bool takeShown(const std::string& text, Checkpoint& checkpoint)
{
    std::istringstream words(text);
    std::string word;
    float values[6];
    for (float& value : values)
    {
        words >> word;
        const auto number = engine::parseNumber<float>(word);
        if (!words || !number) return false;
        value = *number;
    }
    checkpoint.sums.displayReferred = values[0] != 0.0f;
    checkpoint.exposureEv = values[1];
    checkpoint.clearColor.set(values[2], values[3], values[4], values[5]);
    if (!(words >> word)) return true;
    checkpoint.toneCurve = word;
    checkpoint.sums.veiled = (words >> word) && word == "veiled";
    return osg::ref_ptr<RayTraceSettings>(new RayTraceSettings)
        ->set("tone-curve", checkpoint.toneCurve);
}

std::string textOf(const ExrPlanes& planes, const char* name)
{
    const auto text = planes.texts.find(name);
    return text == planes.texts.end() ? std::string() : text->second;
}

/// Returns the planes of a checkpoint. Throws std::bad_alloc.
ExrPlanes planesOf(const Checkpoint& checkpoint)
{
    const PassSums& sums = checkpoint.sums;
    const std::size_t pixels = std::size_t(sums.width) * std::size_t(sums.height);
    ExrPlanes planes;
    planes.picture.width = sums.width;
    planes.picture.height = sums.height;
    addColors(sums, pixels, planes);
    addSums("low", sums.low, pixels, planes);
    if (!sums.high.empty()) addSums("high", sums.high, pixels, planes);
    planes.texts = {{kFormat, kVersion},
                    {kPasses, sums.passes},
                    {kPicture, sums.picture},
                    {kShown, shownText(checkpoint)}};
    return planes;
}

} // namespace

void writeCheckpoint(const std::string& path, const Checkpoint& checkpoint)
{
    try
    {
        const std::string problem = engine::writeExrPlanes(path, planesOf(checkpoint));
        if (!problem.empty()) throw cannotWrite(path, problem);
    }
    catch (const std::bad_alloc&)
    {
        throw cannotWrite(path, "there is not enough memory");
    }
}

Checkpoint readCheckpoint(const std::string& path)
{
    ExrPlanes planes;
    const auto refuse = [&path](const std::string& problem) -> Failure
    { return Failure(kCannotLoad, "cannot read " + path + ": " + problem); };
    const std::string problem = engine::readExrPlanes(path, planes);
    if (!problem.empty()) throw refuse(problem);
    if (textOf(planes, kFormat) != kVersion) throw refuse("this is no checkpoint of osgraytrace");

    Checkpoint checkpoint;
    PassSums& sums = checkpoint.sums;
    sums.width = planes.picture.width;
    sums.height = planes.picture.height;
    const std::size_t pixels = std::size_t(sums.width) * std::size_t(sums.height);
    sums.passes = textOf(planes, kPasses);
    sums.picture = textOf(planes, kPicture);
    sums.low = sumsOf("low", planes, pixels);
    if (planes.find(nameOf("high", 0, 0, 0))) sums.high = sumsOf("high", planes, pixels);
    if (const engine::ExrChannel* depth = planes.picture.find("depth.Z"))
        sums.depth = depth->values;
    if (sums.passCount() == 0 || sums.low.empty() || !takeShown(textOf(planes, kShown), checkpoint))
        throw refuse("the checkpoint is damaged");
    return checkpoint;
}

} // namespace osgRayTrace::app
