// BufferContents.cpp - hashes of arrays. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/BufferContents.h"

#include "osgRayTrace/bridge/NodePrints.h"

#include <cstring>
#include <iterator>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kLanes = 8; ///< multiplications that do not wait for one another
constexpr uint64_t kFactor = 0x9e3779b97f4a7c15u;

struct Lanes
{
    uint64_t values[kLanes] = {1, 2, 3, 4, 5, 6, 7, 8};

    /// Each step can be undone if the words are known, so one word that differs shows in the end.
    void add(const unsigned char* block)
    {
        uint64_t words[kLanes];
        std::memcpy(words, block, sizeof words);
        for (std::size_t i = 0; i < kLanes; ++i)
        {
            const uint64_t product = (values[i] ^ words[i]) * kFactor;
            values[i] = product ^ product >> 32;
        }
    }
};

} // namespace

uint64_t contentHash(const void* data, std::size_t bytes)
{
    constexpr std::size_t kBlock = kLanes * sizeof(uint64_t);
    const auto* const begin = static_cast<const unsigned char*>(data);
    const std::size_t whole = bytes - bytes % kBlock;
    Lanes lanes;
    for (std::size_t at = 0; at < whole; at += kBlock)
        lanes.add(begin + at);
    unsigned char rest[kBlock] = {};
    if (bytes > whole) std::memcpy(rest, begin + whole, bytes - whole);
    lanes.add(rest);
    uint64_t hash = bytes;
    for (const uint64_t lane : lanes.values)
    {
        hash = (hash ^ lane) * kFactor;
        hash ^= hash >> 29;
    }
    return hash;
}

bool BufferContents::change(const osg::BufferData& data)
{
    const uint64_t print = contentsPrint(data);
    const bool same = _print == print;
    _print = print;
    return !same;
}

uint64_t BufferVersions::of(const osg::BufferData& data)
{
    const auto [known, isNew] = _entries.try_emplace(&data);
    Entry& entry = known->second;
    entry.round = _round;
    const uint64_t print = bufferPrint(bufferKindOf(data), data);
    if (!isNew && print == entry.print) return entry.version;
    if (isNew || entry.contents.change(data)) entry.version = ++_versions;
    if (isNew) entry.data = keep(&data);
    entry.print = print;
    return entry.version;
}

void BufferVersions::end()
{
    for (auto entry = _entries.begin(); entry != _entries.end();)
        entry = entry->second.round == _round ? std::next(entry) : _entries.erase(entry);
}

} // namespace osgRayTrace::engine
