// Document.cpp - opens .gltf and .glb files and their buffers. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/Document.h"

#include "osgPlugins/gltf/DracoMesh.h"
#include "osgPlugins/gltf/GltfError.h"
#include "osgPlugins/gltf/MeshoptView.h"
#include "osgPlugins/gltf/Uri.h"

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <array>
#include <sstream>

namespace osgRayTrace::gltf
{

namespace
{

constexpr std::uint64_t kMostText = std::uint64_t(1) << 30;
constexpr std::uint32_t kMagic = 0x46546c67;       ///< "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;   ///< "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004e4942; ///< "BIN"
constexpr std::uint64_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

constexpr std::size_t kMostNotes = 40;

// What a file may make: so many times its own bytes, and so many more.
constexpr std::uint64_t kShare = 16;
constexpr std::uint64_t kCompressedShare = 80; ///< meshoptimizer's bytes grow to 64 times at most
constexpr std::uint64_t kSmallFile = std::uint64_t(64) << 20;

/// Returns a little-endian number of a file.
std::uint32_t numberAt(ByteSource& file, std::uint64_t offset)
{
    std::array<unsigned char, 4> bytes{};
    file.read(offset, bytes.size(), bytes.data());
    return std::uint32_t(bytes[0]) | std::uint32_t(bytes[1]) << 8 | std::uint32_t(bytes[2]) << 16 |
           std::uint32_t(bytes[3]) << 24;
}

/// Opens the file that a URI means.
std::shared_ptr<ByteSource> fileOf(const std::string& path, const JsonPlace& uri)
{
    try
    {
        return std::make_shared<FileBytes>(path);
    }
    catch (const GltfError& error)
    {
        uri.refuse(error.what());
    }
}

constexpr const char* kMeshopt = "EXT_meshopt_compression";

/// Returns whether a file says that it uses an extension.
bool uses(const JsonPlace& root, const std::string& name)
{
    for (std::size_t i = 0; i < root.sizeOf("extensionsUsed"); ++i)
        if (root.at("extensionsUsed")[i].text() == name) return true;
    return false;
}

/// Returns whether a buffer has no bytes: it stands for what its views are when decompressed.
bool isFallback(const JsonPlace& buffer)
{
    const auto extension = buffer.extension(kMeshopt);
    return readsMeshopt() && extension && extension->flagOr("fallback", false);
}

/// Returns the number before the first dot of a version.
std::string majorOf(const std::string& version)
{
    return version.substr(0, version.find('.'));
}

} // namespace

GltfOptions::GltfOptions(const osgDB::Options* options) : caller(options)
{
    std::istringstream words(options ? options->getOptionString() : "");
    for (std::string word; words >> word;)
    {
        if (word == "noRotation") rotation = false;
        if (word.rfind("scene=", 0) == 0) scene = word.substr(6);
        if (word.rfind("variant=", 0) == 0) variant = word.substr(8);
    }
}

Document Document::openFile(const std::string& path, const GltfOptions& options)
{
    const std::string folder = osgDB::getFilePath(path);
    return Document(std::make_shared<FileBytes>(path), folder.empty() ? "." : folder, options);
}

Document Document::openBytes(std::string bytes, const std::string& folder,
                             const GltfOptions& options)
{
    return Document(std::make_shared<MemoryBytes>(std::move(bytes)), folder, options);
}

Document::Document(const std::shared_ptr<ByteSource>& file, const std::string& folder,
                   const GltfOptions& options)
    : _options(options), _folder(folder.empty() ? folder : folder + "/")
{
    if (file->size() >= kHeaderBytes && numberAt(*file, 0) == kMagic)
        readBinary(file);
    else
        readText(file, 0, file->size());
    checkAsset();
    openBuffers();
    limitBytes(file);
}

/// Sets how many bytes the scene may take, in proportion to those of the file and its buffers.
void Document::limitBytes(const std::shared_ptr<ByteSource>& file)
{
    const bool compressed = (readsMeshopt() && uses(root(), kMeshopt)) ||
                            (readsDraco() && uses(root(), "KHR_draco_mesh_compression"));
    const std::uint64_t share = compressed ? kCompressedShare : kShare;
    _mayTake = kSmallFile + share * file->size();
    for (const ByteRange& buffer : _buffers)
        if (buffer.source && buffer.source != file) _mayTake += share * buffer.size;
}

void Document::readBinary(const std::shared_ptr<ByteSource>& file)
{
    const std::uint32_t version = numberAt(*file, 4);
    if (version != 2)
        throw GltfError("header", "is of glTF " + std::to_string(version) + "; 2.0 is read");
    const std::uint64_t length = numberAt(*file, 8);
    if (length > file->size())
        throw GltfError("header", "says " + std::to_string(length) + " bytes, and the file has " +
                                      std::to_string(file->size()));
    bool first = true;
    for (std::uint64_t offset = kHeaderBytes; offset + kChunkHeaderBytes <= length; first = false)
    {
        const std::uint64_t size = numberAt(*file, offset);
        const std::uint32_t type = numberAt(*file, offset + 4);
        offset += kChunkHeaderBytes;
        if (size > length - offset)
            throw GltfError("chunk at byte " + std::to_string(offset - kChunkHeaderBytes),
                            "is longer than the file");
        if (first && type != kJsonChunk) throw GltfError("first chunk", "is not JSON");
        if (first) readText(file, offset, size);
        if (type == kBinaryChunk && !_binary.source) _binary = {file, offset, size};
        offset += (size + 3) / 4 * 4;
    }
    if (first) throw GltfError("header", "is followed by no chunk");
}

void Document::readText(const std::shared_ptr<ByteSource>& file, std::uint64_t offset,
                        std::uint64_t size)
{
    if (size > kMostText) throw GltfError("JSON", "is longer than 2^30 bytes");
    std::string text(static_cast<std::size_t>(size), '\0');
    file->read(offset, text.size(), text.data());
    _json = parseJson(text);
}

void Document::checkAsset() const
{
    const JsonPlace asset = root().at("asset");
    const std::string version = asset.at("version").text();
    if (majorOf(version) != "2")
        asset.at("version").refuse("is '" + version + "'; glTF 2.0 is read");
    const std::string least = asset.textOr("minVersion", "2.0");
    if (least != "2.0") asset.refuse("needs a reader of glTF '" + least + "'; this one reads 2.0");
}

void Document::openBuffers()
{
    for (std::size_t i = 0; i < count("buffers"); ++i)
    {
        const JsonPlace buffer = element("buffers", i);
        const std::uint64_t size = buffer.at("byteLength").whole();
        const auto uri = buffer.find("uri");
        ByteRange range;
        if (!uri && isFallback(buffer))
            range.size = size;
        else if (!uri && i == 0 && _binary.source)
            range = _binary;
        else if (!uri)
            buffer.refuse("has neither a URI nor the chunk of a .glb file");
        else if (isDataUri(uri->text()))
            range.source = std::make_shared<MemoryBytes>(bytesOfDataUri(*uri));
        else
            range.source = fileOf(pathBeside(*uri), *uri);
        if (uri) range.size = range.source->size();
        if (size > range.size)
            buffer.at("byteLength")
                .refuse("is " + std::to_string(size) + ", and there are " +
                        std::to_string(range.size) + " bytes");
        range.size = size;
        _buffers.push_back(std::move(range));
    }
}

JsonPlace Document::element(const char* array, std::size_t index) const
{
    return root().at(array)[index];
}

ByteRange Document::bufferView(std::size_t index)
{
    const JsonPlace view = element("bufferViews", index);
    const auto extension = view.extension(kMeshopt);
    if (!extension || !readsMeshopt()) return partOf(view);
    ByteRange& held = _decodedViews[index];
    if (!held.source) held = decodedView(view, *extension);
    return held;
}

/// Returns the bytes of a view whose bytes are compressed. Throws GltfError.
ByteRange Document::decodedView(const JsonPlace& view, const JsonPlace& extension)
{
    const std::uint64_t size = view.at("byteLength").whole();
    const MeshoptLayout layout = meshoptLayout(extension, size);
    if (view.wholeOr("byteStride", layout.stride) != layout.stride)
        view.at("byteStride").refuse("is not that of the compressed bytes");
    const ByteRange from = partOf(extension);
    take(from.size + size, extension);
    std::string compressed(static_cast<std::size_t>(from.size), '\0');
    from.read(0, compressed.size(), compressed.data());
    std::string bytes = decodeMeshopt(compressed, layout, extension);
    return {std::make_shared<MemoryBytes>(std::move(bytes)), 0, size};
}

/// Returns the bytes that an object with buffer, byteOffset and byteLength means. Throws GltfError.
ByteRange Document::partOf(const JsonPlace& view) const
{
    const ByteRange& buffer = _buffers[view.at("buffer").index(_buffers.size())];
    if (!buffer.source) view.at("buffer").refuse("is a buffer without bytes");
    const std::uint64_t offset = view.wholeOr("byteOffset", 0);
    const std::uint64_t size = view.at("byteLength").whole();
    if (offset > buffer.size || size > buffer.size - offset)
        view.refuse("ends at byte " + std::to_string(offset + size) + " of a buffer of " +
                    std::to_string(buffer.size));
    return {buffer.source, buffer.offset + offset, size};
}

std::string Document::pathBeside(const JsonPlace& uri) const
{
    const std::string path = pathOfUri(uri);
    if (_folder.empty())
        uri.refuse("'" + path + "' is a file beside the model, which was read from a stream");
    return _folder + path;
}

void Document::take(std::uint64_t bytes, const JsonPlace& place)
{
    if (bytes > _mayTake - _taken)
        place.refuse("would make the scene larger than " + std::to_string(_mayTake) +
                     " bytes, which is out of proportion to the file");
    _taken += bytes;
}

void Document::note(const std::string& text)
{
    if (_notes.size() > kMostNotes) return;
    if (_notes.size() == kMostNotes)
        _notes.emplace_back("more of the same kinds is left out");
    else if (std::find(_notes.begin(), _notes.end(), text) == _notes.end())
        _notes.push_back(text);
}

} // namespace osgRayTrace::gltf
