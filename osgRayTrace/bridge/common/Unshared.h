// Unshared.h - forgets in a cache what the application has let go of, and what nobody asks for.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Referenced>

#include <iterator>
#include <map>
#include <unordered_map>

namespace osgRayTrace::engine
{

/// Erases the entries whose object nobody holds but entries of the map. objectOf(entry) returns the
/// object, of which an entry holds one reference.
template <class Key, class Entry, class ObjectOf>
void eraseUnshared(std::map<Key, Entry>& entries, const ObjectOf& objectOf)
{
    std::unordered_map<const osg::Referenced*, int> held;
    for (const auto& [key, entry] : entries)
        ++held[objectOf(entry)];
    for (auto entry = entries.begin(); entry != entries.end();)
    {
        const osg::Referenced* object = objectOf(entry->second);
        const bool shared = !object || object->referenceCount() > held[object];
        entry = shared ? std::next(entry) : entries.erase(entry);
    }
}

/// Erases the entries whose member used is not this round.
template <class Map> void eraseUnused(Map& entries, unsigned int round)
{
    for (auto entry = entries.begin(); entry != entries.end();)
        entry = entry->second.used == round ? std::next(entry) : entries.erase(entry);
}

} // namespace osgRayTrace::engine
