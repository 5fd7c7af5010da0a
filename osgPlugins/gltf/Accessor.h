// Accessor.h - the values that accessors name, checked and copied to where they are used. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/Document.h"

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace osgRayTrace::gltf
{

enum class ComponentType
{
    Byte = 5120,
    UnsignedByte = 5121,
    Short = 5122,
    UnsignedShort = 5123,
    UnsignedInt = 5125,
    Float = 5126
};

/// The layout of an accessor, all of whose bytes are known to be there.
struct Accessor
{
    explicit Accessor(JsonPlace itsPlace) : place(std::move(itsPlace)) {}

    JsonPlace place;
    ComponentType type = ComponentType::Float;
    unsigned int components = 1; ///< 1 to 4; a matrix of 4 x 4 has 16
    bool normalized = false;
    std::size_t count = 0;
    std::optional<ByteRange> bytes; ///< of the view, from the first element on; none: all are zero
    std::size_t stride = 0;         ///< from element to element [bytes]

    std::size_t elementSize() const;
};

class AccessorReader
{
public:
    explicit AccessorReader(Document& document) : _document(&document) {}

    /// Returns the layout of an accessor without its bytes. Throws GltfError.
    Accessor layout(const JsonPlace& index) const;

    /// Returns the layout of an accessor with its bytes. Throws GltfError.
    Accessor open(const JsonPlace& index) const;

    /// Returns the layout; throws GltfError as well if the accessor has other components.
    Accessor open(const JsonPlace& index, unsigned int components) const;

    /// Copies the elements as they are, without gaps. to: count * elementSize bytes.
    void copy(const Accessor& accessor, void* to);

    /// Copies the elements as floats: count * components; normalized integers as glTF 2.0, sect.
    /// 3.6.2.2 has it, values that are not finite as 0.
    void copyFloats(const Accessor& accessor, float* to);

    /// Returns the elements of a scalar accessor of unsigned integers.
    std::vector<std::uint32_t> indices(const Accessor& accessor);

    /// Sets the bytes of an accessor, decoded and without gaps, in place of those of its view, and
    /// how many elements they are.
    void setDecoded(std::size_t accessor, const ByteRange& bytes, std::size_t count)
    {
        _decoded[accessor] = {bytes, count};
    }
    void forgetDecoded() { _decoded.clear(); }

    Document& document() const { return *_document; }

private:
    /// The last bytes that were read of an interleaved view: the next attribute is among them.
    struct Interleaved
    {
        const ByteSource* source = nullptr;
        std::uint64_t offset = 0;
        std::vector<unsigned char> bytes;
    };

    void copyStrided(const Accessor& accessor, unsigned char* to);
    void copySparse(const Accessor& accessor, const JsonPlace& sparse, unsigned char* to);

    Document* _document;
    Interleaved _interleaved;
    struct Decoded
    {
        ByteRange bytes;
        std::size_t count = 0;
    };
    std::map<std::size_t, Decoded> _decoded; ///< by accessor
};

} // namespace osgRayTrace::gltf
