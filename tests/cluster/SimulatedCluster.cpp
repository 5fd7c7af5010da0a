// SimulatedCluster.cpp - the protocol of osgraytrace --mpi on machines that SimGrid simulates.
// SPDX-License-Identifier: MIT
//
// Coordinator, leases, messages and MpiGroup are those of the program; SimGrid's SMPI carries the
// messages through a network that a platform file describes. A rank is no thread and has no Embree
// there: passes are spans of simulated time, and their sums are numbers that are checked at the
// end. Sums of a film are MPI_Reduce of memory that all ranks share; adding them up takes no time.
//
// Usage: smpirun ... simulatedCluster IDEAL_SECONDS PASS_SECONDS FILM_MEGABYTES [SEED]
// IDEAL_SECONDS is the time that all ranks would need if nothing were lost; it states the passes.
#include "apps/group/Coordinator.h"
#include "apps/group/MpiGroup.h"

#include <mpi.h>
#include <simgrid/s4u/Actor.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <limits>
#include <numeric>
#include <random>

using namespace osgRayTrace;
using namespace osgRayTrace::app;
using Kind = GroupMessage::Kind;

namespace
{

constexpr int kWidth = 3, kHeight = 2;
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kLook = 0.02; ///< time between two looks for messages while a pass is made [s]
constexpr double kIdleLook = 0.001;                  ///< the same, while there is none
constexpr int kTag = 2;                              ///< of films; 1 is MpiGroup's
constexpr double kNoise = 0.05;                      ///< by how much speeds differ
constexpr std::size_t kChunk = std::size_t(1) << 26; ///< bytes that are added up at a time

struct Experiment
{
    double idealSeconds = 0.0, passSeconds = 0.0;
    std::size_t filmBytes = 0;
    std::vector<double> speeds; ///< by rank, 1 as a rule
    int passes = 0;
};

Experiment experimentOf(char** arguments, int ranks, unsigned seed)
{
    Experiment e;
    e.idealSeconds = std::atof(arguments[1]);
    e.passSeconds = std::atof(arguments[2]);
    e.filmBytes = static_cast<std::size_t>(std::atof(arguments[3]) * 1e6);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> speed(1.0 - kNoise, 1.0 + kNoise);
    for (int rank = 0; rank < ranks; ++rank)
        e.speeds.push_back(speed(random));
    if (ranks > 1) e.speeds.back() = 0.5; // one machine is busy with other work
    const double all = std::accumulate(e.speeds.begin(), e.speeds.end(), 0.0);
    e.passes = static_cast<int>(std::round(e.idealSeconds * all / e.passSeconds));
    return e;
}

/// Returns the time that passes take if rank r has those of numbers r, r + ranks, and so on.
double staticSeconds(const Experiment& e)
{
    const int ranks = static_cast<int>(e.speeds.size());
    double longest = 0.0;
    for (int rank = 0; rank < ranks; ++rank)
    {
        const int own = e.passes / ranks + (rank < e.passes % ranks);
        longest = std::max(longest, own * e.passSeconds / e.speeds[std::size_t(rank)]);
    }
    return longest;
}

void addPass(int pass, engine::PassSums& sums)
{
    sums.passes.add(pass);
    for (std::size_t i = 0; i < sums.low.size(); ++i)
        sums.low[i] += (std::int64_t(pass) * 2654435761 + std::int64_t(i) * 40503) % 1000003;
}

engine::PassSums noSums()
{
    engine::PassSums sums;
    sums.width = kWidth;
    sums.height = kHeight;
    sums.low.assign(engine::PassSums::kPlanes * sums.pixels(), 0);
    sums.depth.assign(sums.pixels(), 1.0f);
    return sums;
}

/// Sends as many bytes as a sum of films does by Open MPI's choice for large arrays: halves of
/// halves are exchanged until each rank has the sum of a part, and the parts are gathered
/// (reduce-scatter by recursive halving, binomial gather). MPI_Reduce itself would take memory on
/// this machine for each rank. The number of ranks is a power of two.
void reduceFilm(std::size_t bytes)
{
    static void* const memory = SMPI_SHARED_MALLOC(kChunk); // is never looked at
    int rank = 0, ranks = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    for (std::size_t left = bytes; left > 0; left -= std::min(left, kChunk))
    {
        const std::size_t chunk = std::min(left, kChunk);
        std::size_t part = chunk;
        for (int distance = ranks / 2; distance > 0; distance /= 2)
        {
            part /= 2;
            const int other = rank ^ distance;
            MPI_Sendrecv(memory, int(part), MPI_BYTE, other, kTag, memory, int(part), MPI_BYTE,
                         other, kTag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        }
        for (int distance = 1; distance < ranks; distance *= 2, part *= 2)
        {
            if (rank & distance)
            {
                MPI_Send(memory, int(part), MPI_BYTE, rank - distance, kTag, MPI_COMM_WORLD);
                break;
            }
            MPI_Recv(memory, int(part), MPI_BYTE, rank + distance, kTag, MPI_COMM_WORLD,
                     MPI_STATUS_IGNORE);
        }
    }
}

/// What PassWorker is in the program: orders of rank 0 in, messages to it out.
class SimulatedWorker
{
public:
    SimulatedWorker(const Experiment& e, int rank, std::function<void(const GroupMessage&)> send)
        : _experiment(e), _pass(e.passSeconds / e.speeds[std::size_t(rank)]), _send(std::move(send))
    {
        GroupMessage hello(Kind::Hello);
        hello.text = "a picture";
        hello.host = "host" + std::to_string(rank);
        hello.processors = {64, 1, 64};
        _send(hello);
    }

    void take(const GroupMessage& message)
    {
        if (message.kind == Kind::End) _isOver = true;
        if (message.kind == Kind::Take || message.kind == Kind::Round) _orders.push_back(message);
        if (message.kind == Kind::Sum) _wantsSum = true;
    }

    /// Adds up, if rank 0 has asked for it: once all ranks were told, as this waits for them.
    void sumUp()
    {
        if (!std::exchange(_wantsSum, false)) return;
        reduceFilm(_experiment.filmBytes);
        const bool isRoot = _root;
        MPI_Reduce(isRoot ? MPI_IN_PLACE : _copy.low.data(), isRoot ? _copy.low.data() : nullptr,
                   int(_copy.low.size()), MPI_INT64_T, MPI_SUM, 0, MPI_COMM_WORLD);
        _hasSum = true;
    }

    /// Makes what passes there are until now, and says what there is to say.
    void poll(double now)
    {
        while (!_isOver)
        {
            if (_next < _end)
            {
                if (_passEnd == kNever) _passEnd = std::max(_free, _orderTime) + _pass;
                if (_passEnd > now) return;
                addPass(_next++, _sums);
                _free = _passEnd;
                _passEnd = kNever;
                continue;
            }
            if (!_orders.empty())
            {
                const GroupMessage order = _orders.front();
                _orders.pop_front();
                if (order.kind == Kind::Take)
                {
                    _first = _next = order.first;
                    _end = order.end;
                    _orderTime = now;
                    _asked = false;
                    continue;
                }
                GroupMessage ready(Kind::Ready);
                ready.first = order.first;
                ready.text = engine::passText(_sums.passes);
                _copy = _sums;
                _send(ready);
                continue;
            }
            if (_asked) return;
            _asked = true;
            GroupMessage want(Kind::Want);
            want.first = _first;
            want.end = _next;
            want.seconds = (_next - _first) * _pass;
            _send(want);
        }
    }

    /// Returns how long there is nothing to do but to look for messages.
    double rest(double now) const
    {
        if (_next >= _end) return kIdleLook;
        const double lease = _passEnd + (_end - 1 - _next) * _pass - now;
        return std::clamp(lease, 1e-6, kLook);
    }

    bool isOver() const { return _isOver; }
    void beRoot() { _root = true; }
    bool takeHasSum() { return std::exchange(_hasSum, false); }
    const engine::PassSums& copy() const { return _copy; }

private:
    const Experiment& _experiment;
    const double _pass; ///< time of a pass [s]
    const std::function<void(const GroupMessage&)> _send;
    std::deque<GroupMessage> _orders;
    engine::PassSums _sums = noSums(), _copy;
    int _first = 0, _next = 0, _end = 0;
    double _passEnd = kNever, _free = 0.0, _orderTime = 0.0;
    bool _asked = true, _isOver = false, _root = false, _wantsSum = false, _hasSum = false;
};

/// Is rank 0. Returns the exit code.
int lead(const Experiment& experiment, Group& group)
{
    GroupPlan plan;
    plan.endPass = experiment.passes;
    SimulatedWorker* own = nullptr;
    const auto send = [&](int rank, const GroupMessage& message)
    {
        if (rank == 0)
            own->take(message);
        else
            group.send(rank, message);
    };
    std::deque<GroupMessage> said;
    Coordinator coordinator(group.size(), plan, send,
                            [](const engine::PassSums&, bool) { return 0.0; });
    SimulatedWorker worker(experiment, 0,
                           [&said](const GroupMessage& message) { said.push_back(message); });
    own = &worker;
    worker.beRoot();
    double begin = kNever;
    for (double wait = 1e-4; !coordinator.isOver();)
    {
        bool worked = !said.empty();
        const double now = MPI_Wtime();
        while (const auto received = group.receive())
        {
            coordinator.take(received->first, received->second, now);
            worked = true;
        }
        worker.poll(now);
        for (; !said.empty(); said.pop_front())
            coordinator.take(0, said.front(), now);
        worker.sumUp();
        if (worker.takeHasSum()) coordinator.takeSum(worker.copy());
        worked = coordinator.poll(now, false) || worked;
        if (begin == kNever && coordinator.seconds(now + 1.0) > 0.0) begin = now;
        wait = worked ? 1e-4 : std::min(2.0 * wait, 4e-3); // as in SharedRender.cpp
        if (!coordinator.isOver()) simgrid::s4u::this_actor::sleep_for(wait);
    }
    const double seconds = MPI_Wtime() - begin;
    for (int rank = 1; rank < group.size(); ++rank)
        group.send(rank, GroupMessage(Kind::End));

    const GroupResult& result = coordinator.result();
    engine::PassSums all = noSums();
    for (int pass = 0; pass < experiment.passes; ++pass)
        addPass(pass, all);
    const bool isRight = result.exitCode == 0 && result.sums && result.sums->low == all.low &&
                         result.sums->passes == all.passes;
    std::printf("%d ranks, %d passes: ideal %.2f s, simulated %.2f s, efficiency %.3f; static "
                "shares %.2f; sums %s\n",
                group.size(), experiment.passes, experiment.idealSeconds, seconds,
                experiment.idealSeconds / seconds,
                experiment.idealSeconds / staticSeconds(experiment), isRight ? "right" : "WRONG");
    if (!result.failure.empty()) std::printf("%s\n", result.failure.c_str());
    return isRight ? 0 : 1;
}

void help(const Experiment& experiment, Group& group)
{
    SimulatedWorker worker(experiment, group.rank(),
                           [&group](const GroupMessage& message) { group.send(0, message); });
    while (!worker.isOver())
    {
        while (const auto received = group.receive())
            worker.take(received->second);
        worker.sumUp();
        const double now = MPI_Wtime();
        worker.poll(now);
        if (!worker.isOver()) simgrid::s4u::this_actor::sleep_for(worker.rest(now));
    }
}

} // namespace

int main(int argc, char** argv)
{
    const std::unique_ptr<Group> group = mpiGroup();
    if (argc < 4) return 1;
    const unsigned seed = argc > 4 ? unsigned(std::atoi(argv[4])) : 1;
    const Experiment experiment = experimentOf(argv, group->size(), seed);
    if (group->rank() == 0) return lead(experiment, *group);
    help(experiment, *group);
    return 0;
}
