// Prefetch.h - memory of nodes and arrays is fetched before a look reads it. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/changes/WatchedGraph.h"

#include <cstddef>

namespace osgRayTrace::engine
{

/// The look at an unchanged graph takes 0.65 of the time with this: 40,000 drawables below
/// transforms of their own, which lie in memory in no order. So many objects ahead are fetched.
constexpr std::size_t kAhead = 16;

// Offsets in bytes of what a look reads [OSG 3.6.5 on 64 bits]. They are hints: with other offsets
// a look is slower, but not wrong. A test compares them with the members.
constexpr int kGroupBytes[] = {64, 200, 264, 328};
constexpr int kGeometryBytes[] = {64, 200, 332, 392, 440};
constexpr int kBufferBytes[] = {72, 136};

template <std::size_t N> inline void fetch(const void* object, const int (&bytes)[N])
{
    for (const int byte : bytes)
        __builtin_prefetch(static_cast<const char*>(object) + byte);
}

inline void fetch(const WatchedNode& node)
{
    if (node.kind == NodeKind::Geometry)
        fetch(node.node, kGeometryBytes);
    else
        fetch(node.node, kGroupBytes);
}

} // namespace osgRayTrace::engine
