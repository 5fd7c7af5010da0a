// CalvrClusterTest.cpp - what the nodes of a cluster agree on, tested without CalVR.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include "osgPlugins/calvr/Cluster.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

using namespace osgRayTrace::calvr;
using osgRayTrace::FrameWork;

namespace osgRayTrace
{

bool operator==(const FrameWork& a, const FrameWork& b)
{
    return a.divider == b.divider && a.passes == b.passes && a.progress == b.progress &&
           a.upsampleDivider == b.upsampleDivider;
}

} // namespace osgRayTrace

namespace
{

const FrameWork kOffer{3, 6, 1000, 2};

/// Carries bytes from one node to another. A reader waits for its bytes for 20 s at most.
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
        if (_bytes.size() < bytes) _cut = true; // out of step: later readers need not wait as long
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
    std::mutex _mutex; // taken by both nodes
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

/// A node of the cluster, which counts its calls. Node 0 is the master.
class Node : public Connections
{
public:
    Node(Wires& wires, int number) : _wires(wires), _number(static_cast<size_t>(number)) {}
    bool isMaster() const override { return _number == 0; }
    int slaveCount() const override { return static_cast<int>(_wires.toSlave.size()); }

    bool sendToMaster(const void* data, int bytes) override
    {
        ++calls;
        _wires.toMaster[_number - 1].send(data, static_cast<size_t>(bytes));
        return true;
    }
    bool readFromSlaves(void* data, int bytesOfEach) override
    {
        ++calls;
        const auto bytes = static_cast<size_t>(bytesOfEach);
        bool all = true;
        for (size_t i = 0; i < _wires.toMaster.size(); ++i)
            all = _wires.toMaster[i].read(static_cast<char*>(data) + i * bytes, bytes) && all;
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

TEST_CASE("agreed work: the coarsest divider and the least passes; who traces nothing has no say",
          "[calvr]")
{
    const std::optional<FrameWork> none;
    const FrameWork fine{1, 9, 3 * FrameWork::WHOLE_PASS, 1}, coarse{4, 2, 100, 3};
    CHECK(agreedWork({fine, coarse}) == FrameWork{4, 2, 100, 3});
    CHECK(agreedWork({coarse, none, fine}) == FrameWork{4, 2, 100, 3});
    CHECK(agreedWork({FrameWork{2, 5, 700, 2}, FrameWork{3, 1, 900, 1}}) ==
          FrameWork{3, 1, 700, 2});
    CHECK(agreedWork({none, fine}) == fine);
    CHECK(agreedWork({none, none}) == FrameWork());
    CHECK(agreedWork({}) == FrameWork());
}

TEST_CASE("work agreement: four nodes trace the same passes at the same resolution in each of 200 "
          "frames, "
          "whoever traces or failed",
          "[calvr]")
{
    constexpr int kNodes = 4, kFrames = 200;
    Wires wires(kNodes - 1);
    std::vector<std::vector<FrameWork>> agreed(kNodes, std::vector<FrameWork>(kFrames));
    std::vector<int> calls(kNodes);
    const auto offerOf = [](int node, int frame) -> std::optional<FrameWork>
    {
        const int k = (frame * 7 + node * 5) % 11;
        if (k == 0) return std::nullopt;
        return FrameWork{(k + node) % 5 + 1, k, 100 * ((k + 3 * node) % 7 + 1),
                         (k + frame) % 3 + 1};
    };
    const auto run = [&](int node)
    {
        Node connections(wires, node);
        WorkAgreement agreement(connections);
        for (int frame = 0; frame < kFrames; ++frame)
            agreed[static_cast<size_t>(node)][static_cast<size_t>(frame)] =
                agreement.agree(offerOf(node, frame));
        calls[static_cast<size_t>(node)] = connections.calls;
        if (agreement.hasMetOtherVersion()) calls[static_cast<size_t>(node)] = -1;
    };
    std::vector<std::thread> threads;
    for (int node = 0; node < kNodes; ++node)
        threads.emplace_back(run, node);
    for (std::thread& thread : threads)
        thread.join();

    for (int frame = 0; frame < kFrames; ++frame)
    {
        std::vector<std::optional<FrameWork>> offers;
        for (int node = 0; node < kNodes; ++node)
            offers.push_back(offerOf(node, frame));
        const FrameWork expected = agreedWork(offers);
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

TEST_CASE("work agreement: a computer of its own calls nobody and does what it can", "[calvr]")
{
    Wires wires(0);
    Node connections(wires, 0);
    WorkAgreement agreement(connections);
    CHECK(agreement.agree(kOffer) == kOffer);
    CHECK(agreement.agree(std::nullopt) == FrameWork());
    CHECK(connections.calls == 0);
}

TEST_CASE("work agreement: with connections lost a node goes on with its own offer", "[calvr]")
{
    Wires wires(1);
    wires.toMaster[0].cut();
    wires.toSlave[0].cut();
    Node master(wires, 0), slave(wires, 1);
    WorkAgreement ofMaster(master), ofSlave(slave);
    CHECK(ofSlave.agree(kOffer) == kOffer);
    WorkMessage sent;
    REQUIRE(wires.toMaster[0].read(&sent, sizeof sent));
    const FrameWork own{1, 4, 9, 1};
    CHECK(ofMaster.agree(own) == own);
    CHECK(master.calls == 2); // both calls were made, although the first one failed
}

TEST_CASE("work agreement: a node of another version stays in step, and is not followed", "[calvr]")
{
    Wires wires(1);
    Node master(wires, 0), slave(wires, 1);
    WorkAgreement ofMaster(master), ofSlave(slave);
    WorkMessage other;
    other.version = 3;
    other.hasSay = 1;
    other.divider = other.passes = other.progress = 7777;
    wires.toMaster[0].send(&other, sizeof other);
    CHECK(ofMaster.agree(kOffer) == kOffer);
    CHECK(ofMaster.hasMetOtherVersion());
    WorkMessage answer;
    REQUIRE(wires.toSlave[0].read(&answer, sizeof answer));
    CHECK(answer.version == WorkMessage::kVersion);

    wires.toSlave[0].send(&other, sizeof other);
    CHECK(ofSlave.agree(kOffer) == kOffer);
    CHECK(ofSlave.hasMetOtherVersion());
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
