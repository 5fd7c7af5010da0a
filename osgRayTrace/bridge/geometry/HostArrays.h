// HostArrays.h - arrays of the host that a scene reads in place, and who frees them. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/BufferObject>

#include <memory>

namespace osgRayTrace::engine
{

/// Keeps the array for as long as the result or a copy of it lives, and then until
/// releaseHostArrays(): a thread that draws, or traces in the background, may be the last to let go
/// of a scene, but an array takes itself off the list of its osg::BufferObject, which OSG changes
/// without a lock. Throws std::bad_alloc.
std::shared_ptr<const void> keepHostArray(const osg::BufferData& array);

/// Frees those arrays that no scene needs any more, if nobody else does. To be called by threads
/// that may change the host's graph. Never throws.
void releaseHostArrays() noexcept;

/// Does so when it goes: the last member to be destroyed of what held scenes.
struct HostArraysRelease
{
    ~HostArraysRelease() { releaseHostArrays(); }
};

} // namespace osgRayTrace::engine
