// Coordinator.cpp - leases, rounds and the end of a render in a group. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/group/Coordinator.h"

#include "osgRayTrace/base/Assert.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <sstream>

namespace osgRayTrace::app
{

namespace
{

using Kind = GroupMessage::Kind;

constexpr int kCannotRender = 3;  ///< exit code
constexpr double kSilence = 60.0; ///< time after which a rank is given up [s]
constexpr double kAnswer = 0.5;   ///< the same, if it was told to end

/// The first line in which two texts differ.
struct Difference
{
    std::string first, second;
};

Difference differenceOf(const std::string& a, const std::string& b)
{
    std::istringstream first(a), second(b);
    Difference lines;
    do
    {
        lines = {};
        std::getline(first, lines.first);
        std::getline(second, lines.second);
    } while (lines.first == lines.second && (first || second));
    return lines;
}

/// Returns whether the least pass of both is one of the first.
bool isFirst(const engine::PassSet& first, const engine::PassSet& second)
{
    if (first.empty() || second.empty()) return !first.empty();
    return first.ranges().front().first < second.ranges().front().first;
}

void addRays(const RayTotals& from, RayTotals& into)
{
    for (std::size_t i = 0; i < into.size(); ++i)
        into[i] += from[i];
}

} // namespace

Coordinator::Coordinator(int ranks, GroupPlan plan, Send send, Judge judge)
    : _plan(std::move(plan)),
      _send(std::move(send)),
      _judge(std::move(judge)),
      _leases(_plan.base.passes, _plan.firstPass, _plan.endPass, ranks),
      _ranks(static_cast<std::size_t>(ranks))
{
    if (!_plan.base.passes.empty()) _total = std::make_shared<const engine::PassSums>(_plan.base);
}

std::string Coordinator::nameOf(int rank) const
{
    return "rank " + std::to_string(rank) + " on " +
           _ranks[static_cast<std::size_t>(rank)].place.host;
}

int Coordinator::passesDone() const
{
    return _plan.base.passes.count() + _done;
}

RayTotals Coordinator::rays() const
{
    RayTotals sum{};
    for (const Rank& rank : _ranks)
        addRays(rank.rays, sum);
    return sum;
}

std::optional<int> Coordinator::silentRank(double now) const
{
    const bool isTime = _asked && now - *_asked > kAnswer;
    for (std::size_t i = 1; i < _ranks.size(); ++i)
    {
        const Rank& rank = _ranks[i];
        if (rank.isThere && now - rank.heard > kSilence) return static_cast<int>(i);
        if (isTime && rank.heard < *_asked) return static_cast<int>(i);
    }
    return std::nullopt;
}

void Coordinator::take(int rank, const GroupMessage& message, double now)
{
    Rank& from = _ranks[static_cast<std::size_t>(rank)];
    from.heard = now;
    _now = now;
    switch (message.kind)
    {
    case Kind::Hello:
        from.isThere = from.wants = true;
        from.picture = message.text;
        from.place = {message.host, message.processors};
        return;
    case Kind::Want:
        from.wants = true;
        from.rays = message.rays;
        _done += message.end - message.first;
        _leases.finish(rank, message.end - message.first, message.seconds);
        return;
    case Kind::Ready:
        from.rays = message.rays;
        return takeReady(rank, message);
    case Kind::Failed:
        if (from.place.host.empty()) from.place.host = message.host;
        return fail(message.first ? message.first : kCannotRender,
                    _ranks.size() > 1 ? nameOf(rank) + ": " + message.text : message.text);
    case Kind::Stop:
        _isStopped = true;
        return;
    case Kind::Alive:
        return;
    case Kind::Room:
    case Kind::Scene:
    case Kind::Bytes:
    case Kind::Take:
    case Kind::Round:
    case Kind::Sum:
    case Kind::End:
    case Kind::Abort:
    case Kind::Bye:
        break; // are not for rank 0, or come before the render
    }
    fail(kCannotRender, nameOf(rank) + " does not follow the protocol");
}

void Coordinator::takeReady(int rank, const GroupMessage& message)
{
    if (_isOver) return;
    const std::optional<engine::PassSet> passes = engine::passSetOf(message.text);
    if (!_round || message.first != _rounds || !passes)
        return fail(kCannotRender, nameOf(rank) + " does not follow the protocol");
    if (const auto common = passes->firstCommon(_round->passes))
        return fail(kCannotRender,
                    nameOf(rank) + " has pass " + std::to_string(*common) + " of another rank");
    if (isFirst(*passes, _round->passes)) _round->first = rank;
    _round->passes.add(*passes);
    _round->hasHigh = _round->hasHigh || message.flag != 0;
    if (++_round->ready < static_cast<int>(_ranks.size())) return;

    if (!_round->isCut && _round->passes != _round->expected)
        return fail(kCannotRender, "passes " + engine::passText(_round->expected) +
                                       " were given, and ranks have made " +
                                       engine::passText(_round->passes));
    GroupMessage sum(Kind::Sum);
    sum.flag = _round->hasHigh;
    sum.first = _round->first;
    sendAll(sum);
}

void Coordinator::takeSum(engine::PassSums sum)
{
    if (_isOver) return;
    OSGRAYTRACE_ASSERT(_round);
    sum.passes = _round->passes;
    if (!sum.high.empty()) engine::normalise(sum);
    if (!_plan.base.passes.empty()) engine::addSums(_plan.base, sum);
    const Round round = *_round;
    _round.reset();
    if (sum.passes.empty()) return finish(); // interrupted before any pass
    _total = std::make_shared<const engine::PassSums>(std::move(sum));
    judge(round.isJudged, round.keeps, round.isFinal);
}

/// Looks at the sums meanwhile.
void Coordinator::judge(bool isJudged, bool keeps, bool isFinal)
{
    _judgesEnd = isJudged;
    _judgesLast = isFinal;
    if (isFinal) return finish(); // the caller keeps the result
    _judgement = std::async(std::launch::async,
                            [this, sums = _total, keeps] { return _judge(*sums, keeps); });
}

/// Ends the render if the sums are good enough. Returns whether they were looked at.
bool Coordinator::endJudgement()
{
    if (!_judgement.valid() ||
        _judgement.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return false;
    const double error = _judgement.get();
    if (_judgesEnd && error <= _plan.relativeError) finish();
    return true;
}

bool Coordinator::poll(double now, bool isInterrupted)
{
    _now = now;
    if (_isOver) return false;
    const bool areThere =
        std::all_of(_ranks.begin(), _ranks.end(), [](const Rank& rank) { return rank.isThere; });
    if (!areThere && (isInterrupted || _isStopped)) finish();
    if (!areThere || _isOver) return false;
    if (!_isBegun) begin(now);
    bool worked = endJudgement();
    if (_isOver) return true;

    const bool cuts = isInterrupted || _isStopped;
    if (cuts && !_asked)
    {
        _asked = now;
        sendAll(GroupMessage(Kind::Alive));
    }
    const bool isLate = _plan.seconds > 0.0 && now - _begin >= _plan.seconds && !_given.empty();
    if (!cuts && !isLate) worked = giveLeases(now) || worked;
    if (!_round && !_judgement.valid()) worked = beginRound(now, cuts || isLate, cuts) || worked;
    return worked;
}

/// Begins with the render as soon as all ranks have the scene.
void Coordinator::begin(double now)
{
    _isBegun = true;
    _begin = _kept = now;
    std::vector<RankPlace> places;
    for (std::size_t i = 0; i < _ranks.size(); ++i)
    {
        places.push_back(_ranks[i].place);
        if (_ranks[i].picture == _ranks[0].picture) continue;
        const Difference lines = differenceOf(_ranks[0].picture, _ranks[i].picture);
        return fail(kCannotRender, nameOf(static_cast<int>(i)) +
                                       " would render another picture: " + lines.second +
                                       " there, " + lines.first + " on " + _ranks[0].place.host);
    }
    _result.note = bindingNote(places);
    if (_plan.relativeError <= 0.0) _grid = std::numeric_limits<int>::max();
    if (_plan.base.passes.empty())
    {
        if (_grid == 0) _grid = nextGridPoint(_plan.firstPass);
        return;
    }
    if (_plan.basePicture != _ranks[0].picture)
    {
        const Difference lines = differenceOf(_plan.basePicture, _ranks[0].picture);
        return fail(kCannotRender,
                    "the passes are of another picture: " + lines.first + ", and " + lines.second);
    }
    if (isTakenBelow(_plan.endPass)) return finish();
    if (_grid != 0) return;
    // What went before has looked at the grid below these passes.
    const int last = _plan.base.passes.ranges().back().second;
    _grid = nextGridPoint(last);
    const bool isOnGrid = isTakenBelow(last) && nextGridPoint(last - 1) == last;
    if (isOnGrid) judge(true, false, false);
}

/// Gives passes to ranks that want some. Rank 0 is the first, so that it mostly has the depths of
/// the picture. Returns whether any were given.
bool Coordinator::giveLeases(double now)
{
    bool given = false;
    const double left =
        _plan.seconds > 0.0 ? _plan.seconds - (now - _begin) : std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < _ranks.size(); ++i)
    {
        if (!_ranks[i].wants) continue;
        const int rank = static_cast<int>(i);
        const auto lease = _leases.take(rank, _grid, left);
        if (!lease) break;
        GroupMessage take(Kind::Take);
        take.first = lease->first;
        take.end = lease->second;
        _ranks[i].wants = false;
        _given.add(*lease);
        _send(rank, take);
        given = true;
    }
    return given;
}

/// Begins to bring sums together, if it is time for that. ends: no more passes are given; cuts:
/// ranks leave passes that they have taken.
bool Coordinator::beginRound(double now, bool ends, bool cuts)
{
    const bool isAll = isTakenBelow(_plan.endPass);
    const bool isGrid = !isAll && isTakenBelow(_grid);
    const bool isDue = _plan.interval > 0.0 && now - _kept >= _plan.interval;
    if (!isAll && !isGrid && !ends && !isDue) return false;

    Round round;
    round.isFinal = isAll || (ends && !isGrid);
    round.isCut = cuts && round.isFinal;
    round.isJudged = isGrid;
    round.keeps = isDue;
    if (isDue) _kept = now;
    if (isGrid) _grid = nextGridPoint(_grid);
    round.expected = _given;
    _round = std::move(round);

    GroupMessage begin(Kind::Round);
    begin.first = ++_rounds;
    begin.flag = _round->isCut;
    sendAll(begin);
    return true;
}

void Coordinator::finish()
{
    if (_judgement.valid()) _judgement.wait();
    _isOver = true;
    _result.sums = _total;
    _result.rays = rays();
    _result.seconds = seconds(_now);
    sendAll(GroupMessage(Kind::End));
}

void Coordinator::fail(int code, const std::string& failure)
{
    if (_isOver) return;
    _result.exitCode = code;
    _result.failure = failure;
    finish();
}

void Coordinator::sendAll(const GroupMessage& message)
{
    for (std::size_t i = 0; i < _ranks.size(); ++i)
        _send(static_cast<int>(i), message);
}

} // namespace osgRayTrace::app
