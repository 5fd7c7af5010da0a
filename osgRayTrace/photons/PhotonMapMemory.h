// PhotonMapMemory.h - the memory of a photon map, for the next map. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonMap.h"

#include <mutex>
#include <utility>

namespace osgRayTrace::engine
{

/// Keeps a photon map that nothing reads any more until the next map takes its memory. The system
/// would have to clear new memory page by page, which all threads that sort photons wait for.
/// Thread safe.
class PhotonMapMemory
{
public:
    /// Returns the map that was given back last; one without photons if there is none.
    PhotonMap take()
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return std::exchange(_map, PhotonMap());
    }

    /// Keeps a map in place of the one that is kept, or frees it if it is large.
    void giveBack(PhotonMap map) noexcept
    {
        if (map.bytes() > kMostBytes) return;
        const std::lock_guard<std::mutex> lock(_mutex);
        std::swap(_map, map);
    }

    /// Returns the size of the map that is kept.
    std::size_t bytes() const
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        return _map.bytes();
    }

private:
    static constexpr std::size_t kMostBytes = std::size_t(1) << 27;

    mutable std::mutex _mutex;
    PhotonMap _map;
};

} // namespace osgRayTrace::engine
