// ExrPlanes.cpp - reads and writes channels of floats and integers, row by row. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/exr/ExrPlanes.h"

#include "osgPlugins/exr/ExrError.h"
#include "osgPlugins/exr/ExrFile.h"
#include "osgPlugins/exr/ExrHeader.h"
#include "osgPlugins/exr/ExrStreams.h"
#include "osgRayTrace/base/OutputFile.h"
#include "osgRayTrace/base/TextFile.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace osgRayTrace::engine
{

namespace
{

/// A row of a channel, of floats or integers.
struct Row
{
    std::string name;
    Imf::PixelType type;
    char* image; ///< the channel's first row, which is the lowest
    std::vector<char> bytes;
};

/// Returns a row for each channel. The planes stay where they are meanwhile.
std::vector<Row> rowsOf(ExrPlanes& planes)
{
    const std::size_t bytes = static_cast<std::size_t>(planes.picture.width) * 4;
    std::vector<Row> rows;
    for (ExrChannel& channel : planes.picture.channels)
        rows.push_back({channel.name, Imf::FLOAT, reinterpret_cast<char*>(channel.values.data()),
                        std::vector<char>(bytes)});
    for (ExrIntegers& channel : planes.integers)
        rows.push_back({channel.name, Imf::UINT, reinterpret_cast<char*>(channel.values.data()),
                        std::vector<char>(bytes)});
    return rows;
}

/// Returns a frame buffer in which each row of the file takes the same memory.
Imf::FrameBuffer frameBufferOf(std::vector<Row>& rows)
{
    Imf::FrameBuffer frameBuffer;
    for (Row& row : rows)
        frameBuffer.insert(row.name, Imf::Slice(row.type, row.bytes.data(), 4, 0));
    return frameBuffer;
}

void checkWindow(const Imf::Header& header)
{
    const Imath::Box2i &data = header.dataWindow(), &display = header.displayWindow();
    if (data.min.x != 0 || data.min.y != 0 || data != display)
        throw std::runtime_error("the pixels do not fill the picture");
}

/// Makes the channels of the file, empty of values.
void makeChannels(const Imf::ChannelList& list, ExrPlanes& planes)
{
    const auto pixels = static_cast<std::size_t>(planes.picture.width) *
                        static_cast<std::size_t>(planes.picture.height);
    for (auto it = list.begin(); it != list.end(); ++it)
    {
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
            throw std::runtime_error(std::string("channel '") + it.name() +
                                     "' has a lower resolution");
        if (it.channel().type == Imf::UINT)
            planes.integers.push_back({it.name(), std::vector<uint32_t>(pixels)});
        else
            planes.picture.channels.push_back({it.name(), false, std::vector<float>(pixels)});
    }
}

ExrPlanes readPlanes(Imf::IStream& stream)
{
    Imf::InputFile file(stream);
    if (!file.isComplete()) throw std::runtime_error("the file is not complete");
    // Without compression the length of the file bounds the memory that its channels take.
    if (file.header().compression() != Imf::NO_COMPRESSION)
        throw std::runtime_error("the file is compressed, as no checkpoint is");
    checkWindow(file.header());
    ExrPlanes planes;
    const int width = file.header().dataWindow().max.x + 1;
    const int height = file.header().dataWindow().max.y + 1;
    planes.picture.width = width;
    planes.picture.height = height;
    for (auto it = file.header().begin(); it != file.header().end(); ++it)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
            planes.texts[it.name()] = text->value();
    makeChannels(file.header().channels(), planes);

    std::vector<Row> rows = rowsOf(planes);
    file.setFrameBuffer(frameBufferOf(rows));
    const std::size_t bytes = static_cast<std::size_t>(width) * 4;
    for (int y = 0; y < height; ++y)
    {
        file.readPixels(y);
        for (const Row& row : rows)
            std::memcpy(row.image + static_cast<std::size_t>(height - 1 - y) * bytes,
                        row.bytes.data(), bytes);
    }
    return planes;
}

void writePlanes(std::ostream& stream, const ExrPlanes& planes)
{
    const int width = planes.picture.width, height = planes.picture.height;
    Imf::Header header(width, height);
    header.compression() = Imf::NO_COMPRESSION;
    for (const auto& [name, text] : planes.texts)
        header.insert(name, Imf::StringAttribute(text));
    // The rows are only read here.
    std::vector<Row> rows = rowsOf(const_cast<ExrPlanes&>(planes));
    for (const Row& row : rows)
        header.channels().insert(row.name, Imf::Channel(row.type));

    ExrOutputStream output(stream);
    Imf::OutputFile file(output, header);
    file.setFrameBuffer(frameBufferOf(rows));
    const std::size_t bytes = static_cast<std::size_t>(width) * 4;
    for (int y = 0; y < height; ++y)
    {
        for (Row& row : rows)
            std::memcpy(row.bytes.data(),
                        row.image + static_cast<std::size_t>(height - 1 - y) * bytes, bytes);
        file.writePixels(1);
    }
}

/// Returns what is wrong with planes that a caller made; empty if nothing is.
std::string checkPlanes(const ExrPlanes& planes)
{
    const int width = planes.picture.width, height = planes.picture.height;
    if (!isExrSize(width, height)) return "an image of this size cannot be written";
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    for (const ExrChannel& channel : planes.picture.channels)
        if (channel.values.size() != pixels)
            return "channel '" + channel.name + "' has another size";
    for (const ExrIntegers& channel : planes.integers)
        if (channel.values.size() != pixels)
            return "channel '" + channel.name + "' has another size";
    return "";
}

} // namespace

const ExrIntegers* ExrPlanes::find(const std::string& name) const
{
    const auto it = std::find_if(integers.begin(), integers.end(),
                                 [&](const ExrIntegers& i) { return i.name == name; });
    return it == integers.end() ? nullptr : &*it;
}

std::string readExrPlanes(const std::string& path, ExrPlanes& planes)
{
    return caught(
        [&]() -> std::string
        {
            const std::string irregularity = irregularityOf(path);
            if (!irregularity.empty()) return irregularity;
            std::ifstream stream(path, std::ios::binary);
            if (!stream) return "the file cannot be opened";
            const std::string problem = checkExrHeader(stream);
            if (!problem.empty()) return problem;
            ExrInputStream input(stream);
            planes = readPlanes(input);
            return "";
        });
}

std::string writeExrPlanes(const std::string& path, const ExrPlanes& planes)
{
    return caught(
        [&]() -> std::string
        {
            const std::string problem = checkPlanes(planes);
            if (!problem.empty()) return problem;
            writeFileWhole(path,
                           [&](const std::string& temporary) {
                               writeExrFile(temporary, [&](std::ostream& stream)
                                            { writePlanes(stream, planes); });
                           });
            return "";
        });
}

} // namespace osgRayTrace::engine
