// Coordinator.h - rank 0 gives passes to all ranks, and brings their sums together. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/group/GroupMessage.h"
#include "apps/group/Launcher.h"
#include "apps/group/PassLeases.h"
#include "osgRayTrace/film/PassSums.h"

#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// Which passes a group makes, and when it ends.
struct GroupPlan
{
    engine::PassSums base;   ///< passes that were made before
    std::string basePicture; ///< the picture that they are of
    int firstPass = 0;
    int endPass = 0;
    double seconds = 0.0;       ///< 0: no limit
    double relativeError = 0.0; ///< 0: no target
    double interval = 0.0;      ///< time between two rounds that keep the sums; 0: none are kept
};

/// What a group has made.
struct GroupResult
{
    std::shared_ptr<const engine::PassSums> sums; ///< null: nothing
    RayTotals rays{};
    double seconds = 0.0;
    int exitCode = 0;    ///< not 0: failure says why
    std::string failure; ///< one sentence
    std::string note;    ///< one sentence that the user should read; empty: none
};

/// Decides for the group: when which rank makes which passes, when sums are brought together, and
/// when all is done. It only reads messages and sends others; time is what its caller says.
///
/// A round brings sums together: each rank copies the sums of all passes that it has taken before,
/// as soon as they are made, and goes on with later ones while the copies are added up. There is
/// one round at a time.
class Coordinator
{
public:
    using Send = std::function<void(int rank, const GroupMessage&)>; ///< to any rank, 0 included
    /// Returns the relative error of sums, and keeps them as a checkpoint if keeps is true. Called
    /// on a thread of its own.
    using Judge = std::function<double(const engine::PassSums& sums, bool keeps)>;

    Coordinator(int ranks, GroupPlan plan, Send send, Judge judge);

    /// Takes a message of a rank, 0 included.
    void take(int rank, const GroupMessage& message, double now);

    /// Takes the sum of a round, as rank 0 has it.
    void takeSum(engine::PassSums sum);

    /// Goes on with whatever can go on. isInterrupted: the user wants an end. Returns whether there
    /// was anything to do.
    bool poll(double now, bool isInterrupted);

    bool isOver() const { return _isOver; }
    const GroupResult& result() const { return _result; }

    /// Returns a rank that does not answer; nothing if there is none. A rank has a minute, though
    /// it says something every few seconds. After a signal it has less than the second that mpirun
    /// leaves: the signal may have come because the rank is dead.
    std::optional<int> silentRank(double now) const;

    /// Returns where a rank is: "rank 3 on n4".
    std::string nameOf(int rank) const;

    int passesDone() const; ///< as far as ranks have told
    RayTotals rays() const; ///< the same
    double seconds(double now) const { return _isBegun ? now - _begin : 0.0; }

private:
    struct Rank
    {
        bool isThere = false; ///< whether it has the scene
        bool wants = false;
        double heard = 0.0; ///< when a message came
        std::string picture;
        RankPlace place;
        RayTotals rays{};
    };
    struct Round
    {
        bool isFinal = false;
        bool isCut = false;       ///< ranks leave passes that they have taken
        bool isJudged = false;    ///< whether its error decides on the end
        bool keeps = false;       ///< whether its sums are kept
        engine::PassSet expected; ///< the passes that ranks have taken before it
        engine::PassSet passes;   ///< the passes that ranks have told of
        int first = 0;            ///< rank that has the least of them, and so the depths
        int ready = 0;
        bool hasHigh = false;
    };

    void begin(double now);
    bool giveLeases(double now);
    bool beginRound(double now, bool ends, bool cuts);
    void takeReady(int rank, const GroupMessage& message);
    void judge(bool isJudged, bool keeps, bool isFinal);
    bool endJudgement();
    void finish();
    void fail(int code, const std::string& failure);
    void sendAll(const GroupMessage& message);
    bool isTakenBelow(int pass) const { return _leases.firstLeft() >= pass; }

    const GroupPlan _plan;
    const Send _send;
    const Judge _judge;
    PassLeases _leases;
    engine::PassSet _given; ///< the passes that ranks have taken
    std::vector<Rank> _ranks;
    std::optional<Round> _round;
    std::shared_ptr<const engine::PassSums> _total;
    std::future<double> _judgement; ///< of _total, while it is looked at
    bool _judgesEnd = false;        ///< whether the judgement may end the render
    bool _judgesLast = false;       ///< whether the render ends with it
    int _grid = 0;                  ///< passes from it on are not given before it is looked at
    int _done = 0;                  ///< passes that ranks have made
    int _rounds = 0;
    double _begin = 0.0;
    double _now = 0.0;
    double _kept = 0.0; ///< when sums were last kept
    bool _isBegun = false;
    bool _isStopped = false;      ///< whether some rank was told to end
    std::optional<double> _asked; ///< when ranks were asked whether they are alive
    bool _isOver = false;
    GroupResult _result;
};

} // namespace osgRayTrace::app
