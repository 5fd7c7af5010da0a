// VdbBytes.h - reads numbers of a file within its bounds. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

namespace osgRayTrace::vdb
{

/// Says what is wrong with a file, as one sentence without a full stop.
class VdbError : public std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/// Returns the number whose bytes are given, the lowest one first.
template <class T> T littleEndian(const unsigned char* bytes)
{
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
        bits |= std::uint64_t(bytes[i]) << (8 * i);
    T number;
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    bits <<= 8 * (8 - sizeof(T));
#endif
    std::memcpy(&number, &bits, sizeof number);
    return number;
}

/// Reads the bytes of a file one after the other. The file must outlive the reader. Every function
/// throws a VdbError instead of leaving the file.
class VdbBytes
{
public:
    explicit VdbBytes(const std::string& file, std::uint64_t place = 0) : _file(&file)
    {
        if (place > file.size()) throw VdbError("the file ends too early");
        _place = static_cast<std::size_t>(place);
    }

    std::size_t place() const { return _place; }

    /// Returns where the next bytes are, and goes past them.
    const unsigned char* take(std::uint64_t count)
    {
        if (count > _file->size() - _place) throw VdbError("the file ends too early");
        const char* result = _file->data() + _place;
        _place += static_cast<std::size_t>(count);
        return reinterpret_cast<const unsigned char*>(result);
    }

    template <class T> T number() { return littleEndian<T>(take(sizeof(T))); }

    /// Reads a text with its length before it.
    std::string text()
    {
        const std::uint32_t length = number<std::uint32_t>();
        return std::string(reinterpret_cast<const char*>(take(length)), length);
    }

private:
    const std::string* _file;
    std::size_t _place = 0;
};

} // namespace osgRayTrace::vdb
