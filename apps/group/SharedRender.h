// SharedRender.h - a render in a group, as each of its processes goes through it. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/group/Coordinator.h"
#include "apps/group/Group.h"
#include "apps/group/PassWorker.h"

#include <functional>

namespace osgRayTrace::app
{

/// What a render in a group asks its process for, on the thread that calls.
struct GroupHooks
{
    std::function<double()> now;         ///< a clock that never goes back [s]
    std::function<bool()> isInterrupted; ///< whether the user wants an end
    /// Shows how far the render is; may be empty.
    std::function<void(int passes, const RayTotals& rays, double seconds)> progress;
};

/// Makes passes on rank 0, shares them out, and returns the sums of all. All other ranks call
/// helpToRender(), and get no more passes when this returns. Aborts the group if a rank is silent.
GroupResult renderInGroup(Group& group, PassWork work, GroupPlan plan, Coordinator::Judge judge,
                          const GroupHooks& hooks);

/// Makes passes on another rank, until rank 0 wants no more.
void helpToRender(Group& group, PassWork work, const GroupHooks& hooks);

/// Tells rank 0, from another one, that this rank can do nothing.
void reportFailure(Group& group, int exitCode, const std::string& failure);

/// Lets the other ranks leave, from rank 0; the last message of a group.
void sayBye(Group& group);

/// Waits on another rank until it may leave.
void waitForBye(Group& group);

} // namespace osgRayTrace::app
