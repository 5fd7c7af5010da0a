// RgbeRead.cpp - lines of pixels and runs. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/exr/ExrError.h"
#include "osgPlugins/hdr/RgbeHeader.h"

#include <algorithm>
#include <istream>

namespace osgRayTrace::engine
{

namespace
{

/// A file can be smaller than its pixels by this factor: runs of the old format may be of any
/// length. Below the free pixels a file may be as small as it likes.
constexpr long long kMostPixelsOfByte = 2048, kFreePixels = 1LL << 24;

/// The format of 1991 is for lines of these lengths.
constexpr int kShortestLine = 8, kLongestLine = 0x7fff;

const char* const kTruncated = "the file ends too early";

/// Decodes line after line of a file in memory.
class LineReader
{
public:
    LineReader(const std::string& bytes, int length)
        : _at(reinterpret_cast<const std::uint8_t*>(bytes.data())),
          _end(_at + bytes.size()),
          _length(length)
    {
    }

    /// Writes a line and returns what is wrong; null: nothing. If to is null the line is only
    /// checked, in time in proportion to its bytes.
    const char* read(Rgbe* to)
    {
        const bool mayBeNew = _length >= kShortestLine && _length <= kLongestLine && left() >= 4;
        if (mayBeNew && _at[0] == 2 && _at[1] == 2 && _at[2] < 128) return readNew(to);
        return readOld(to);
    }

private:
    std::ptrdiff_t left() const { return _end - _at; }

    /// Reads one component after the other. A count above 128 is a run of the byte that follows.
    const char* readNew(Rgbe* to)
    {
        if ((_at[2] << 8 | _at[3]) != _length) return "a line has another length than the picture";
        _at += 4;
        for (std::size_t component = 0; component < 4; ++component)
            for (int i = 0; i < _length;)
            {
                if (left() < 2) return kTruncated;
                const int code = *_at++;
                const bool isRun = code > 128;
                const int count = isRun ? code - 128 : code;
                if (count == 0) return "a run is empty";
                if (count > _length - i) return "a run is longer than its line";
                if (!isRun && left() < count) return kTruncated;
                for (int k = 0; to && k < count; ++k)
                    to[i + k][component] = _at[isRun ? 0 : k];
                _at += isRun ? 1 : count;
                i += count;
            }
        return nullptr;
    }

    /// Reads single pixels. (1, 1, 1, n) repeats the pixel before n times; a second such marker in
    /// a row counts 256 times as much, and so on.
    const char* readOld(Rgbe* to)
    {
        int shift = 0;
        for (int i = 0; i < _length; _at += 4)
        {
            if (left() < 4) return kTruncated;
            const Rgbe pixel{_at[0], _at[1], _at[2], _at[3]};
            if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1)
            {
                if (to) to[i] = pixel;
                ++i;
                shift = 0;
                continue;
            }
            if (i == 0) return "a line begins with a run";
            if (shift > 16) return "a run is longer than its line";
            const int count = pixel[3] << shift;
            if (count > _length - i) return "a run is longer than its line";
            if (to) std::fill_n(to + i, count, to[i - 1]);
            i += count;
            shift += 8;
        }
        return nullptr;
    }

    const std::uint8_t* _at;
    const std::uint8_t* _end;
    int _length;
};

/// Reads as many bytes as the longest encoding of so many pixels can have, or all that there are.
std::string readPixelBytes(std::istream& stream, const RgbeOrder& order)
{
    constexpr std::size_t kBlock = std::size_t(1) << 20;
    const std::size_t most =
        static_cast<std::size_t>(order.lines) * (8 * static_cast<std::size_t>(order.length) + 8);
    std::string bytes;
    while (bytes.size() < most && stream)
    {
        const std::size_t before = bytes.size();
        bytes.resize(std::min(most, before + kBlock));
        stream.read(&bytes[before], static_cast<std::streamsize>(bytes.size() - before));
        bytes.resize(before + static_cast<std::size_t>(stream.gcount()));
    }
    return bytes;
}

/// Holds the place of the first pixel of a line, and the step to the next.
struct LinePlace
{
    std::ptrdiff_t first, step;
};

LinePlace placeOf(int line, const RgbeHeader& header)
{
    const RgbeOrder& order = header.order;
    const std::ptrdiff_t across = order.columns ? 1 : header.image.width;
    const std::ptrdiff_t along = order.columns ? header.image.width : 1;
    const std::ptrdiff_t number = order.linesFromEnd ? order.lines - 1 - line : line;
    const std::ptrdiff_t last = order.length - 1;
    return {number * across + (order.pixelsFromEnd ? last * along : 0),
            order.pixelsFromEnd ? -along : along};
}

std::string checkLines(const std::string& bytes, const RgbeOrder& order)
{
    LineReader reader(bytes, order.length);
    for (int line = 0; line < order.lines; ++line)
        if (const char* problem = reader.read(nullptr)) return problem;
    return "";
}

} // namespace

std::string readRgbe(std::istream& stream, RgbeImage& image)
{
    return caught(
        [&]() -> std::string
        {
            RgbeHeader header;
            std::string problem = readRgbeHeader(stream, header);
            if (!problem.empty()) return problem;
            const RgbeOrder& order = header.order;
            const std::string bytes = readPixelBytes(stream, order);
            problem = checkLines(bytes, order);
            if (!problem.empty()) return problem;
            const long long pixels = static_cast<long long>(order.lines) * order.length;
            if (pixels > kFreePixels &&
                pixels / kMostPixelsOfByte > static_cast<long long>(bytes.size()))
                return "the file is too short for its picture";

            header.image.pixels.resize(static_cast<std::size_t>(pixels));
            std::vector<Rgbe> lineOf(static_cast<std::size_t>(order.length));
            LineReader reader(bytes, order.length);
            for (int line = 0; line < order.lines; ++line)
            {
                reader.read(lineOf.data());
                const LinePlace place = placeOf(line, header);
                Rgbe* to = header.image.pixels.data() + place.first;
                for (std::size_t i = 0; i < lineOf.size(); ++i)
                    to[static_cast<std::ptrdiff_t>(i) * place.step] = lineOf[i];
            }
            image = std::move(header.image);
            return "";
        });
}

} // namespace osgRayTrace::engine
