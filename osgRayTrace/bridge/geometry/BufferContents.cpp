// BufferContents.cpp - compares hashes of arrays' contents. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/BufferContents.h"

#include "osgRayTrace/bridge/geometry/BufferHashes.h"

#include <iterator>

namespace osgRayTrace::engine
{

bool BufferContents::change(const osg::BufferData& data)
{
    const uint64_t hash = contentsHash(data);
    const bool same = _hash == hash;
    _hash = hash;
    return !same;
}

uint64_t BufferVersions::of(const osg::BufferData& data)
{
    const auto [known, isNew] = _entries.try_emplace(&data);
    Entry& entry = known->second;
    entry.round = _round;
    const uint64_t hash = bufferHash(bufferKindOf(data), data);
    if (!isNew && hash == entry.hash) return entry.version;
    if (isNew || entry.contents.change(data)) entry.version = ++_versions;
    if (isNew) entry.data = keep(&data);
    entry.hash = hash;
    return entry.version;
}

void BufferVersions::end()
{
    for (auto entry = _entries.begin(); entry != _entries.end();)
        entry = entry->second.round == _round ? std::next(entry) : _entries.erase(entry);
}

} // namespace osgRayTrace::engine
