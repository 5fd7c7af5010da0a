// BufferContents.h - tells whether the values of arrays have changed, regardless of modified
// counts. Layer: bridge.
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

/// The animations of osgAnimation write their arrays and mark them as modified in each frame, even
/// if nothing moves. Once a modified count has changed, the values therefore decide.

/// Holds a hash of the values of one array or primitive set, as of the last call of change().
class BufferContents
{
public:
    /// Returns whether the values differ from those of the last call. The first call has nothing to
    /// compare with and returns true: arrays that are never modified are never read for this.
    bool change(const osg::BufferData& data);

private:
    std::optional<uint64_t> _hash;
};

/// Numbers the contents of many buffers. The buffers of the last round are kept alive.
class BufferVersions
{
public:
    void begin() { ++_round; }

    /// Returns a number that changes if the values differ from those of an earlier round.
    uint64_t of(const osg::BufferData& data);

    /// Forgets the buffers that this round did not ask for.
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
