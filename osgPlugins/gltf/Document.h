// Document.h - an opened glTF file: its JSON, its buffers, and limits on what it makes. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/ByteSource.h"
#include "osgPlugins/gltf/JsonPlace.h"

#include <osgDB/Options>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace osgRayTrace::gltf
{

/// The words of the option string, such as "noRotation scene=1 variant=red".
struct GltfOptions
{
    bool rotation = true;         ///< Y up becomes Z up
    std::string scene;            ///< index or name; empty: the file's own
    std::string variant;          ///< index or name; empty: none
    const osgDB::Options* caller; ///< for the images; may be null

    explicit GltfOptions(const osgDB::Options* options);
};

class Document
{
public:
    /// Opens a file by its path. Throws GltfError.
    static Document openFile(const std::string& path, const GltfOptions& options);

    /// Opens the bytes of a file. Files beside it are found in the folder; if that is empty, they
    /// are refused. Throws GltfError.
    static Document openBytes(std::string bytes, const std::string& folder,
                              const GltfOptions& options);

    JsonPlace root() const { return JsonPlace(*_json); }
    const GltfOptions& options() const { return _options; }
    const std::string& folder() const { return _folder; }

    /// Returns an element of one of the arrays at the top: element("meshes", 3).
    JsonPlace element(const char* array, std::size_t index) const;

    /// Returns the number of elements of an array at the top.
    std::size_t count(const char* array) const { return root().sizeOf(array); }

    /// Returns the bytes of a bufferView, decoded if they are compressed. Throws GltfError.
    ByteRange bufferView(std::size_t index);

    /// Returns the path of a file beside the model. Throws GltfError if the URI may not be
    /// followed.
    std::string pathBeside(const JsonPlace& uri) const;

    /// Counts bytes that are to be taken for what the file says. Throws GltfError, before they are
    /// taken, if that is out of proportion to the size of the file: accessors may share their
    /// bytes, and may have none.
    void take(std::uint64_t bytes, const JsonPlace& place);

    /// Returns how many bytes may still be taken.
    std::uint64_t room() const { return _mayTake - _taken; }

    /// Records, once, what is not read as it stands in the file.
    void note(const std::string& text);
    const std::vector<std::string>& notes() const { return _notes; }

private:
    Document(const std::shared_ptr<ByteSource>& file, const std::string& folder,
             const GltfOptions& options);
    void readBinary(const std::shared_ptr<ByteSource>& file);
    void readText(const std::shared_ptr<ByteSource>& file, std::uint64_t offset,
                  std::uint64_t size);
    void checkAsset() const;
    void openBuffers();
    void limitBytes(const std::shared_ptr<ByteSource>& file);
    ByteRange partOf(const JsonPlace& view) const;
    ByteRange decodedView(const JsonPlace& view, const JsonPlace& extension);

    std::shared_ptr<const Json> _json;
    std::vector<ByteRange> _buffers; ///< without a source: its views are compressed, elsewhere
    std::map<std::size_t, ByteRange> _decodedViews; ///< by bufferView
    ByteRange _binary;                              ///< the chunk of a .glb; without a source: none
    GltfOptions _options;
    std::string _folder; ///< ends with a slash; empty: there is none
    std::uint64_t _taken = 0, _mayTake = 0;
    std::vector<std::string> _notes;
};

} // namespace osgRayTrace::gltf
