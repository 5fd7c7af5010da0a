// ThreadGroup.h - ranks that are threads of one process: a network that delays and reorders.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/group/Group.h"

#include <chrono>
#include <deque>
#include <mutex>
#include <random>
#include <stdexcept>
#include <vector>

/// What ranks get when one of them has aborted the group.
struct Aborted : std::runtime_error
{
    explicit Aborted(int c) : std::runtime_error("aborted"), code(c) {}
    int code;
};

/// Carries the messages of a group. Messages between two ranks keep their order, all others come in
/// any: each is held back for a time of its own.
class ThreadNetwork
{
public:
    using Clock = std::chrono::steady_clock;

    /// Messages take up to mostDelay [us].
    ThreadNetwork(int ranks, unsigned seed, int mostDelay)
        : size(ranks),
          _random(seed),
          _mostDelay(mostDelay),
          _boxes(static_cast<std::size_t>(ranks * ranks)),
          _sums(static_cast<std::size_t>(ranks), 0)
    {
    }

    const int size;

    void send(int from, int to, const std::vector<char>& bytes)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        std::deque<Letter>& box = boxOf(from, to);
        Clock::time_point due = Clock::now() + std::chrono::microseconds(delay());
        if (!box.empty()) due = std::max(due, box.back().due);
        box.push_back({due, bytes});
    }

    std::optional<std::pair<int, std::vector<char>>> receive(int to)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (_aborted) throw Aborted(_code);
        for (int i = 0; i < size; ++i)
        {
            const int from = (i + _turn) % size;
            std::deque<Letter>& box = boxOf(from, to);
            if (box.empty() || box.front().due > Clock::now()) continue;
            std::pair<int, std::vector<char>> letter(from, std::move(box.front().bytes));
            box.pop_front();
            ++_turn;
            return letter;
        }
        return std::nullopt;
    }

    /// Adds a rank's array to that of rank 0; number counts the sums of the rank from 1 on.
    void beginSum(int rank, const std::int64_t* values, std::size_t count)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        const int number = ++_sums[static_cast<std::size_t>(rank)];
        _open.resize(std::max(_open.size(), static_cast<std::size_t>(number)));
        Sum& sum = _open[static_cast<std::size_t>(number - 1)];
        if (sum.ranks == 0) sum.values.assign(count, 0);
        if (sum.values.size() != count) throw std::logic_error("sums of different counts");
        for (std::size_t i = 0; i < count; ++i)
            sum.values[i] += values[i]; // undefined behaviour if it overflows: UBSan would say
        ++sum.ranks;
    }

    /// Returns whether the last sum of the rank is there, and writes it for rank 0.
    bool endSum(int rank, std::int64_t* values)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (_aborted) throw Aborted(_code);
        Sum& sum = _open[static_cast<std::size_t>(_sums[static_cast<std::size_t>(rank)] - 1)];
        if (sum.ranks < size) return false;
        if (rank == 0) std::copy(sum.values.begin(), sum.values.end(), values);
        return true;
    }

    /// Takes rank 0's bytes.
    void beginBroadcast(const unsigned char* bytes, std::size_t count)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _broadcast.assign(bytes, bytes + count);
        _hasBroadcast = true;
    }

    /// Returns whether rank 0's bytes are there, and writes them.
    bool endBroadcast(unsigned char* bytes, std::size_t count)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (_aborted) throw Aborted(_code);
        if (!_hasBroadcast) return false;
        if (_broadcast.size() != count) throw std::logic_error("broadcasts of different counts");
        std::copy(_broadcast.begin(), _broadcast.end(), bytes);
        return true;
    }

    void throwIfAborted()
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (_aborted) throw Aborted(_code);
    }

    void abort(int code)
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _aborted = true;
        _code = code;
    }

private:
    struct Letter
    {
        Clock::time_point due;
        std::vector<char> bytes;
    };
    struct Sum
    {
        int ranks = 0;
        std::vector<std::int64_t> values;
    };

    std::deque<Letter>& boxOf(int from, int to)
    {
        return _boxes[static_cast<std::size_t>(from * size + to)];
    }
    int delay() { return _mostDelay == 0 ? 0 : static_cast<int>(_random() % unsigned(_mostDelay)); }

    std::mutex _mutex; ///< guards all below; ranks are threads
    std::mt19937 _random;
    int _mostDelay;
    std::vector<std::deque<Letter>> _boxes;
    int _turn = 0;
    std::vector<int> _sums;
    std::deque<Sum> _open;
    std::vector<unsigned char> _broadcast;
    bool _hasBroadcast = false;
    bool _aborted = false;
    int _code = 0;
};

class ThreadGroup : public osgRayTrace::app::Group
{
public:
    ThreadGroup(ThreadNetwork& network, int rank) : _network(network), _rank(rank) {}

    int rank() const override { return _rank; }
    int size() const override { return _network.size; }
    int localSize() const override { return _network.size; }

    void send(int rank, const osgRayTrace::app::GroupMessage& message) override
    {
        _network.send(_rank, rank, packed(message));
    }

    std::optional<std::pair<int, osgRayTrace::app::GroupMessage>> receive() override
    {
        const auto letter = _network.receive(_rank);
        if (!letter) return std::nullopt;
        const auto message = osgRayTrace::app::unpacked(letter->second);
        if (!message) throw std::logic_error("bytes that are no message");
        return std::pair(letter->first, *message);
    }

    void beginSum(std::int64_t* values, std::size_t count) override
    {
        _values = values;
        _network.beginSum(_rank, values, count);
    }
    bool sumIsDone() override { return _network.endSum(_rank, _values); }

    void beginBroadcast(unsigned char* bytes, std::size_t count) override
    {
        _bytes = bytes;
        _count = count;
        if (_rank == 0) _network.beginBroadcast(bytes, count);
    }
    bool broadcastIsDone() override { return _network.endBroadcast(_bytes, _count); }

    [[noreturn]] void abort(int code) override
    {
        _network.abort(code);
        throw Aborted(code);
    }

private:
    ThreadNetwork& _network;
    int _rank;
    std::int64_t* _values = nullptr;
    unsigned char* _bytes = nullptr;
    std::size_t _count = 0;
};
