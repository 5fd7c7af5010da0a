// MemoryHash.cpp - a hash of memory. Layer: base.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/MemoryHash.h"

#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kLanes = 8; ///< multiplications that do not wait for one another
constexpr uint64_t kFactor = 0x9e3779b97f4a7c15u;

struct Lanes
{
    uint64_t values[kLanes] = {1, 2, 3, 4, 5, 6, 7, 8};

    /// Adds a block. Each step can be undone if the words are known, so one word that differs shows
    /// in the end.
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

uint64_t memoryHash(const void* data, std::size_t bytes)
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

} // namespace osgRayTrace::engine
