// ExrRead.cpp - selects channels and reads them row by row. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/exr/ExrError.h"
#include "osgPlugins/exr/ExrHeader.h"
#include "osgPlugins/exr/ExrImage.h"
#include "osgPlugins/exr/ExrStreams.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <algorithm>
#include <fstream>

namespace osgRayTrace::engine
{

namespace
{

constexpr long long kMaxValues = 1LL << 30;

/// Returns the named channels, empty of values. Throws if a channel has other rows than the others.
std::vector<ExrChannel> selectChannels(const Imf::ChannelList& list,
                                       const std::vector<std::string>& wanted)
{
    std::vector<ExrChannel> channels;
    for (auto it = list.begin(); it != list.end(); ++it)
    {
        const Imf::Channel& channel = it.channel();
        const std::string name = it.name();
        if (channel.xSampling != 1 || channel.ySampling != 1)
        {
            throw std::runtime_error("channel '" + name +
                                     "' has a lower resolution, which is not supported");
        }
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end())
            continue;
        channels.push_back({name, channel.type == Imf::HALF, {}});
    }
    return channels;
}

/// Returns a frame buffer in which each channel's row goes to its own part of row, whatever y is.
Imf::FrameBuffer rowFrameBuffer(const ExrImage& image, const Imath::Box2i& dataWindow,
                                std::vector<float>& row)
{
    const std::intptr_t rowWidth =
        static_cast<std::intptr_t>(dataWindow.max.x) - dataWindow.min.x + 1;
    row.resize(rowWidth * image.channels.size());

    Imf::FrameBuffer frameBuffer;
    for (std::size_t i = 0; i < image.channels.size(); ++i)
    {
        // OpenEXR adds x * stride for an x that begins at the data window: the base lies before the
        // row.
        const std::intptr_t first = rowWidth * static_cast<std::intptr_t>(i) - dataWindow.min.x;
        const std::intptr_t base = reinterpret_cast<std::intptr_t>(row.data()) +
                                   first * static_cast<std::intptr_t>(sizeof(float));
        frameBuffer.insert(image.channels[i].name,
                           Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base), sizeof(float), 0));
    }
    return frameBuffer;
}

ExrImage readImage(Imf::IStream& stream, const std::vector<std::string>& wanted)
{
    Imf::InputFile file(stream);
    if (!file.isComplete()) throw std::runtime_error("the file is not complete");

    const Imath::Box2i data = file.header().dataWindow();
    const Imath::Box2i display = file.header().displayWindow();
    ExrImage image;
    image.width = display.max.x - display.min.x + 1;
    image.height = display.max.y - display.min.y + 1;
    image.channels = selectChannels(file.header().channels(), wanted);

    const long long pixels = static_cast<long long>(image.width) * image.height;
    if (pixels * static_cast<long long>(image.channels.size()) > kMaxValues)
    {
        throw std::runtime_error("so many channels of this size are too large");
    }
    for (ExrChannel& channel : image.channels)
        channel.values.assign(pixels, 0.0f);
    if (image.channels.empty()) return image;

    std::vector<float> row;
    file.setFrameBuffer(rowFrameBuffer(image, data, row));
    const std::size_t rowWidth = row.size() / image.channels.size();

    const int beginX = std::max(data.min.x, display.min.x);
    const int endX = std::min(data.max.x, display.max.x) + 1;
    const int endY = std::min(data.max.y, display.max.y) + 1;
    for (int y = std::max(data.min.y, display.min.y); y < endY && beginX < endX; ++y)
    {
        file.readPixels(y);
        const std::size_t imageRow = image.height - 1 - (y - display.min.y);
        for (std::size_t i = 0; i < image.channels.size(); ++i)
        {
            const float* from = row.data() + i * rowWidth + (beginX - data.min.x);
            std::copy_n(from, endX - beginX,
                        image.channels[i].values.begin() + imageRow * image.width +
                            (beginX - display.min.x));
        }
    }
    return image;
}

} // namespace

std::string readExr(std::istream& stream, ExrImage& image, const std::vector<std::string>& wanted)
{
    return caught(
        [&]
        {
            const std::string problem = checkExrHeader(stream);
            if (!problem.empty()) return problem;
            ExrInputStream input(stream);
            image = readImage(input, wanted);
            return problem;
        });
}

std::string readExr(const std::string& path, ExrImage& image,
                    const std::vector<std::string>& wanted)
{
    std::ifstream stream(path, std::ios::binary);
    if (!stream) return "the file cannot be opened";
    return readExr(stream, image, wanted);
}

} // namespace osgRayTrace::engine
