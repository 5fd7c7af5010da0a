// VdbValues.cpp - decompresses values, and finds those that are not stored. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/vdb/VdbValues.h"

#include "osgPlugins/vdb/Blosc.h"

#include <zlib.h>

#include <bitset>
#include <limits>
#include <optional>

namespace osgRayTrace::vdb
{

namespace
{

/// What a node's byte says of its inactive values, where they are not stored.
enum NodeKind : std::uint8_t
{
    BACKGROUND = 0,          ///< all are the background
    MINUS_BACKGROUND = 1,    ///< all are the background's negative
    ONE_VALUE = 2,           ///< all are a value that follows
    BACKGROUND_OR_MINUS = 3, ///< a mask chooses the background, or its negative
    BACKGROUND_OR_ONE = 4,   ///< a mask chooses the background, or a value that follows
    TWO_VALUES = 5, ///< a mask chooses from two values that follow, the second one where set
    STORED = 6      ///< all values are stored
};

float fromHalf(std::uint16_t half)
{
    const std::uint32_t magnitude = half & 0x7fffu;
    if (magnitude >= 0x7c00u) // infinite, or no number
        return std::numeric_limits<float>::quiet_NaN();
    const std::uint32_t bits = magnitude << 13;
    float value;
    std::memcpy(&value, &bits, sizeof value);
    value *= 0x1p112f; // the difference of the exponents' biases; denormals, too
    return half & 0x8000u ? -value : value;
}

/// Returns a double as a float; what is too large for one is infinite.
float fromDouble(double value)
{
    constexpr double kMost = std::numeric_limits<float>::max();
    if (value > kMost) return std::numeric_limits<float>::infinity();
    if (value < -kMost) return -std::numeric_limits<float>::infinity();
    return static_cast<float>(value);
}

float scalar(const unsigned char* bytes, unsigned int length)
{
    if (length == 2) return fromHalf(littleEndian<std::uint16_t>(bytes));
    if (length == 8) return fromDouble(littleEndian<double>(bytes));
    return littleEndian<float>(bytes);
}

} // namespace

unsigned int VdbMask::count() const
{
    std::size_t result = 0;
    for (unsigned int i = 0; i < _size / 8; i += 8)
        result += std::bitset<64>(littleEndian<std::uint64_t>(_bits + i)).count();
    return static_cast<unsigned int>(result);
}

float VdbValues::single(VdbBytes& bytes) const
{
    return scalar(bytes.take(_format.bytes), _format.bytes);
}

/// Returns so many bytes of an array. They are compressed if their own length stands before them;
/// a length that is not above 0 is the negative length of bytes that are not compressed.
const unsigned char* VdbValues::decompressed(VdbBytes& bytes, std::size_t length)
{
    if (!(_format.compression & (VDB_BLOSC | VDB_ZIP))) return bytes.take(length);
    const auto stored = bytes.number<std::int64_t>();
    if (stored <= 0)
    {
        if (stored != -static_cast<std::int64_t>(length))
            throw VdbError("the values of a node have a wrong length");
        return bytes.take(length);
    }
    const unsigned char* from = bytes.take(static_cast<std::uint64_t>(stored));
    _scratch.resize(length);
    if (_format.compression & VDB_BLOSC)
        decompressBlosc(from, static_cast<std::size_t>(stored), _scratch.data(), length);
    else
    {
        uLongf made = static_cast<uLongf>(length);
        if (uncompress(_scratch.data(), &made, from, static_cast<uLong>(stored)) != Z_OK ||
            made != length)
            throw VdbError("the values of a node cannot be decompressed");
    }
    return _scratch.data();
}

void VdbValues::read(VdbBytes& bytes, const VdbMask& active, std::vector<float>& values)
{
    const auto kind = bytes.number<std::uint8_t>();
    if (kind > STORED) throw VdbError("a node has values of an unknown kind");
    float unset = kind == BACKGROUND ? _background : -_background, set = _background;
    if (kind == ONE_VALUE || kind == BACKGROUND_OR_ONE || kind == TWO_VALUES) unset = single(bytes);
    if (kind == TWO_VALUES) set = single(bytes);
    std::optional<VdbMask> choice;
    if (kind == BACKGROUND_OR_MINUS || kind == BACKGROUND_OR_ONE || kind == TWO_VALUES)
        choice.emplace(bytes, active.size());

    const bool isWhole = !(_format.compression & VDB_ACTIVE_VALUES) || kind == STORED;
    const unsigned int count = isWhole ? active.size() : active.count();
    const unsigned int width = _format.half ? 2 : _format.bytes;
    // Of halves an empty array has no length before it.
    const unsigned char* next =
        _format.half && count == 0 ? nullptr : decompressed(bytes, std::size_t(count) * width);
    values.resize(active.size());
    for (unsigned int i = 0; i < active.size(); ++i)
    {
        const bool isStored = isWhole || active[i];
        values[i] = isStored ? scalar(next, width) : choice && (*choice)[i] ? set : unset;
        if (isStored) next += width;
    }
}

} // namespace osgRayTrace::vdb
