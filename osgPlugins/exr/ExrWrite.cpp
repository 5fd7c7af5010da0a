// ExrWrite.cpp - checks channels and writes them row by row. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/exr/ExrError.h"
#include "osgPlugins/exr/ExrHeader.h"
#include "osgPlugins/exr/ExrImage.h"
#include "osgPlugins/exr/ExrStreams.h"
#include "osgRayTrace/base/OutputFile.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace osgRayTrace::engine
{

namespace
{

/// Returns what is wrong with an image that a caller made; empty if nothing is.
std::string checkImage(const ExrImage& image)
{
    if (!isExrSize(image.width, image.height)) return "an image of this size cannot be written";
    if (image.channels.empty()) return "an image without channels cannot be written";
    for (const ExrChannel& channel : image.channels)
    {
        const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
        if (channel.values.size() != pixels)
            return "channel '" + channel.name + "' has another size";
        if (channel.name.empty() || image.find(channel.name) != &channel)
        {
            return "channel name '" + channel.name + "' is empty or occurs twice";
        }
    }
    return "";
}

Imf::Compression toImf(ExrCompression compression)
{
    switch (compression)
    {
    case ExrCompression::Zip:
        return Imf::ZIP_COMPRESSION;
    case ExrCompression::Piz:
        return Imf::PIZ_COMPRESSION;
    case ExrCompression::None:
        break;
    }
    return Imf::NO_COMPRESSION;
}

half toHalf(float value)
{
    if (!std::isfinite(value)) return half(value);
    return half(std::clamp(value, -static_cast<float>(HALF_MAX), static_cast<float>(HALF_MAX)));
}

/// Writes an image; throws. Only the stream knows whether the table of offsets, which OpenEXR
/// writes last, got there.
void writeImage(std::ostream& stream, const ExrImage& image, ExrCompression compression)
{
    Imf::Header header(image.width, image.height);
    header.compression() = toImf(compression);
    for (const auto& [name, text] : image.texts)
        header.insert(name, Imf::StringAttribute(text));

    const std::size_t width = image.width;
    std::vector<std::vector<float>> floatRows(image.channels.size());
    std::vector<std::vector<half>> halfRows(image.channels.size());
    Imf::FrameBuffer frameBuffer;
    for (std::size_t i = 0; i < image.channels.size(); ++i)
    {
        const ExrChannel& channel = image.channels[i];
        const Imf::PixelType type = channel.half ? Imf::HALF : Imf::FLOAT;
        header.channels().insert(channel.name, Imf::Channel(type));

        // A stride of 0 from row to row has each row written from the same memory.
        floatRows[i].resize(channel.half ? 0 : width);
        halfRows[i].resize(channel.half ? width : 0);
        char* row = channel.half ? reinterpret_cast<char*>(halfRows[i].data())
                                 : reinterpret_cast<char*>(floatRows[i].data());
        frameBuffer.insert(channel.name,
                           Imf::Slice(type, row, channel.half ? sizeof(half) : sizeof(float), 0));
    }

    ExrOutputStream output(stream);
    Imf::OutputFile file(output, header);
    file.setFrameBuffer(frameBuffer);
    for (int y = 0; y < image.height; ++y)
    {
        for (std::size_t i = 0; i < image.channels.size(); ++i)
        {
            const float* from = image.channels[i].values.data() + (image.height - 1 - y) * width;
            if (image.channels[i].half)
                std::transform(from, from + width, halfRows[i].begin(), toHalf);
            else
                std::copy_n(from, width, floatRows[i].begin());
        }
        file.writePixels(1);
    }
}

/// Writes a file; throws.
void writeFile(const std::string& path, const ExrImage& image, ExrCompression compression)
{
    errno = 0;
    std::ofstream stream(path, std::ios::binary);
    const auto check = [&stream]
    {
        if (stream) return;
        throw std::runtime_error(errno ? std::strerror(errno) : "the file cannot be written");
    };
    check();
    try
    {
        writeImage(stream, image, compression);
    }
    catch (const std::exception&)
    {
        check(); // OpenEXR's own words do not tell why a write failed
        throw;
    }
    stream.close();
    check();
}

} // namespace

const ExrChannel* ExrImage::find(const std::string& name) const
{
    const auto it = std::find_if(channels.begin(), channels.end(),
                                 [&](const ExrChannel& channel) { return channel.name == name; });
    return it == channels.end() ? nullptr : &*it;
}

std::string writeExr(const std::string& path, const ExrImage& image, ExrCompression compression)
{
    return caught(
        [&]() -> std::string
        {
            const std::string problem = checkImage(image);
            if (!problem.empty()) return problem;
            writeFileWhole(path, [&](const std::string& temporary)
                           { writeFile(temporary, image, compression); });
            return "";
        });
}

std::string writeExr(std::ostream& stream, const ExrImage& image, ExrCompression compression)
{
    return caught(
        [&]() -> std::string
        {
            const std::string problem = checkImage(image);
            if (!problem.empty()) return problem;

            std::stringstream buffer(std::ios::in | std::ios::out | std::ios::binary);
            writeImage(buffer, image, compression);
            if (!buffer) return "there is not enough memory";
            stream << buffer.rdbuf();
            return stream ? "" : "the stream cannot be written";
        });
}

} // namespace osgRayTrace::engine
