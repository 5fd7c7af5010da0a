// SceneParts.h - the parts and the lists of a scene in a message. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/servers/SceneFields.h"

#include <algorithm>
#include <memory>
#include <variant>
#include <vector>

namespace osgRayTrace::engine
{

/// The kinds of parts that lists name by number.
enum class PartKind : uint8_t
{
    None, ///< ends the parts of a message
    Floats,
    Vec2s,
    Vec3s,
    Vec4s,
    Triangles,
    Mesh,
    Texture,
    EnvironmentImage,
    VolumeImage,
};
template <> struct LastEnumerator<PartKind>
{
    static constexpr PartKind value = PartKind::VolumeImage;
};

template <class T> constexpr PartKind kArrayKind = PartKind::None;
template <> inline constexpr PartKind kArrayKind<float> = PartKind::Floats;
template <> inline constexpr PartKind kArrayKind<Vec2> = PartKind::Vec2s;
template <> inline constexpr PartKind kArrayKind<Vec3> = PartKind::Vec3s;
template <> inline constexpr PartKind kArrayKind<Vec4> = PartKind::Vec4s;
template <> inline constexpr PartKind kArrayKind<UVec3> = PartKind::Triangles;

/// An array of a mesh, of any type.
using MeshArray = std::variant<SharedArray<float>, SharedArray<Vec2>, SharedArray<Vec3>,
                               SharedArray<Vec4>, SharedArray<UVec3>>;

/// Calls use(array) for each array of a mesh, in the order of its members.
template <class MeshType, class Use> void forEachArray(MeshType& mesh, const Use& use)
{
    use(mesh.positions);
    use(mesh.triangles);
    use(mesh.normals);
    use(mesh.uvs);
    use(mesh.uvs1);
    use(mesh.rs);
    use(mesh.rs1);
    use(mesh.colors);
    use(mesh.tangents);
    for (auto& uvs : mesh.moreUvs)
        use(uvs);
}

/// Lists travel in blocks of so many elements; hashes tell which blocks the receiver has.
constexpr std::size_t kListBlock = 64;
using BlockHashes = std::vector<uint64_t>;

/// Writes a list: its size, and the blocks that have changed since the last call with these hashes.
/// put(writer, element) writes an element.
template <class T, class Put>
void putList(WireWriter& out, const std::vector<T>& list, BlockHashes& known, const Put& put)
{
    known.resize((list.size() + kListBlock - 1) / kListBlock, 0);
    Bytes changed, block;
    uint64_t count = 0;
    for (std::size_t b = 0; b < known.size(); ++b)
    {
        block.clear();
        WireWriter elements(block);
        const std::size_t end = std::min(list.size(), (b + 1) * kListBlock);
        for (std::size_t i = b * kListBlock; i < end; ++i)
            put(elements, list[i]);
        const uint64_t hash = memoryHash(block.data(), block.size()) | 1; // 0: not sent yet
        if (std::exchange(known[b], hash) == hash) continue;
        ++count;
        WireWriter all(changed);
        all(static_cast<uint64_t>(b));
        all.append(block.data(), block.size());
    }
    out(static_cast<uint64_t>(list.size()), count);
    out.append(changed.data(), changed.size());
}

/// Reads a list over the one that is there. take(reader, index) reads an element; size(count) is
/// called first, with a size that the message may well fill.
template <class T, class Take> bool takeList(WireReader& in, std::vector<T>& list, const Take& take)
{
    uint64_t size = 0, blocks = 0;
    in(size, blocks);
    constexpr std::size_t kLeast = (sizeof(T) + 3) / 4; // bytes of an element in a message
    if (!in.good()) return false;
    if (size > list.size() && size - list.size() > in.left() / kLeast) return false;
    list.resize(static_cast<std::size_t>(size));
    for (uint64_t n = 0; n < blocks; ++n)
    {
        uint64_t block = 0;
        in(block);
        if (!in.good() || block >= (size + kListBlock - 1) / kListBlock) return false;
        const auto first = static_cast<std::size_t>(block) * kListBlock;
        const std::size_t end = std::min(list.size(), first + kListBlock);
        for (std::size_t i = first; i < end && in.good(); ++i)
            take(in, i);
    }
    return in.good();
}

} // namespace osgRayTrace::engine
