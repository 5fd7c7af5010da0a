// RunInGroup.cpp - osgraytrace --mpi: what each of the processes does. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Run.h"
#include "apps/common/Failure.h"
#include "apps/common/Interruption.h"
#include "apps/common/ModelFiles.h"
#include "apps/common/Program.h"
#include "apps/group/Launcher.h"
#include "apps/group/MpiGroup.h"
#include "apps/group/SharedRender.h"

#include <cstdio>
#include <exception>
#include <iostream>

namespace osgRayTrace::app
{

namespace
{

/// Returns the group. Throws Failure(kUsage).
std::unique_ptr<Group> groupOfOptions(const Options& options)
{
    if (options.settings->getRadiusSchedule() == RayTraceSettings::LOCAL)
        throw Failure(kUsage, "radius-schedule local: each pass depends on all before it, so that "
                              "processes cannot share them");
    std::unique_ptr<Group> group = mpiGroup();
    if (!group)
        throw Failure(kUsage, "--mpi: this build has no MPI (OSGRAYTRACE_MPI of its CMake)");
    const int started = launch().processes;
    if (group->size() == 1 && started > 1)
        throw Failure(kUsage,
                      std::to_string(started) +
                          " processes were started, but none sees another: this build has " +
                          mpiName() + ", and the launcher belongs to another MPI");
    return group;
}

/// Makes passes for rank 0. Failures are told to rank 0, which ends all.
void help(Options options, Group& group)
{
    try
    {
        if (options.sendsScene) return helpWithoutModel(std::move(options), group);
        checkMaterials(options);
        const osg::ref_ptr<osg::Node> scene = lit(readScene(options.models), options.lights);
        takeSettingsOf(*scene, options);
        TimedScene shown(options, scene);
        shown.clock.goTo(options.at);
        helpInGroup(options, shown, cameraOf(options, *scene, shown.home), group);
    }
    catch (const Failure& failure)
    {
        reportFailure(group, failure.code(), failure.what());
    }
    catch (const std::exception& error)
    {
        reportFailure(group, kCannotRender, error.what());
    }
}

/// Renders and writes the picture. Returns the exit code.
int lead(const Options& options, Group& group)
{
    try
    {
        checkMaterials(options);
        return runPicture(options, &group);
    }
    catch (const Failure& failure)
    {
        return reportFailure(kProgram, failure);
    }
    catch (const std::exception& error)
    {
        return reportFailure(kProgram, Failure(kCannotRender, error.what()));
    }
}

} // namespace

int runInGroup(const Options& given)
{
    const std::unique_ptr<Group> group = groupOfOptions(given);
    Options options = given;
    // Ranks on one machine share its processors, unless the user says how many threads each has.
    if (options.settings->getThreads() == 0)
    {
        const int threads = threadsOf(processors(), group->localSize());
        options.assignments.emplace_back("threads", std::to_string(threads));
        options.settings->setThreads(threads);
    }
    if (group->rank() > 0)
    {
        const OrderlyEnd end; // rank 0 is told of a signal
        help(options, *group);
        waitForBye(*group);
        return kDone;
    }
    const int code = lead(options, *group);
    std::cout << std::flush;
    std::fflush(stdout);
    sayBye(*group);
    return code;
}

} // namespace osgRayTrace::app
