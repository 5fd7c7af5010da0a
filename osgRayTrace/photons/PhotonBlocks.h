// PhotonBlocks.h - lists of photons in blocks, whose memory passes share. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/Photon.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// The most photons of a span: a power of two.
constexpr uint32_t kSpanPhotons = 512;

/// Photons that lie one after the other in memory.
struct PhotonSpan
{
    const Photon* photons = nullptr;
    uint32_t count = 0; ///< at most kSpanPhotons

    const Photon* begin() const { return photons; }
    const Photon* end() const { return photons + count; }
};

/// A list of photons in spans. It holds no photons, which must outlive it. The place of a photon is
/// the number of its span times kSpanPhotons, and its index in the span: places are in the order of
/// the list, and where a span is not full places are without photons.
class PhotonSpans
{
public:
    PhotonSpans() = default;
    PhotonSpans(const std::vector<Photon>& photons); // implicit: a vector is some spans, too

    /// Appends a span.
    void add(PhotonSpan span)
    {
        _spans.push_back(span);
        _size += span.count;
    }

    std::size_t size() const { return _size; }                          ///< number of photons
    std::size_t spans() const { return _spans.size(); }                 ///< number of spans
    std::size_t places() const { return _spans.size() * kSpanPhotons; } ///< end of all places
    const PhotonSpan& span(std::size_t index) const { return _spans[index]; }
    std::vector<PhotonSpan>::const_iterator begin() const { return _spans.begin(); }
    std::vector<PhotonSpan>::const_iterator end() const { return _spans.end(); }

    /// Returns the photon at a place.
    const Photon& operator[](std::size_t place) const
    {
        return _spans[place / kSpanPhotons].photons[place % kSpanPhotons];
    }

private:
    std::vector<PhotonSpan> _spans;
    std::size_t _size = 0;
};

/// Returns the photons of a list as a copy.
std::vector<Photon> listOf(const PhotonSpans& photons);

/// Keeps the memory of lists of photons for the lists of the next pass, as long as it lives itself:
/// new memory costs as much time as all that is written to it, since the system clears it page by
/// page. Thread safe.
class PhotonMemory
{
public:
    using Block = std::unique_ptr<Photon[]>; ///< kSpanPhotons photons of any values

    /// Returns a block that was given back, or a new one.
    Block take();

    /// Keeps a block for take(), or frees it.
    void giveBack(Block block) noexcept;

    std::size_t bytes() const; ///< memory of the blocks that are kept for the next lists

private:
    /// No more is kept between passes.
    static constexpr std::size_t kMostBytes = std::size_t(1) << 27;

    mutable std::mutex _mutex;
    std::vector<Block> _free;
};

/// A list of photons in memory that it takes block by block, and gives back in the end.
class PhotonBlocks
{
public:
    PhotonBlocks() = default;
    explicit PhotonBlocks(PhotonMemory& memory) : _memory(&memory) {} ///< memory: outlives the list
    ~PhotonBlocks();
    PhotonBlocks(PhotonBlocks&& other) noexcept = default;
    PhotonBlocks& operator=(PhotonBlocks&& other) noexcept
    {
        std::swap(_memory, other._memory);
        _blocks.swap(other._blocks);
        return *this;
    }

    std::size_t size() const; ///< number of photons

    /// Returns room for count more photons, at most kSpanPhotons, which push() adds.
    Photon* room(uint32_t count)
    {
        if (_blocks.empty() || _blocks.back().count + count > kSpanPhotons)
            _blocks.push_back({_memory->take(), 0});
        return &_blocks.back().photons[_blocks.back().count];
    }

    /// Adds the first count photons of the room.
    void push(uint32_t count) { _blocks.back().count += count; }

    /// Appends another list of the same memory, and leaves it empty.
    void append(PhotonBlocks&& other);

    PhotonSpans spans() const; ///< valid as long as this list is and does not change

private:
    struct Filled
    {
        PhotonMemory::Block photons;
        uint32_t count;
    };

    PhotonMemory* _memory = nullptr;
    std::vector<Filled> _blocks;
};

} // namespace osgRayTrace::engine
