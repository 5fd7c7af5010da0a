// Cluster.h - what the nodes of a cluster tell each other, so that their walls match. Layer:
// plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/FrameWork>

#include <optional>
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

    virtual bool sendToMaster(const void* data, int bytes) = 0; ///< slaves
    /// master: so many bytes from each slave, one after the other.
    virtual bool readFromSlaves(void* data, int bytesOfEach) = 0;
    virtual bool sendToSlaves(const void* data, int bytes) = 0; ///< master
    virtual bool readFromMaster(void* data, int bytes) = 0;     ///< slaves
};

/// What goes over the wire: a node's offer, or what is agreed. Its size and the place of the
/// version are those of all versions to come, so that nodes with different ones stay in step.
struct WorkMessage
{
    static constexpr int kVersion = 2; ///< of the other numbers; 1 was a single number of passes
    static constexpr int kNumbers = 8;

    int version = kVersion;
    int hasSay =
        0; ///< 0: the node traces nothing, or failed to, and takes what the others agree on
    int divider = 0, passes = 0, progress = 0, upsampleDivider = 0; ///< see FrameWork
    int unused[2] = {};
};
static_assert(sizeof(WorkMessage) == WorkMessage::kNumbers * sizeof(int));

/// What all nodes trace: the coarsest divider and the least passes of what they can; what is traced
/// in the first of all frames, if none has a say.
FrameWork agreedWork(const std::vector<std::optional<FrameWork>>& offers);

/// Sends offers to the master and its answer back, once a frame: pictures of all walls then have
/// the same resolution and number of passes, and no edge between them shows.
class WorkAgreement
{
public:
    explicit WorkAgreement(Connections& connections);

    /// What all nodes trace in this frame; offer: what this one can, nothing: it has no say. Makes
    /// the same calls whatever the offer is; without a cluster none. When connections are lost the
    /// own offer counts (CalVR ends then).
    FrameWork agree(const std::optional<FrameWork>& offer);

    /// True once another node has sent a message of another version: that node has no say, and
    /// where it is the master, it is not followed.
    bool hasMetOtherVersion() const { return _otherVersion; }

private:
    std::optional<FrameWork> read(const WorkMessage& message);

    Connections& _connections;
    std::vector<WorkMessage> _messages; ///< of the slaves; allocated before the first frame
    std::vector<std::optional<FrameWork>> _offers; ///< of all nodes; the same
    bool _otherVersion = false;
};

/// Gives the master's text to all nodes; returns it. When connections are lost: the own one.
std::string mastersText(Connections& connections, const std::string& own);

} // namespace osgRayTrace::calvr
