// HostArrays.h - keeps and frees arrays of the host that a scene reads in place. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/BufferObject>

#include <memory>

namespace osgRayTrace::engine
{

/// Keeps the array for as long as the result or a copy of it lives, and then until
/// releaseHostArrays(). The last thread to let go of a scene may be one that draws or traces in the
/// background. But an array that is deleted removes itself from the list of its osg::BufferObject,
/// which OSG changes without a lock. Throws std::bad_alloc.
std::shared_ptr<const void> keepHostArray(const osg::BufferData& array);

/// Frees those kept arrays that no scene needs any more, if nobody else holds them. Only threads
/// that may change the host's graph call this. Never throws.
void releaseHostArrays() noexcept;

/// Calls releaseHostArrays() when it is destroyed. It is the last member to be destroyed of an
/// object that held scenes.
struct HostArraysRelease
{
    ~HostArraysRelease() { releaseHostArrays(); }
};

} // namespace osgRayTrace::engine
