// ExrHeader.cpp - reads the headers of all parts, whatever they claim. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/exr/ExrHeader.h"

#include <cstdint>
#include <istream>

namespace osgRayTrace::engine
{

namespace
{

// The layout is that of "OpenEXR File Layout", openexr.com: little endian; a header is a list of
// (name \0 type \0 size value) that ends with an empty name, and the list of parts ends with an
// empty header.
constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kMultiPartFlag = 0x1000;
constexpr std::size_t kMaxNameLength = 255;
constexpr long long kMaxScanlinesInChunk = 256;
constexpr long long kOffsetBytes =
    8; ///< size of a chunk's entry in the table that follows the headers

/// A file can be smaller than its pixels by this factor. Deflate writes a bit or more for 129 bytes
/// (a ratio of 1032 at most, and PXR24 leaves out a quarter first), and Huffman codes of PIZ reach
/// less; runs of DWA reach more: see kLargestDwaRatio.
constexpr long long kLargestRatio = 2048;
constexpr long long kLargestDwaRatio = 1 << 16;

/// A display window of so many pixels needs no file of any length: pixels outside of the data
/// window are 0.
constexpr long long kFreePixels = 1LL << 24;

const char* const kTruncated = "the file ends within its header";

struct Box
{
    std::int32_t minX = 0, minY = 0, maxX = -1, maxY = -1;

    long long width() const { return static_cast<long long>(maxX) - minX + 1; }
    long long height() const { return static_cast<long long>(maxY) - minY + 1; }
};

/// Types of attributes whose values OpenEXR reads without asking for their size.
struct FixedSize
{
    const char* type;
    std::int32_t bytes;
};

constexpr FixedSize kFixedSizes[] = {{"box2i", 16},
                                     {"box2f", 16},
                                     {"chromaticities", 32},
                                     {"compression", 1},
                                     {"deepImageState", 1},
                                     {"double", 8},
                                     {"envmap", 1},
                                     {"float", 4},
                                     {"int", 4},
                                     {"keycode", 28},
                                     {"lineOrder", 1},
                                     {"m33d", 72},
                                     {"m33f", 36},
                                     {"m44d", 128},
                                     {"m44f", 64},
                                     {"rational", 8},
                                     {"tiledesc", 9},
                                     {"timecode", 8},
                                     {"v2d", 16},
                                     {"v2f", 8},
                                     {"v2i", 8},
                                     {"v3d", 24},
                                     {"v3f", 12},
                                     {"v3i", 12}};

constexpr std::uint32_t kMaxPreviewSide = 1u << 14;

struct Part
{
    Box dataWindow;
    Box displayWindow;
    std::int32_t tileWidth = 0; ///< 0: scanlines
    std::int32_t tileHeight = 0;
    std::int32_t chunkCount = 0;
    std::uint8_t compression = 0; ///< number in the file
    long long pixelBytes =
        0; ///< bytes of all pixels, not compressed, of channels with a value for each pixel

    long long largestRatio() const
    {
        constexpr int kNone = 0, kDwaa = 8;
        if (compression == kNone) return 1;
        return compression < kDwaa ? kLargestRatio : kLargestDwaRatio;
    }
};

class HeaderReader
{
public:
    explicit HeaderReader(std::istream& stream) : _stream(stream)
    {
        const std::istream::pos_type begin = stream.tellg();
        stream.seekg(0, std::ios::end);
        _end = stream.tellg();
        stream.seekg(begin);
        _sizeBytes = _end - begin;
    }

    std::string check()
    {
        const std::uint32_t magic = number();
        const std::uint32_t version = number();
        if (!_stream || magic != kMagic) return "this is no OpenEXR file";

        const bool multiPart = (version & kMultiPartFlag) != 0;
        for (int count = 0;; ++count)
        {
            Part part;
            int attributes = 0;
            std::string problem = readPart(part, attributes);
            if (!problem.empty()) return problem;
            if (multiPart && attributes == 0 && count > 0) return "";
            problem = checkPart(part);
            if (!problem.empty() || !multiPart) return problem;
        }
    }

private:
    std::uint32_t number()
    {
        unsigned char bytes[4] = {};
        _stream.read(reinterpret_cast<char*>(bytes), 4);
        return bytes[0] | bytes[1] << 8 | bytes[2] << 16 |
               static_cast<std::uint32_t>(bytes[3]) << 24;
    }

    std::int32_t signedNumber() { return static_cast<std::int32_t>(number()); }

    std::string name()
    {
        std::string text;
        char c = 0;
        while (text.size() <= kMaxNameLength && _stream.get(c) && c != 0)
            text += c;
        return text;
    }

    std::string readPart(Part& part, int& attributes)
    {
        for (;; ++attributes)
        {
            const std::string attribute = name();
            if (!_stream) return kTruncated;
            if (attribute.empty()) return "";
            const std::string type = name();
            const std::int32_t size = signedNumber();
            if (!_stream || attribute.size() > kMaxNameLength || type.size() > kMaxNameLength)
            {
                return kTruncated;
            }

            const std::istream::pos_type value = _stream.tellg();
            if (size < 0 || size > _end - value) return kTruncated;
            if (!hasSizeOf(type, size, value)) return "an attribute has another size than its type";
            _stream.seekg(value);
            readValue(part, attribute, size);
            _stream.seekg(value + std::istream::off_type(size));
        }
    }

    /// Returns whether OpenEXR reads as many bytes of a value as the file says that it has. If not,
    /// the next attribute begins in the middle of something, and may have any size.
    bool hasSizeOf(const std::string& type, std::int32_t size, std::istream::pos_type value)
    {
        for (const FixedSize& fixed : kFixedSizes)
            if (type == fixed.type) return size == fixed.bytes;
        if (type == "chlist")
        {
            const std::istream::pos_type end = value + std::istream::off_type(size);
            pixelBytes(end);
            return _stream && _stream.tellg() == end;
        }
        if (type == "preview")
        {
            const std::uint32_t width = number(), height = number();
            return size >= 8 && width <= kMaxPreviewSide && height <= kMaxPreviewSide &&
                   8 + 4LL * width * height == size;
        }
        return true;
    }

    void readValue(Part& part, const std::string& attribute, std::int32_t size)
    {
        if (attribute == "dataWindow" && size == 16) part.dataWindow = box();
        if (attribute == "displayWindow" && size == 16) part.displayWindow = box();
        if (attribute == "chunkCount" && size == 4) part.chunkCount = signedNumber();
        if (attribute == "compression" && size == 1)
            part.compression = static_cast<std::uint8_t>(_stream.get());
        if (attribute == "channels")
            part.pixelBytes = pixelBytes(_stream.tellg() + std::istream::off_type(size));
        if (attribute == "tiles" && size == 9)
        {
            part.tileWidth = signedNumber();
            part.tileHeight = signedNumber();
        }
    }

    /// Returns the bytes of a pixel in a list of (name, type, 4 bytes, sampling in x, in y) that
    /// ends with an empty name.
    long long pixelBytes(std::istream::pos_type end)
    {
        constexpr std::int32_t kHalf = 1;
        long long sum = 0;
        while (_stream && _stream.tellg() < end && !name().empty())
        {
            const std::int32_t type = signedNumber();
            signedNumber();
            const std::int32_t inX = signedNumber(), inY = signedNumber();
            if (inX == 1 && inY == 1) sum += type == kHalf ? 2 : 4;
        }
        return sum;
    }

    Box box()
    {
        Box result;
        result.minX = signedNumber();
        result.minY = signedNumber();
        result.maxX = signedNumber();
        result.maxY = signedNumber();
        return result;
    }

    std::string checkPart(const Part& part) const
    {
        for (const Box& window : {part.dataWindow, part.displayWindow})
        {
            const long long width = window.width();
            const long long height = window.height();
            if (isExrSize(width, height)) continue;
            return "a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                   " pixels is empty or too large";
        }

        const Box& window = part.dataWindow;
        long long chunks = (window.height() + kMaxScanlinesInChunk - 1) / kMaxScanlinesInChunk;
        if (part.tileWidth > 0 && part.tileHeight > 0)
        {
            chunks = ((window.width() + part.tileWidth - 1) / part.tileWidth) *
                     ((window.height() + part.tileHeight - 1) / part.tileHeight);
        }
        if (part.chunkCount > chunks) chunks = part.chunkCount;
        const long long ratio = part.largestRatio();
        const long long pixels = window.width() * window.height();
        const long long shown = part.displayWindow.width() * part.displayWindow.height();
        if (chunks * kOffsetBytes > _sizeBytes || pixels * part.pixelBytes / ratio > _sizeBytes ||
            (shown > kFreePixels && shown / kLargestRatio > _sizeBytes))
            return "the file is shorter than its picture";
        return "";
    }

    std::istream& _stream;
    std::istream::pos_type _end;
    long long _sizeBytes = 0;
};

} // namespace

bool isExrSize(long long width, long long height)
{
    return width > 0 && height > 0 && width <= kExrMaxSide && height <= kExrMaxSide &&
           width * height <= kExrMaxPixels;
}

std::string checkExrHeader(std::istream& stream)
{
    const std::istream::pos_type begin = stream.tellg();
    if (begin == std::istream::pos_type(-1)) return "the stream cannot seek";
    const std::string problem = HeaderReader(stream).check();
    stream.clear();
    stream.seekg(begin);
    return problem;
}

} // namespace osgRayTrace::engine
