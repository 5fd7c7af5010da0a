// ByteSource.cpp - reads bytes of files and of memory. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/ByteSource.h"

#include "osgPlugins/gltf/GltfError.h"
#include "osgRayTrace/base/TextFile.h"

#include <cstring>
#include <filesystem>

namespace osgRayTrace::gltf
{

FileBytes::FileBytes(const std::string& path)
{
    const std::string irregularity = engine::irregularityOf(path);
    if (!irregularity.empty()) throw GltfError("'" + path + "'", irregularity);
    std::error_code error;
    _size = std::filesystem::file_size(path, error);
    _stream.open(path, std::ios::binary);
    if (error || !_stream) throw GltfError("'" + path + "'", "cannot be opened");
}

void FileBytes::read(std::uint64_t offset, std::size_t count, void* to)
{
    if (count == 0) return;
    _stream.clear();
    _stream.seekg(static_cast<std::streamoff>(offset));
    _stream.read(static_cast<char*>(to), static_cast<std::streamsize>(count));
    if (static_cast<std::size_t>(_stream.gcount()) != count)
        throw GltfError("", "the file ends before byte " + std::to_string(offset + count));
}

void MemoryBytes::read(std::uint64_t offset, std::size_t count, void* to)
{
    if (offset > _bytes.size() || count > _bytes.size() - offset)
        throw GltfError("", "the data end before byte " + std::to_string(offset + count));
    if (count > 0) std::memcpy(to, _bytes.data() + offset, count);
}

} // namespace osgRayTrace::gltf
