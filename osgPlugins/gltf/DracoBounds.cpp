// DracoBounds.cpp - reads past what the library will read. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/DracoBounds.h"

#include <draco/compression/config/compression_shared.h>
#include <draco/compression/entropy/symbol_decoding.h>
#include <draco/core/varint_decoding.h>

#include <vector>

namespace osgRayTrace::gltf
{

namespace
{

constexpr std::uint32_t kMostMetadata = 65536; ///< nodes and entries
constexpr std::size_t kDeepestMetadata = 64;

bool skip(draco::DecoderBuffer& bytes, std::uint64_t count)
{
    if (count > static_cast<std::uint64_t>(bytes.remaining_size())) return false;
    bytes.Advance(static_cast<std::int64_t>(count));
    return true;
}

bool skipName(draco::DecoderBuffer& bytes)
{
    std::uint8_t length = 0;
    return bytes.Decode(&length) && skip(bytes, length);
}

bool skipEntry(draco::DecoderBuffer& bytes)
{
    std::uint32_t size = 0;
    return skipName(bytes) && draco::DecodeVarint(&size, &bytes) && skip(bytes, size);
}

/// Skips a node, with its name unless it is the root, and its children. left: how many nodes and
/// entries there may still be.
bool skipNodes(draco::DecoderBuffer& bytes, std::uint32_t& left)
{
    std::vector<std::uint32_t> children; // that are still to come, of each node above
    do
    {
        if (!children.empty())
        {
            --children.back();
            if (!skipName(bytes)) return false;
        }
        std::uint32_t entries = 0, below = 0;
        if (left-- == 0 || !draco::DecodeVarint(&entries, &bytes) || entries > left) return false;
        for (std::uint32_t i = 0; i < entries; ++i)
            if (!skipEntry(bytes)) return false;
        left -= entries;
        if (!draco::DecodeVarint(&below, &bytes) || below > left) return false;
        children.push_back(below);
        if (children.size() > kDeepestMetadata) return false;
        while (!children.empty() && children.back() == 0)
            children.pop_back();
    } while (!children.empty());
    return true;
}

} // namespace

std::optional<DracoCounts> dracoCounts(draco::DecoderBuffer bytes, bool edgebreaker)
{
    if (bytes.bitstream_version() != DRACO_BITSTREAM_VERSION(2, 2)) return std::nullopt;
    std::uint8_t seamAttributes = 0;
    std::uint32_t faces = 0, points = 0;
    if (!edgebreaker)
    {
        if (!draco::DecodeVarint(&faces, &bytes) || !draco::DecodeVarint(&points, &bytes))
            return std::nullopt;
        return DracoCounts{faces, points, 0};
    }
    if (!draco::DecodeVarint(&points, &bytes) || !draco::DecodeVarint(&faces, &bytes) ||
        !bytes.Decode(&seamAttributes))
        return std::nullopt;
    return DracoCounts{faces, points, seamAttributes};
}

bool isSmallDracoMetadata(draco::DecoderBuffer bytes)
{
    std::uint32_t left = kMostMetadata, attributes = 0;
    if (!draco::DecodeVarint(&attributes, &bytes) || attributes > left) return false;
    for (std::uint32_t i = 0; i < attributes; ++i)
    {
        std::uint32_t id = 0;
        if (!draco::DecodeVarint(&id, &bytes) || !skipNodes(bytes, left)) return false;
    }
    return skipNodes(bytes, left);
}

bool dracoOrientationsFit(draco::DecoderBuffer bytes, std::uint32_t values, std::uint8_t components)
{
    const char method = bytes.data_head()[-2];
    const bool portable = method == draco::MESH_PREDICTION_TEX_COORDS_PORTABLE;
    if (!portable && method != draco::MESH_PREDICTION_TEX_COORDS_DEPRECATED) return true;
    const std::uint32_t numbers = values * components; // both are bounded by the mesh
    std::uint8_t compressed = 0, size = 0;
    if (!bytes.Decode(&compressed)) return true;
    if (compressed > 0)
    {
        std::vector<std::uint32_t> ignored(numbers);
        if (!draco::DecodeSymbols(numbers, components, &bytes, ignored.data())) return true;
    }
    else if (!bytes.Decode(&size) || !skip(bytes, std::uint64_t(size) * numbers))
        return true;
    std::uint32_t orientations = 0; // a negative number is too large, too
    const bool read =
        portable ? bytes.Decode(&orientations) : draco::DecodeVarint(&orientations, &bytes);
    return !read || orientations <= values;
}

} // namespace osgRayTrace::gltf
