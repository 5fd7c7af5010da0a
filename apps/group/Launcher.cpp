// Launcher.cpp - the environment of mpirun and srun, and affinities. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/group/Launcher.h"

#include "osgRayTrace/base/NumberText.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>

namespace osgRayTrace::app
{

namespace
{

/// Returns how many processors a list of the kernel's holds: "0,64" or "0-1".
int countOf(const std::string& list)
{
    int count = 0;
    for (std::size_t begin = 0; begin < list.size();)
    {
        const std::size_t comma = std::min(list.find(',', begin), list.size());
        const std::string range = list.substr(begin, comma - begin);
        const std::size_t dash = range.find('-');
        const auto first = engine::parseNumber<int>(range.substr(0, dash));
        const auto last =
            dash == std::string::npos ? first : engine::parseNumber<int>(range.substr(dash + 1));
        if (!first || !last || *last < *first) return 1;
        count += *last - *first + 1;
        begin = comma + 1;
    }
    return std::max(count, 1);
}

int processorsOfCore()
{
    std::ifstream file("/sys/devices/system/cpu/cpu0/topology/thread_siblings_list");
    std::string list;
    return file >> list ? countOf(list) : 1;
}

} // namespace

Launch launch()
{
    // Open MPI's, MPICH's and Slurm's. SLURM_NTASKS is set in batch scripts, too, which are one
    // process.
    for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"})
    {
        const char* value = std::getenv(variable);
        const auto count = value ? engine::parseNumber<int>(value) : std::nullopt;
        if (count && *count > 1) return {*count, variable};
    }
    return {};
}

std::string whyNotAlone()
{
    const Launch started = launch();
    if (started.processes == 1) return {};
    return std::to_string(started.processes) +
           " processes were started, and each would make the whole picture: --mpi lets them share "
           "it, and processes with work of their own unset " +
           started.variable;
}

std::string hostName()
{
    char name[256] = "";
    return gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

Processors processors()
{
    Processors result;
    result.machine = std::max(1, static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)));
    result.own = result.machine;
    result.core = processorsOfCore();
    cpu_set_t own;
    if (sched_getaffinity(0, sizeof own, &own) == 0) result.own = std::max(1, CPU_COUNT(&own));
    return result;
}

int threadsOf(const Processors& processors, int ranksOnMachine)
{
    // Ranks that are held on a part of the machine have it for themselves.
    const bool areHeld = processors.own < processors.machine;
    return areHeld ? processors.own : std::max(1, processors.own / std::max(1, ranksOnMachine));
}

std::string bindingNote(const std::vector<RankPlace>& ranks)
{
    struct Machine
    {
        int ranks = 0;
        Processors most{0, 1, 1};
    };
    std::map<std::string, Machine> machines;
    for (const RankPlace& rank : ranks)
    {
        Machine& machine = machines[rank.host];
        ++machine.ranks;
        if (rank.processors.own > machine.most.own) machine.most = rank.processors;
    }
    for (const auto& [host, machine] : machines)
    {
        const Processors& most = machine.most;
        if (most.own > most.core || machine.ranks * most.own >= most.machine) continue;
        return "each rank on " + host + " may use " + std::to_string(most.own) + " of " +
               std::to_string(most.machine) +
               " processors: mpirun --bind-to none or srun --cpus-per-task lets it use more";
    }
    return {};
}

} // namespace osgRayTrace::app
