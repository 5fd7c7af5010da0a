// InstanceOrder.h - puts instances of the static BVH before placed instances. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Puts the instances that are not placed first, so that their indices, which the static BVH holds,
/// do not depend on the placed instances. Returns the new index of each instance.
inline std::vector<uint32_t> putFlatFirst(std::vector<Instance>& instances)
{
    std::vector<uint32_t> order(instances.size()), now(instances.size());
    for (uint32_t i = 0; i < order.size(); ++i)
        order[i] = i;
    std::stable_partition(order.begin(), order.end(),
                          [&](uint32_t i) { return !instances[i].placed; });
    std::vector<Instance> sorted;
    sorted.reserve(instances.size());
    for (uint32_t i = 0; i < order.size(); ++i)
    {
        sorted.push_back(instances[order[i]]);
        now[order[i]] = i;
    }
    instances.swap(sorted);
    return now;
}

} // namespace osgRayTrace::engine
