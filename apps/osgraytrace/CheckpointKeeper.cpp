// CheckpointKeeper.cpp - reads the checkpoint before a render, and writes it during and after.
// Layer: apps.
// SPDX-License-Identifier: MIT
#include "CheckpointKeeper.h"

#include "Checkpoint.h"
#include "Run.h"
#include "apps/common/Failure.h"
#include "apps/common/Output.h"
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
    if (_options.checkpoint.empty()) return;
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - _kept;
    if (since.count() < _options.interval) return;
    keep();
}

int CheckpointKeeper::keep()
{
    if (_options.checkpoint.empty()) return kDone;
    int code = kDone;
    try
    {
        PassSums sums = _renderer.getPassSums();
        if (sums.passes.empty() && _renderer.getStatistics().passes > 0)
            throw cannotWrite(_options.checkpoint, "there is not enough memory");
        if (!sums.passes.empty())
            writeCheckpoint(_options.checkpoint,
                            {std::move(sums), _options.settings->getExposure(), _clearColor});
    }
    catch (const Failure& failure)
    {
        code = reportFailure(kProgram, failure);
    }
    _kept = std::chrono::steady_clock::now();
    return code;
}

} // namespace osgRayTrace::app
