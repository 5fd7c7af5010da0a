// MemoryHash.h - hashes of memory and of pairs of numbers. Layer: base.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

namespace osgRayTrace::engine
{

/// Returns a hash of two numbers: both halves of their product.
inline uint64_t fold(uint64_t a, uint64_t b)
{
    const auto product =
        static_cast<unsigned __int128>(a ^ 0x9e3779b97f4a7c15u) * (b ^ 0xbf58476d1ce4e5b9u);
    return static_cast<uint64_t>(product) ^ static_cast<uint64_t>(product >> 64);
}

/// Returns an address as a number.
inline uint64_t bitsOf(const void* pointer)
{
    return reinterpret_cast<uintptr_t>(pointer);
}

/// Returns a hash of memory: blocks of 64 bytes that differ in one word never have equal hashes.
uint64_t memoryHash(const void* data, std::size_t bytes);

} // namespace osgRayTrace::engine
