// CheckpointKeeper.cpp - reads the checkpoint before a render, and writes it during and after.
// Layer: apps.
// SPDX-License-Identifier: MIT
#include "CheckpointKeeper.h"

#include "Run.h"
#include "apps/common/ErrorLine.h"
#include "apps/common/Failure.h"
#include "apps/common/Output.h"
#include "apps/common/Program.h"

#include <filesystem>

namespace osgRayTrace::app
{

namespace
{

/// Writes a checkpoint if it has passes. Returns the exit code: a failure is printed, as the
/// picture is there still, and there may be room later.
int write(const std::string& path, const Checkpoint& checkpoint, bool hasPasses)
{
    try
    {
        if (hasPasses && checkpoint.sums.passes.empty())
            throw cannotWrite(path, "there is not enough memory");
        if (hasPasses) writeCheckpoint(path, checkpoint);
        return kDone;
    }
    catch (const Failure& failure)
    {
        return reportFailure(kProgram, failure);
    }
}

} // namespace

CheckpointKeeper::CheckpointKeeper(const Options& options, const osg::Vec4& clearColor,
                                   Renderer& renderer)
    : _options(options),
      _clearColor(clearColor),
      _renderer(renderer),
      _kept(std::chrono::steady_clock::now())
{
    if (options.isPart() && options.settings->getRadiusSchedule() == RayTraceSettings::LOCAL)
        throw Failure(kUsage, "radius-schedule local: each pass depends on all before it, so that "
                              "passes cannot be made apart");
    if (options.checkpoint.empty() || !std::filesystem::exists(options.checkpoint)) return;
    Checkpoint before = readCheckpoint(options.checkpoint);
    printError(kProgram, options.checkpoint + ": goes on from passes " + before.sums.passes);
    renderer.setPassSums(std::move(before.sums));
}

void CheckpointKeeper::keepIfDue()
{
    using Clock = std::chrono::steady_clock;
    if (_options.checkpoint.empty()) return;
    const std::chrono::duration<double> since = Clock::now() - _kept;
    const bool isWriting =
        _writing.valid() && _writing.wait_for(Clock::duration(0)) != std::future_status::ready;
    if (since.count() < _options.interval || isWriting) return;
    _kept = Clock::now();
    try
    {
        _writing = std::async(std::launch::async, write, _options.checkpoint, checkpoint(),
                              _renderer.getStatistics().passes > 0);
    }
    catch (const std::exception& problem) // there is no memory, or no thread
    {
        reportFailure(kProgram, cannotWrite(_options.checkpoint, problem.what()));
    }
}

int CheckpointKeeper::keep()
{
    if (_options.checkpoint.empty()) return kDone;
    if (_writing.valid()) _writing.wait();
    return write(_options.checkpoint, checkpoint(), _renderer.getStatistics().passes > 0);
}

Checkpoint CheckpointKeeper::checkpoint() const
{
    return {_renderer.getPassSums(), _options.settings->getExposure(), _clearColor,
            _options.settings->get("tone-curve")};
}

} // namespace osgRayTrace::app
