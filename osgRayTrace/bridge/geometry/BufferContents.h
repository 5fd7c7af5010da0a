// BufferContents.h - whether the values of arrays have changed, whatever their modified counts say.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ObjectIdentity.h"

#include <osg/BufferObject>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>

namespace osgRayTrace::engine
{

/// Animations of osgAnimation's write their arrays and mark them as modified in each frame, also
/// where nothing moves. So where a modified count has changed the values decide.

/// The values of one array or primitive set, as of the last call of change().
class BufferContents
{
public:
    /// False if the values are those of the last call; true for the first one, which has nothing to
    /// compare with: arrays that are never modified are never read for this.
    bool change(const osg::BufferData& data);

private:
    std::optional<uint64_t> _hash;
};

/// Numbers for the contents of many buffers. Keeps the buffers of the last round alive.
class BufferVersions
{
public:
    void begin() { ++_round; }

    /// Another number if the values are others than in an earlier round.
    uint64_t of(const osg::BufferData& data);

    /// Forgets buffers that this round did not ask for.
    void end();

private:
    struct Entry
    {
        Kept<const osg::BufferData> data;
        uint64_t hash = 0; ///< see bufferHash
        BufferContents contents;
        uint64_t version = 0;
        uint64_t round = 0;
    };

    std::unordered_map<const osg::BufferData*, Entry> _entries;
    uint64_t _round = 0, _versions = 0;
};

} // namespace osgRayTrace::engine
