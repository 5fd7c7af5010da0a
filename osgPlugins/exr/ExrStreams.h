// ExrStreams.h - OpenEXR's view of C++ streams, which may begin anywhere. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <istream>
#include <ostream>
#include <stdexcept>

namespace osgRayTrace::engine
{

class ExrInputStream : public Imf::IStream
{
public:
    explicit ExrInputStream(std::istream& stream)
        : Imf::IStream("stream"), _stream(stream), _begin(stream.tellg())
    {
    }

    /// Reads bytes; returns false if these were the last of the stream.
    bool read(char bytes[], int count) override
    {
        _stream.read(bytes, count);
        if (!_stream) throw std::runtime_error("the file ends too early");
        return _stream.peek() != std::istream::traits_type::eof();
    }

    std::uint64_t tellg() override
    {
        _stream.clear();
        return static_cast<std::uint64_t>(_stream.tellg() - _begin);
    }

    void seekg(std::uint64_t position) override
    {
        _stream.clear();
        _stream.seekg(_begin + static_cast<std::istream::off_type>(position));
        if (!_stream) throw std::runtime_error("the file points beyond itself");
    }

    void clear() override { _stream.clear(); }

private:
    std::istream& _stream;
    std::istream::pos_type _begin;
};

class ExrOutputStream : public Imf::OStream
{
public:
    explicit ExrOutputStream(std::ostream& stream) : Imf::OStream("stream"), _stream(stream) {}

    void write(const char bytes[], int count) override
    {
        _stream.write(bytes, count);
        if (!_stream) throw std::runtime_error("writing failed");
    }

    std::uint64_t tellp() override { return static_cast<std::uint64_t>(_stream.tellp()); }

    void seekp(std::uint64_t position) override
    {
        _stream.seekp(static_cast<std::ostream::off_type>(position));
    }

private:
    std::ostream& _stream;
};

} // namespace osgRayTrace::engine
