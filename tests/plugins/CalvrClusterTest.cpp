// CalvrClusterTest.cpp - tests of what the nodes of a cluster agree on, without CalVR.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgPlugins/calvr/Cluster.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <limits>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

using namespace osgRayTrace::calvr;

namespace
{

/// Bytes on their way from one node to another. Readers wait for theirs, but not for ever.
class Wire
{
public:
    void send(const void* data, size_t bytes)
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const char* begin = static_cast<const char*>(data);
        _bytes.insert(_bytes.end(), begin, begin + bytes);
        _changed.notify_all();
    }

    bool read(void* data, size_t bytes)
    {
        std::unique_lock<std::mutex> lock(_mutex);
        const auto isThere = [&] { return _cut || _bytes.size() >= bytes; };
        _changed.wait_for(lock, std::chrono::seconds(20), isThere);
        if (_bytes.size() < bytes) _cut = true; // out of step: nobody else shall wait as long
        if (_bytes.size() < bytes) return false;
        std::copy_n(_bytes.begin(), bytes, static_cast<char*>(data));
        _bytes.erase(_bytes.begin(), _bytes.begin() + static_cast<std::ptrdiff_t>(bytes));
        return true;
    }

    void cut()
    {
        std::lock_guard<std::mutex> lock(_mutex);
        _cut = true;
        _changed.notify_all();
    }

    size_t left() const { return _bytes.size(); }

private:
    std::mutex _mutex; // of two nodes
    std::condition_variable _changed;
    std::deque<char> _bytes;
    bool _cut = false;
};

struct Wires
{
    explicit Wires(int slaves)
        : toMaster(static_cast<size_t>(slaves)), toSlave(static_cast<size_t>(slaves))
    {
    }
    std::vector<Wire> toMaster, toSlave;
};

/// Node 0 is the master. Counts its calls.
class Node : public Connections
{
public:
    Node(Wires& wires, int number) : _wires(wires), _number(static_cast<size_t>(number)) {}
    bool isMaster() const override { return _number == 0; }
    int slaveCount() const override { return static_cast<int>(_wires.toSlave.size()); }

    bool sendToMaster(const int& value) override
    {
        ++calls;
        _wires.toMaster[_number - 1].send(&value, sizeof value);
        return true;
    }
    bool readFromSlaves(std::vector<int>& values) override
    {
        ++calls;
        bool all = values.size() == _wires.toMaster.size();
        for (size_t i = 0; i < values.size(); ++i)
            all = _wires.toMaster[i].read(&values[i], sizeof(int)) && all;
        return all;
    }
    bool sendToSlaves(const void* data, int bytes) override
    {
        ++calls;
        for (Wire& wire : _wires.toSlave)
            wire.send(data, static_cast<size_t>(bytes));
        return true;
    }
    bool readFromMaster(void* data, int bytes) override
    {
        ++calls;
        return _wires.toSlave[_number - 1].read(data, static_cast<size_t>(bytes));
    }

    int calls = 0;

private:
    Wires& _wires;
    size_t _number;
};

} // namespace

TEST_CASE("affordable passes: whole ones within the budget, one at least, 1024 at most", "[calvr]")
{
    CHECK(affordablePasses(0.010, 0.033) == 3);
    CHECK(affordablePasses(0.033, 0.033) == 1);
    CHECK(affordablePasses(0.500, 0.033) == 1);
    CHECK(affordablePasses(1e-9, 0.033) == 1024);
    CHECK(affordablePasses(std::numeric_limits<double>::denorm_min(), 0.033) == 1024);
    for (const double unknown : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN()})
        CHECK(affordablePasses(unknown, 0.033) == 1);
}

TEST_CASE("agreed passes: the least offer; who traces nothing has no say", "[calvr]")
{
    CHECK(agreedPasses({5, 3, 9}) == 3);
    CHECK(agreedPasses({5, kNoSay, 9}) == 5);
    CHECK(agreedPasses({kNoSay, kNoSay}) == 1);
    CHECK(agreedPasses({}) == 1);
    CHECK(agreedPasses({1024, 1024}) == 1024);
    CHECK(agreedPasses({-7, 4}) == 4);
}

TEST_CASE("pass agreement: four nodes trace the same passes in each of 200 frames, whoever traces "
          "or failed",
          "[calvr]")
{
    constexpr int kNodes = 4, kFrames = 200;
    Wires wires(kNodes - 1);
    std::vector<std::vector<int>> agreed(kNodes, std::vector<int>(kFrames));
    std::vector<int> calls(kNodes);
    const auto offerOf = [](int node, int frame)
    { return (frame * 7 + node * 5) % 11; }; // 0: has no say
    const auto run = [&](int node)
    {
        Node connections(wires, node);
        PassAgreement agreement(connections);
        for (int frame = 0; frame < kFrames; ++frame)
            agreed[static_cast<size_t>(node)][static_cast<size_t>(frame)] =
                agreement.agree(offerOf(node, frame));
        calls[static_cast<size_t>(node)] = connections.calls;
    };
    std::vector<std::thread> threads;
    for (int node = 0; node < kNodes; ++node)
        threads.emplace_back(run, node);
    for (std::thread& thread : threads)
        thread.join();

    for (int frame = 0; frame < kFrames; ++frame)
    {
        std::vector<int> offers;
        for (int node = 0; node < kNodes; ++node)
            offers.push_back(offerOf(node, frame));
        const int expected = agreedPasses(offers);
        for (int node = 0; node < kNodes; ++node)
            CHECK(agreed[static_cast<size_t>(node)][static_cast<size_t>(frame)] == expected);
    }
    for (int node = 0; node < kNodes; ++node)
        CHECK(calls[static_cast<size_t>(node)] == 2 * kFrames);
    for (size_t i = 0; i + 1 < kNodes; ++i)
    {
        CHECK(wires.toMaster[i].left() == 0);
        CHECK(wires.toSlave[i].left() == 0);
    }
}

TEST_CASE("pass agreement: a computer of its own calls nobody and does what it can", "[calvr]")
{
    Wires wires(0);
    Node connections(wires, 0);
    PassAgreement agreement(connections);
    CHECK(agreement.agree(12) == 12);
    CHECK(agreement.agree(kNoSay) == 1);
    CHECK(connections.calls == 0);
}

TEST_CASE("pass agreement: with connections lost a node goes on with its own offer", "[calvr]")
{
    Wires wires(1);
    wires.toMaster[0].cut();
    wires.toSlave[0].cut();
    Node master(wires, 0), slave(wires, 1);
    PassAgreement ofMaster(master), ofSlave(slave);
    CHECK(ofSlave.agree(6) == 6);
    int sent = 0;
    REQUIRE(wires.toMaster[0].read(&sent, sizeof sent));
    CHECK(ofMaster.agree(4) == 4);
    CHECK(master.calls == 2); // both, although the first one failed
}

TEST_CASE("master's text: all nodes have it, byte by byte, also an empty one", "[calvr]")
{
    for (const std::string& text : {std::string("seed=3\nphotons=1024\n"), std::string()})
    {
        Wires wires(2);
        Node master(wires, 0), first(wires, 1), second(wires, 2);
        CHECK(mastersText(master, text) == text);
        CHECK(mastersText(first, "own") == text);
        CHECK(mastersText(second, "own") == text);
        CHECK(wires.toSlave[0].left() == 0);
        CHECK(wires.toSlave[1].left() == 0);
    }
}

TEST_CASE("master's text: what cannot be one is refused", "[calvr]")
{
    for (const int bytes : {-1, 1 << 30})
    {
        Wires wires(1);
        Node slave(wires, 1);
        wires.toSlave[0].send(&bytes, sizeof bytes);
        CHECK(mastersText(slave, "own") == "own");
    }
    Wires wires(1);
    wires.toSlave[0].cut();
    Node slave(wires, 1);
    CHECK(mastersText(slave, "own") == "own");
}
