// NoMpi.cpp - stands for MpiGroup.cpp in builds without MPI. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/group/MpiGroup.h"

namespace osgRayTrace::app
{

std::unique_ptr<Group> mpiGroup()
{
    return nullptr;
}

std::string mpiName()
{
    return {};
}

} // namespace osgRayTrace::app
