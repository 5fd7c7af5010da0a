// PassLeases.cpp - runs of passes, as long as a rank's speed and the rest of the work allow. Layer:
// apps.
// SPDX-License-Identifier: MIT
#include "apps/group/PassLeases.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::app
{

namespace
{

constexpr double kLeaseSeconds = 2.0;
constexpr int kLastLeases = 4; ///< leases that a rank has of what is left, at least
constexpr int kGrowth =
    4; ///< of a lease over the one before it, whose passes tell the rank's speed

} // namespace

int nextGridPoint(int passes)
{
    for (int point = 2; point <= 8; point *= 2)
        if (point > passes) return point;
    for (int quarter = 0;; ++quarter)
    {
        const double point = std::round(16.0 * std::exp2(quarter / 4.0));
        if (point > passes) return static_cast<int>(std::min(point, 0x1p30));
    }
}

PassLeases::PassLeases(engine::PassSet done, int first, int end, int ranks)
    : _taken(std::move(done)), _first(first), _end(end), _speeds(static_cast<std::size_t>(ranks))
{
}

std::optional<engine::PassSet::Range> PassLeases::take(int rank, int limit, double seconds)
{
    const int first = std::max(firstLeft(), _first);
    int end = std::min(_end, limit);
    for (const auto& range : _taken.ranges())
        if (range.first > first) end = std::min(end, range.first);
    if (first >= end) return std::nullopt;

    const Speed& speed = _speeds[static_cast<std::size_t>(rank)];
    const int ranks = static_cast<int>(_speeds.size());
    const double inTime = std::min(kLeaseSeconds, seconds / kLastLeases);
    const double fitting =
        std::min(inTime * speed.passesPerSecond, double(kGrowth) * speed.lastPasses);
    const double share = double(left()) / (double(kLastLeases) * ranks);
    const int count = static_cast<int>(std::clamp(std::min(fitting, share), 1.0, 1e9));
    const engine::PassSet::Range lease{first, std::min(end - first, count) + first};
    _taken.add(lease);
    return lease;
}

void PassLeases::finish(int rank, int passes, double seconds)
{
    if (passes <= 0 || !(seconds > 0.0)) return;
    _speeds[static_cast<std::size_t>(rank)] = {passes / seconds, passes};
}

int PassLeases::left() const
{
    int left = _end - _first;
    for (const auto& [first, end] : _taken.ranges())
        left -= std::max(0, std::min(end, _end) - std::max(first, _first));
    return left;
}

} // namespace osgRayTrace::app
