// ByteSource.h - the bytes of a buffer, in a file or in memory, read where they are used. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <string>

namespace osgRayTrace::gltf
{

/// Gives bytes at any offset. So vertex data of a file goes into OSG's arrays without a copy of the
/// file in memory between.
class ByteSource
{
public:
    virtual ~ByteSource() = default;

    virtual std::uint64_t size() const = 0;

    /// Copies bytes of [offset, offset + count), which must lie within size(), to memory. Throws
    /// GltfError if the file does not give them.
    virtual void read(std::uint64_t offset, std::size_t count, void* to) = 0;
};

/// The bytes of a regular file.
class FileBytes : public ByteSource
{
public:
    /// Throws GltfError if there is no such file, or it is no regular one.
    explicit FileBytes(const std::string& path);

    std::uint64_t size() const override { return _size; }
    void read(std::uint64_t offset, std::size_t count, void* to) override;

private:
    std::ifstream _stream;
    std::uint64_t _size = 0;
};

class MemoryBytes : public ByteSource
{
public:
    explicit MemoryBytes(std::string bytes) : _bytes(std::move(bytes)) {}

    std::uint64_t size() const override { return _bytes.size(); }
    void read(std::uint64_t offset, std::size_t count, void* to) override;

private:
    std::string _bytes;
};

/// A part of a source: a glTF buffer.
struct ByteRange
{
    std::shared_ptr<ByteSource> source;
    std::uint64_t offset = 0;
    std::uint64_t size = 0;

    void read(std::uint64_t from, std::size_t count, void* to) const
    {
        source->read(offset + from, count, to);
    }
};

} // namespace osgRayTrace::gltf
