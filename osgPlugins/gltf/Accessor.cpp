// Accessor.cpp - checks accessors and copies their elements. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/Accessor.h"

#include "osgPlugins/gltf/GltfError.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace osgRayTrace::gltf
{

namespace
{

constexpr std::uint64_t kMostElements = std::numeric_limits<std::int32_t>::max(); ///< OSG's
constexpr std::uint64_t kLargestStride = 65536;                ///< glTF allows 252
constexpr std::size_t kMostInterleaved = std::size_t(4) << 20; ///< larger views are not kept
constexpr std::size_t kBlock = 65536;                          ///< elements

std::size_t sizeOf(ComponentType type)
{
    switch (type)
    {
    case ComponentType::Byte:
    case ComponentType::UnsignedByte:
        return 1;
    case ComponentType::Short:
    case ComponentType::UnsignedShort:
        return 2;
    case ComponentType::UnsignedInt:
    case ComponentType::Float:
        return 4;
    }
    return 4;
}

ComponentType componentTypeOf(const JsonPlace& place)
{
    const std::uint64_t type = place.whole();
    if (type < 5120 || type > 5126 || type == 5124)
        place.refuse("is " + std::to_string(type) + ", which is no type of components");
    return static_cast<ComponentType>(type);
}

unsigned int componentsOf(const JsonPlace& place)
{
    const std::string& type = place.text();
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4") return 4;
    if (type == "MAT4") return 16;
    place.refuse("is '" + type + "'; SCALAR, VEC2, VEC3, VEC4 and MAT4 are read");
}

/// Sets the bytes of an accessor, or of the values of a sparse one. Throws GltfError if not all of
/// the elements lie in the view.
void setBytes(Accessor& accessor, const JsonPlace& holder, Document& document)
{
    const std::size_t size = accessor.elementSize();
    const JsonPlace index = holder.at("bufferView");
    const std::size_t view = index.index(document.count("bufferViews"));
    ByteRange bytes = document.bufferView(view);
    const std::uint64_t offset = holder.wholeOr("byteOffset", 0);
    const std::uint64_t stride = document.element("bufferViews", view).wholeOr("byteStride", size);
    if (stride < size || stride > kLargestStride)
        index.refuse("has a stride of " + std::to_string(stride) + " bytes for elements of " +
                     std::to_string(size));
    // None of these products overflows: count has 31 bits, stride 17.
    const std::uint64_t length = accessor.count == 0 ? 0 : stride * (accessor.count - 1) + size;
    if (offset > bytes.size || length > bytes.size - offset)
        holder.refuse(std::to_string(accessor.count) + " elements end at byte " +
                      std::to_string(offset + length) + " of a view of " +
                      std::to_string(bytes.size));
    bytes.offset += offset;
    bytes.size -= offset;
    accessor.bytes = bytes;
    accessor.stride = static_cast<std::size_t>(stride);
}

template <typename T> float valueOf(T integer, bool normalized)
{
    if (!normalized) return static_cast<float>(integer);
    constexpr auto largest = static_cast<float>(std::numeric_limits<T>::max());
    return std::max(static_cast<float>(integer) / largest, -1.0f);
}

template <typename T>
void toFloats(const unsigned char* from, std::size_t count, bool normalized, float* to)
{
    for (std::size_t i = 0; i < count; ++i)
    {
        T value;
        std::memcpy(&value, from + i * sizeof(T), sizeof(T));
        to[i] = valueOf(value, normalized);
    }
}

void convert(ComponentType type, const unsigned char* from, std::size_t count, bool normalized,
             float* to)
{
    switch (type)
    {
    case ComponentType::Byte:
        return toFloats<std::int8_t>(from, count, normalized, to);
    case ComponentType::UnsignedByte:
        return toFloats<std::uint8_t>(from, count, normalized, to);
    case ComponentType::Short:
        return toFloats<std::int16_t>(from, count, normalized, to);
    case ComponentType::UnsignedShort:
        return toFloats<std::uint16_t>(from, count, normalized, to);
    case ComponentType::UnsignedInt:
        return toFloats<std::uint32_t>(from, count, normalized, to);
    case ComponentType::Float:
        std::memcpy(to, from, count * sizeof(float));
    }
}

/// Returns how many of the values are not finite, which become 0.
std::size_t repair(float* values, std::size_t count)
{
    std::size_t repaired = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
        const bool good = std::fabs(values[i]) <= std::numeric_limits<float>::max();
        repaired += good ? 0 : 1;
        values[i] = good ? values[i] : 0.0f;
    }
    return repaired;
}

} // namespace

std::size_t Accessor::elementSize() const
{
    return components * sizeOf(type);
}

Accessor AccessorReader::layout(const JsonPlace& index) const
{
    const std::size_t number = index.index(_document->count("accessors"));
    Accessor accessor(_document->element("accessors", number));
    const JsonPlace& place = accessor.place;
    accessor.type = componentTypeOf(place.at("componentType"));
    accessor.components = componentsOf(place.at("type"));
    accessor.normalized = place.flagOr("normalized", false);
    const std::uint64_t count = place.at("count").whole();
    if (count > kMostElements) place.at("count").refuse("is above 2^31 - 1");
    accessor.count = static_cast<std::size_t>(count);
    // Matrices of bytes and shorts have gaps between their columns, and no use in glTF.
    if (accessor.components == 16 && accessor.type != ComponentType::Float)
        place.refuse("has matrices of integers");
    accessor.stride = accessor.elementSize();
    return accessor;
}

Accessor AccessorReader::open(const JsonPlace& index) const
{
    Accessor accessor = layout(index);
    const auto decoded = _decoded.find(index.index(SIZE_MAX));
    if (decoded != _decoded.end())
    {
        accessor.bytes = decoded->second.bytes;
        accessor.count = decoded->second.count;
    }
    else if (accessor.place.find("bufferView"))
        setBytes(accessor, accessor.place, *_document);
    return accessor;
}

Accessor AccessorReader::open(const JsonPlace& index, unsigned int components) const
{
    Accessor accessor = open(index);
    if (accessor.components != components)
        accessor.place.refuse("has the type " + accessor.place.at("type").text() +
                              ", which does not fit " + index.path());
    return accessor;
}

void AccessorReader::copy(const Accessor& accessor, void* to)
{
    auto* bytes = static_cast<unsigned char*>(to);
    try
    {
        if (!accessor.bytes)
            std::memset(to, 0, accessor.count * accessor.elementSize());
        else if (accessor.stride == accessor.elementSize())
            accessor.bytes->read(0, accessor.count * accessor.elementSize(), to);
        else
            copyStrided(accessor, bytes);
    }
    catch (const GltfError& error)
    {
        accessor.place.refuse(error.what());
    }
    if (const auto sparse = accessor.place.find("sparse")) copySparse(accessor, *sparse, bytes);
}

/// Copies every element of an interleaved view. The attributes of the same vertices lie between
/// each other, so what is read for one of them is kept for the next.
void AccessorReader::copyStrided(const Accessor& accessor, unsigned char* to)
{
    const std::size_t size = accessor.elementSize(), stride = accessor.stride;
    const ByteRange& range = *accessor.bytes;
    Interleaved& held = _interleaved;
    const std::uint64_t length = accessor.count == 0 ? 0 : stride * (accessor.count - 1) + size;
    const bool isHeld = held.source == range.source.get() && range.offset >= held.offset &&
                        range.offset + length <= held.offset + held.bytes.size();
    if (!isHeld && length <= kMostInterleaved)
    {
        const std::uint64_t whole = std::min<std::uint64_t>(
            std::min<std::uint64_t>(stride * accessor.count, range.size), kMostInterleaved);
        held.source = nullptr; // in case the read fails
        held.bytes.resize(static_cast<std::size_t>(std::max(whole, length)));
        range.read(0, held.bytes.size(), held.bytes.data());
        held.source = range.source.get();
        held.offset = range.offset;
    }
    if (held.source == range.source.get() && range.offset >= held.offset &&
        range.offset + length <= held.offset + held.bytes.size())
    {
        const unsigned char* from = held.bytes.data() + (range.offset - held.offset);
        for (std::size_t i = 0; i < accessor.count; ++i)
            std::memcpy(to + i * size, from + i * stride, size);
        return;
    }
    std::vector<unsigned char> block;
    for (std::size_t first = 0; first < accessor.count; first += kBlock)
    {
        const std::size_t count = std::min(kBlock, accessor.count - first);
        block.resize(stride * (count - 1) + size);
        range.read(std::uint64_t(first) * stride, block.size(), block.data());
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(to + (first + i) * size, block.data() + i * stride, size);
    }
}

/// Replaces the elements that a sparse accessor gives new values.
void AccessorReader::copySparse(const Accessor& accessor, const JsonPlace& sparse,
                                unsigned char* to)
{
    const std::uint64_t count = sparse.at("count").whole();
    if (count > accessor.count) sparse.at("count").refuse("is above the accessor's own");
    const JsonPlace indexPlace = sparse.at("indices");
    Accessor indexAccessor(indexPlace);
    indexAccessor.type = componentTypeOf(indexPlace.at("componentType"));
    indexAccessor.count = static_cast<std::size_t>(count);
    setBytes(indexAccessor, indexPlace, *_document);
    const std::vector<std::uint32_t> elements = indices(indexAccessor);

    const JsonPlace valuePlace = sparse.at("values");
    Accessor values(valuePlace);
    values.type = accessor.type;
    values.components = accessor.components;
    values.count = indexAccessor.count;
    setBytes(values, valuePlace, *_document);
    const std::size_t size = accessor.elementSize();
    std::vector<unsigned char> bytes(size * values.count);
    copy(values, bytes.data());
    for (std::size_t i = 0; i < elements.size(); ++i)
    {
        if (elements[i] >= accessor.count)
            indexPlace.refuse("element " + std::to_string(i) + " is " +
                              std::to_string(elements[i]) + ", and there are " +
                              std::to_string(accessor.count));
        std::memcpy(to + elements[i] * size, bytes.data() + i * size, size);
    }
}

void AccessorReader::copyFloats(const Accessor& accessor, float* to)
{
    const std::size_t count = accessor.count * accessor.components;
    if (accessor.type == ComponentType::Float)
    {
        copy(accessor, to);
        if (const std::size_t repaired = repair(to, count))
            _document->note(accessor.place.path() + ": " + std::to_string(repaired) +
                            " numbers are not finite, and became 0");
        return;
    }
    std::vector<unsigned char> bytes(accessor.count * accessor.elementSize());
    copy(accessor, bytes.data());
    convert(accessor.type, bytes.data(), count, accessor.normalized, to);
}

std::vector<std::uint32_t> AccessorReader::indices(const Accessor& accessor)
{
    if (accessor.components != 1) accessor.place.refuse("has indices that are no scalars");
    _document->take(accessor.count * sizeof(std::uint32_t), accessor.place);
    std::vector<std::uint32_t> values(accessor.count);
    if (accessor.type == ComponentType::UnsignedInt)
    {
        copy(accessor, values.data());
        return values;
    }
    std::vector<unsigned char> bytes(accessor.count * accessor.elementSize());
    copy(accessor, bytes.data());
    for (std::size_t i = 0; i < accessor.count; ++i)
    {
        if (accessor.type == ComponentType::UnsignedByte)
            values[i] = bytes[i];
        else if (accessor.type == ComponentType::UnsignedShort)
            values[i] = bytes[2 * i] | std::uint32_t(bytes[2 * i + 1]) << 8;
        else
            accessor.place.refuse("has indices that are no unsigned integers");
    }
    return values;
}

} // namespace osgRayTrace::gltf
