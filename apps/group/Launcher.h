// Launcher.h - what started this process, and on which processors it may run. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/group/GroupMessage.h"

#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// Returns why a process that makes a whole picture should not go on: mpirun or srun has started
/// several of them. Empty if it may.
std::string whyNotAlone();

/// Returns how many processes mpirun, mpiexec or srun have started together, and the variable that
/// says so; 1 and no name without them.
struct Launch
{
    int processes = 1;
    std::string variable;
};
Launch launch();

/// Returns the machine's name.
std::string hostName();

/// Returns how many processors this process may use, and how many there are.
Processors processors();

/// Returns how many threads each of some ranks on one machine takes, so that together they take its
/// processors once.
int threadsOf(const Processors& processors, int ranksOnMachine);

/// Where a rank runs.
struct RankPlace
{
    std::string host;
    Processors processors;
};

/// Returns one sentence if the launcher holds all ranks of a machine on one core each while it has
/// more cores than ranks; otherwise empty.
std::string bindingNote(const std::vector<RankPlace>& ranks);

} // namespace osgRayTrace::app
