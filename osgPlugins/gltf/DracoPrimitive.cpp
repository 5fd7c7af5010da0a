// DracoPrimitive.cpp - reads the extension's object and hands decoded bytes to accessors. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/DracoPrimitive.h"

#include <nlohmann/json.hpp>

#include <limits>

namespace osgRayTrace::gltf
{

namespace
{

constexpr const char* kName = "KHR_draco_mesh_compression";
constexpr std::uint64_t kTriangles = 4, kTriangleStrip = 5;
constexpr std::uint64_t kIndices = std::numeric_limits<std::uint64_t>::max(); ///< no attribute's id
// What the library may take for its work: so many times what the scene may still take, and so many
// times the compressed bytes. A triangle has half a byte in the smoothest meshes, and takes 160.
constexpr std::uint64_t kWorkShare = 3, kWorkOfByte = 320;

/// Opens the accessors of the attributes that are compressed; all others are read as they stand.
std::vector<DracoAttribute> attributesOf(const JsonPlace& primitive, const JsonPlace& extension,
                                         AccessorReader& accessors)
{
    const JsonPlace all = primitive.at("attributes");
    const JsonPlace ids = extension.at("attributes");
    std::vector<DracoAttribute> result;
    for (const auto& member : ids.value().items())
    {
        const std::uint64_t id = ids.at(member.key().c_str()).whole();
        if (id > std::numeric_limits<std::uint32_t>::max())
            ids.at(member.key().c_str()).refuse("is above 2^32 - 1");
        const Accessor layout = accessors.layout(all.at(member.key().c_str()));
        result.push_back({static_cast<std::uint32_t>(id), layout});
        if (layout.count != result.front().layout.count)
            layout.place.at("count").refuse("is not that of the primitive's other attributes");
    }
    if (result.empty()) ids.refuse("has no attributes");
    return result;
}

ByteRange rangeOf(std::string&& bytes)
{
    const std::uint64_t size = bytes.size();
    return {std::make_shared<MemoryBytes>(std::move(bytes)), 0, size};
}

} // namespace

/// Refuses an accessor that two compressed meshes give values: arrays are kept by accessors.
void DracoPrimitive::checkOrigin(const JsonPlace& index, const Origin& origin)
{
    const auto [held, isNew] = _origins.emplace(index.index(SIZE_MAX), origin);
    if (!isNew && (held->second.view != origin.view || held->second.attribute != origin.attribute))
        index.refuse("is the accessor of another compressed attribute as well");
}

void DracoPrimitive::open(const JsonPlace& primitive)
{
    _accessors->forgetDecoded();
    _open = false;
    const auto extension = primitive.extension(kName);
    if (!extension || !readsDraco()) return;
    Document& document = _accessors->document();
    const std::uint64_t mode = primitive.wholeOr("mode", kTriangles);
    const bool strip = mode == kTriangleStrip;
    if (mode != kTriangles && !strip)
        primitive.at("mode").refuse("is not that of triangles or of a strip, which alone may be "
                                    "compressed");
    const JsonPlace indexPlace = primitive.at("indices");
    const Accessor indices = _accessors->layout(indexPlace);
    if (indices.components != 1) indices.place.refuse("has indices that are no scalars");
    if (!strip && indices.count % 3 != 0) indices.place.at("count").refuse("is no multiple of 3");
    const std::vector<DracoAttribute> attributes = attributesOf(primitive, *extension, *_accessors);

    const std::size_t view = extension->at("bufferView").index(document.count("bufferViews"));
    const ByteRange range = document.bufferView(view);
    // A strip of n indices is at most n - 2 triangles.
    const std::uint64_t corners = (strip ? 3u : 1u) * std::uint64_t(indices.count);
    std::uint64_t decoded = corners * indices.elementSize();
    for (const DracoAttribute& attribute : attributes)
        decoded += std::uint64_t(attribute.layout.count) * attribute.layout.elementSize();
    document.take(range.size + decoded, *extension);
    std::string compressed(static_cast<std::size_t>(range.size), '\0');
    range.read(0, compressed.size(), compressed.data());

    const std::uint64_t work = kWorkShare * document.room() + kWorkOfByte * range.size;
    DracoMesh mesh =
        decodeDraco(compressed, indices, strip, attributes, work, extension->at("bufferView"));
    checkOrigin(indexPlace, {view, kIndices});
    const std::size_t count = mesh.indices.size() / indices.elementSize();
    _accessors->setDecoded(indexPlace.index(SIZE_MAX), rangeOf(std::move(mesh.indices)), count);
    _open = true;
    std::size_t i = 0;
    for (const auto& member : extension->at("attributes").value().items())
    {
        const JsonPlace index = primitive.at("attributes").at(member.key().c_str());
        checkOrigin(index, {view, attributes[i].id});
        _accessors->setDecoded(index.index(SIZE_MAX), rangeOf(std::move(mesh.attributes[i])),
                               attributes[i].layout.count);
        ++i;
    }
}

} // namespace osgRayTrace::gltf
