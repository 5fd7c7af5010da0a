// Cluster.h - what the nodes of a cluster tell each other, so that their walls match. Layer:
// plugins. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace osgRayTrace::calvr
{

/// The connections of a cluster: CalVR's, or a test's. Calls block until the other side makes its
/// own, so all nodes have to make the same ones in the same order. Each returns false once a
/// connection is lost.
class Connections
{
public:
    virtual ~Connections() = default;

    virtual bool isMaster() const = 0;
    virtual int slaveCount() const = 0; ///< 0: a computer of its own. The same on all nodes

    virtual bool sendToMaster(const int& value) = 0;            ///< slaves
    virtual bool readFromSlaves(std::vector<int>& values) = 0;  ///< master: one for each slave
    virtual bool sendToSlaves(const void* data, int bytes) = 0; ///< master
    virtual bool readFromMaster(void* data, int bytes) = 0;     ///< slaves
};

/// A node that traces nothing, or failed to, has no say in how many passes the others trace.
constexpr int kNoSay = 0;

/// How many passes of passSeconds a node can trace in budgetSeconds: 1 at least, 1024 at most.
/// Before the first pass (not positive or not finite) nobody knows: 1.
int affordablePasses(double passSeconds, double budgetSeconds);

/// What all nodes trace: the least of what they can, 1 if none has a say.
int agreedPasses(const std::vector<int>& offers);

/// Sends offers to the master and its answer back, once a frame: pictures of all walls then have
/// the same number of passes, and no edge between them shows in brightness or noise.
class PassAgreement
{
public:
    explicit PassAgreement(Connections& connections);

    /// The passes of this frame for all nodes. Makes the same calls whatever the offer is; without
    /// a cluster none. When connections are lost the own offer counts (CalVR ends then).
    int agree(int offer);

private:
    Connections& _connections;
    std::vector<int> _offers; ///< of the slaves; allocated before the first frame
};

/// Gives the master's text to all nodes; returns it. When connections are lost: the own one.
std::string mastersText(Connections& connections, const std::string& own);

} // namespace osgRayTrace::calvr
