// Progress.cpp - draws the bar. Layer: apps.
// SPDX-License-Identifier: MIT
#include "Progress.h"

#include "apps/common/ErrorText.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace osgRayTrace::app
{

namespace
{

constexpr int kBarWidth = 30;
constexpr double kInterval = 0.1; ///< time between two pictures of the bar [s]

} // namespace

Progress::Progress(const Options& options)
    : _options(options),
      _terminal(isatty(STDERR_FILENO) != 0),
      _start(std::chrono::steady_clock::now())
{
}

Progress::~Progress()
{
    if (_lastShown >= 0.0) std::fputs("\r\033[K", stderr);
}

double Progress::seconds() const
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - _start).count();
}

void Progress::show(const Statistics& statistics)
{
    if (!_terminal || (_lastShown >= 0.0 && seconds() - _lastShown < kInterval)) return;
    _lastShown = seconds();

    const double done = fraction(statistics);
    const int filled = static_cast<int>(done * kBarWidth);
    const uint64_t rays = statistics.cameraRays + statistics.shadowRays + statistics.secondaryRays +
                          statistics.photonRays;
    const double rate =
        statistics.renderSeconds > 0.0 ? 1e-6 * rays / statistics.renderSeconds : 0.0;
    std::fputs("\r[", stderr);
    for (int i = 0; i < kBarWidth; ++i)
    {
        std::fputc(i < filled ? '#' : '.', stderr);
    }
    std::fprintf(stderr, "] %3d %%  pass %d  %.1f M rays/s", static_cast<int>(100.0 * done),
                 statistics.passes, rate);
    if (statistics.passes > 1)
        std::fprintf(stderr, "  error %s", errorText(statistics.relativeError).c_str());
    if (done > 0.0) std::fprintf(stderr, "  %.0f s left", seconds() * (1.0 - done) / done);
    std::fputs("\033[K", stderr);
    std::fflush(stderr);
}

/// Returns the fraction of the nearest limit. The error falls with the root of the number of
/// passes.
double Progress::fraction(const Statistics& statistics) const
{
    double done = double(statistics.passes) / _options.mostPasses();
    if (_options.seconds > 0.0) done = std::max(done, statistics.renderSeconds / _options.seconds);
    if (_options.relativeError > 0.0 && statistics.relativeError > 0.0)
    {
        const double ratio = _options.relativeError / statistics.relativeError;
        done = std::max(done, ratio * ratio);
    }
    return std::clamp(done, 0.0, 1.0);
}

} // namespace osgRayTrace::app
