// HostArrays.cpp - keeps and frees arrays of the host that a scene reads in place. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/HostArrays.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <list>
#include <mutex>

namespace osgRayTrace::engine
{

namespace
{

using Arrays = std::list<osg::ref_ptr<const osg::BufferData>>;

struct Released
{
    std::mutex mutex; // any thread adds arrays, threads of updates remove them
    Arrays arrays;
};

Released& released()
{
    static NeverDestroyed<Released> all;
    return *all;
}

/// Moves the list of one array as it is, because letting go of the array must not need memory.
void release(Arrays* one)
{
    {
        std::lock_guard<std::mutex> lock(released().mutex);
        released().arrays.splice(released().arrays.end(), *one);
    }
    delete one;
}

} // namespace

std::shared_ptr<const void> keepHostArray(const osg::BufferData& array)
{
    auto one = std::make_unique<Arrays>(1, &array);
    return std::shared_ptr<Arrays>(one.release(), release);
}

void releaseHostArrays() noexcept
{
    Arrays arrays;
    std::lock_guard<std::mutex> lock(released().mutex);
    arrays.swap(released().arrays);
}

} // namespace osgRayTrace::engine
