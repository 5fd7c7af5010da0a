// CheckpointKeeper.cpp - reads the checkpoint before a render, and writes it during and after.
// Layer: apps.
// SPDX-License-Identifier: MIT
#include "CheckpointKeeper.h"

#include "Run.h"
#include "apps/common/Failure.h"
#include "apps/common/Program.h"

#include <filesystem>
#include <iostream>

namespace osgRayTrace::app
{

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
    std::cerr << "osgraytrace: " << options.checkpoint << ": goes on from passes "
              << before.sums.passes << '\n';
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
    auto write = [path = _options.checkpoint, kept = checkpoint()]
    {
        try
        {
            if (!kept.sums.passes.empty()) writeCheckpoint(path, kept);
        }
        catch (const std::exception& problem)
        {
            reportFailure(kProgram, Failure(kCannotWrite, problem.what()));
        }
    };
    _writing = std::async(std::launch::async, std::move(write));
}

void CheckpointKeeper::keep()
{
    if (_options.checkpoint.empty()) return;
    if (_writing.valid()) _writing.wait();
    const Checkpoint last = checkpoint();
    if (!last.sums.passes.empty()) writeCheckpoint(_options.checkpoint, last);
}

Checkpoint CheckpointKeeper::checkpoint() const
{
    return {_renderer.getPassSums(), _options.settings->getExposure(), _clearColor};
}

} // namespace osgRayTrace::app
