// Cluster.h - messages between the nodes of a cluster, so that walls match. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/FrameWork>

#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::calvr
{

/// Stands for the connections of a cluster: CalVR's, or a test's. Calls block until the other side
/// makes its own, so that all nodes have to make matching calls in the same order. Each call
/// returns false once a connection is lost.
class Connections
{
public:
    virtual ~Connections() = default;

    virtual bool isMaster() const = 0;
    virtual int slaveCount() const = 0; ///< equal on all nodes; 0: a computer of its own

    virtual bool sendToMaster(const void* data, int bytes) = 0; ///< slaves
    /// Reads so many bytes from each slave, one after the other. Called by the master.
    virtual bool readFromSlaves(void* data, int bytesOfEach) = 0;
    virtual bool sendToSlaves(const void* data, int bytes) = 0; ///< master
    virtual bool readFromMaster(void* data, int bytes) = 0;     ///< slaves
};

/// Holds the message of a node: its offer, or the agreement. The size and the place of the version
/// are those of all versions to come, so that nodes with different versions stay in step.
struct WorkMessage
{
    static constexpr int kVersion = 2; ///< 1 had a single number of passes
    static constexpr int kNumbers = 8;

    int version = kVersion;
    int hasSay =
        0; ///< 0: the node traces nothing, or failed to, and takes what the others agree on
    int divider = 0, passes = 0, progress = 0, upsampleDivider = 0; ///< see FrameWork
    int unused[2] = {};
};
static_assert(sizeof(WorkMessage) == WorkMessage::kNumbers * sizeof(int));

/// Returns the work that all nodes trace: the coarsest divider and the least passes of the offers.
/// If no node has a say, it is the work of the first of all frames.
FrameWork agreedWork(const std::vector<std::optional<FrameWork>>& offers);

/// Sends offers to the master and its answer back, once a frame: pictures of all walls then have
/// the same resolution and number of passes, and no edge between them shows.
class WorkAgreement
{
public:
    explicit WorkAgreement(Connections& connections);

    /// Returns the work that all nodes trace in this frame. offer: the work that this node can do;
    /// nothing: it has no say. The calls over the network are the same whatever the offer is; there
    /// are none without a cluster. If connections are lost the own offer counts (CalVR ends then).
    FrameWork agree(const std::optional<FrameWork>& offer);

    /// Returns true once another node has sent a message of another version: that node has no say,
    /// and if it is the master, it is not followed.
    bool hasMetOtherVersion() const { return _otherVersion; }

private:
    std::optional<FrameWork> read(const WorkMessage& message);

    Connections& _connections;
    std::vector<WorkMessage> _messages; ///< one for each slave; allocated before the first frame
    std::vector<std::optional<FrameWork>>
        _offers; ///< one for each node; allocated before the first frame
    bool _otherVersion = false;
};

/// Gives the master's text to all nodes and returns it; returns the own text if connections are
/// lost.
std::string mastersText(Connections& connections, const std::string& own);

} // namespace osgRayTrace::calvr
