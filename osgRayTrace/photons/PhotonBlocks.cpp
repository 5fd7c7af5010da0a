// PhotonBlocks.cpp - lists of photons in blocks, whose memory passes share. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonBlocks.h"

#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

namespace osgRayTrace::engine
{

PhotonSpans::PhotonSpans(const std::vector<Photon>& photons)
{
    _spans.reserve((photons.size() + kSpanPhotons - 1) / kSpanPhotons);
    for (std::size_t k = 0; k < photons.size(); k += kSpanPhotons)
        add({photons.data() + k,
             static_cast<uint32_t>(std::min<std::size_t>(kSpanPhotons, photons.size() - k))});
}

std::vector<Photon> listOf(const PhotonSpans& photons)
{
    std::vector<Photon> list;
    for (const PhotonSpan& span : photons)
        list.insert(list.end(), span.begin(), span.end());
    return list;
}

PhotonMemory::Block PhotonMemory::take()
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (!_free.empty())
        {
            Block block = std::move(_free.back());
            _free.pop_back();
            return block;
        }
    }
    return Block(new Photon[kSpanPhotons]);
}

void PhotonMemory::giveBack(Block block) noexcept
{
    constexpr std::size_t kMost = kMostBytes / (kSpanPhotons * sizeof(Photon));
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_free.size() >= kMost) return;
    try
    {
        _free.push_back(std::move(block));
    }
    catch (const std::bad_alloc&)
    {
        // The block is freed like those that are too many.
    }
}

std::size_t PhotonMemory::bytes() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _free.size() * kSpanPhotons * sizeof(Photon);
}

PhotonBlocks::~PhotonBlocks()
{
    // The next list takes the blocks in the order in which this one took them.
    for (; !_blocks.empty(); _blocks.pop_back())
        _memory->giveBack(std::move(_blocks.back().photons));
}

std::size_t PhotonBlocks::size() const
{
    std::size_t sum = 0;
    for (const Filled& block : _blocks)
        sum += block.count;
    return sum;
}

void PhotonBlocks::append(PhotonBlocks&& other)
{
    std::move(other._blocks.begin(), other._blocks.end(), std::back_inserter(_blocks));
    other._blocks.clear();
}

PhotonSpans PhotonBlocks::spans() const
{
    PhotonSpans spans;
    for (const Filled& block : _blocks)
        spans.add({block.photons.get(), block.count});
    return spans;
}

} // namespace osgRayTrace::engine
