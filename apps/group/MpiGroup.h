// MpiGroup.h - the processes that mpirun or srun have started. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/group/Group.h"

#include <memory>
#include <string>

namespace osgRayTrace::app
{

/// Returns the group of this process, or nothing if this build has no MPI; called once. The group
/// ends, for all ranks together, with the object.
std::unique_ptr<Group> mpiGroup();

/// Returns the name and version of the MPI that this build has; empty: none.
std::string mpiName();

} // namespace osgRayTrace::app
