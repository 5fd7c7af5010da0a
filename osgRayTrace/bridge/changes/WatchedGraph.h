// WatchedGraph.h - the visible nodes of a graph in one array, with what they were. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/changes/NodeHashes.h"
#include "osgRayTrace/bridge/common/ObjectIdentity.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"
#include "osgRayTrace/bridge/geometry/BufferContents.h"
#include "osgRayTrace/bridge/graph/PathBudget.h"

#include <osg/Geometry>
#include <osg/Matrixd>
#include <osg/Node>
#include <osg/StateSet>

#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

constexpr uint32_t kNowhere = 0xffffffffu;
constexpr uint32_t kOutermost = kNowhere >> 2; ///< of WatchedPlace::outer

/// More than a conversion takes, as the watch also looks at what that leaves to OSG.
constexpr std::size_t kMostWatched = 2 * kMostPaths;

/// A node on one path, see WatchedGraph::nodes.
struct WatchedNode
{
    osg::Node* node = nullptr; ///< see WatchedGraph::kept
    uint64_t hash = 0;
    uint32_t parent = kNowhere; ///< in nodes
    uint32_t end = 0;           ///< in nodes: behind all that is below it
    uint32_t state = kNowhere;  ///< in states; a geometry's is with it
    uint32_t place = kNowhere;  ///< that it is in; a transform: its own
    uint32_t item = kNowhere;   ///< Geometry: in geometries; Untracked: in untrackedNodes
    NodeKind kind = NodeKind::Group;
    uint8_t hint = 0;
    bool repeated = false;     ///< the same node came before: looked at there
    bool stateChanged = false; ///< while a look runs: state at it has changed
};

/// A transform on a path.
struct WatchedPlace
{
    uint64_t hash = 0;        ///< of its matrix
    uint32_t node = kNowhere; ///< kNowhere: gone
    uint32_t outer : 30;      ///< place around it; kOutermost: none
    uint32_t fixed : 1;       ///< there is more in it than plain nodes and geometry
    uint32_t moved : 1;       ///< while a look runs
};

/// Once, on however many paths it is.
struct WatchedGeometry
{
    osg::Geometry* geometry = nullptr; ///< one of the nodes; null: gone
    uint64_t arrays = 0;               ///< hash of them
    uint64_t conversion = 0;           ///< likewise
    uint32_t uses = 0;                 ///< in nodes
    uint32_t state = kNowhere;
    const osg::StateSet* stateSet = nullptr; ///< one of the states
    // While a look runs:
    uint64_t looked = 0;
    uint32_t counted = 0;
    bool stateChanged = false; ///< it has other state or arrays
};

struct WatchedBuffer
{
    Kept<const osg::BufferData> data;
    uint64_t hash = 0;
    uint32_t geometry = 0;
    BufferKind kind = BufferKind::Other;
    bool shape = false;      ///< positions, normals or primitives
    BufferContents contents; ///< as of the last change of the hash
};

struct WatchedState
{
    Kept<const osg::StateSet> stateSet; ///< null: gone
    uint64_t hash = 0;
    KeptObjects kept;     ///< of hash
    uint32_t uses = 0;    ///< by nodes and geometries
    bool changed = false; ///< while a look runs
};

struct WatchedLight
{
    uint32_t node = 0;
    uint64_t hash = 0;
    KeptObjects kept; ///< of hash
};

/// A child that a mask hides.
struct HiddenNode
{
    Kept<osg::Node> node;
    uint32_t parent = 0;
};

/// A node whose class is not known, with all below it.
struct UntrackedNode
{
    UntrackedNode() = default;
    UntrackedNode(UntrackedNode&&) = default;
    UntrackedNode& operator=(UntrackedNode&&) = default;

    osg::Matrixd sceneFromLocal;
    KeptObjects kept;                         ///< of its hash
    std::size_t budget = 0;                   ///< for its hash
    std::optional<uint64_t> contents;         ///< its hash by versions, as of the last change
    std::unique_ptr<BufferVersions> versions; ///< null: it has not changed
};

/// All nodes that a traversal would visit, in its order, each on every path. Whatever is compared
/// by its address is kept alive until its replacement was compared with it: nodes, state sets with
/// their attributes and images, arrays. So what the application lets go of is freed with the next
/// look. Subtrees can be taken out and put in.
struct WatchedGraph
{
    std::vector<WatchedNode> nodes;
    std::vector<Kept<osg::Node>> kept; ///< the nodes themselves; null: the owner
    std::vector<WatchedPlace> places;  ///< outer ones before those in them
    std::vector<WatchedGeometry> geometries;
    std::vector<WatchedBuffer> buffers;
    std::vector<WatchedState> states;
    std::vector<WatchedLight> lights;
    std::vector<HiddenNode> hidden;
    std::vector<UntrackedNode> untrackedNodes;
    const osg::Node* owner = nullptr; ///< the decorator, if any: it owns what watches it
    std::size_t repeats = 0;          ///< nodes with repeated set
    unsigned int traversalMask = 0xffffffffu;
    bool truncated = false;     ///< there are more than kMostWatched
    std::size_t firstDepth = 1; ///< nodes on the path to the first one, with it

    bool isVisible(const osg::Node& node) const
    {
        return (traversalMask & node.getNodeMask()) != 0;
    }

    /// Appends what is visible at a node that lies below so many others.
    void append(osg::Node& node, uint32_t parent, const osg::Matrixd& sceneFromParent,
                std::size_t depth, const ViewingConditions& conditions);

    /// The same, before the node at this index, which is a child of parent or behind its last.
    void insert(uint32_t at, osg::Node& node, uint32_t parent, const ViewingConditions& conditions);

    /// Takes out a node with all below it, which the result keeps alive.
    std::vector<Kept<osg::Node>> erase(uint32_t at);

    /// Whether it is on several paths, and looked at on one of them alone.
    bool isRepeated(const osg::Node& node) const;

    /// Whether that is so for something in there that is elsewhere, too.
    bool isRepeatedElsewhere(uint32_t at) const;

    void setState(uint32_t& state, const osg::StateSet* stateSet);

    /// Of geometries that have other arrays now.
    void resetBuffers(const std::vector<uint32_t>& exchanged);

    osg::Matrixd sceneFromLocal(uint32_t place) const;
    osg::NodePath pathTo(uint32_t node) const;

    /// Forgets what only append() needs: which nodes came before.
    void finish();

private:
    void push(const WatchedNode& node);
    void setBuffers(uint32_t geometry);
    void appendUntracked(WatchedNode entry, const osg::Matrixd& sceneFromParent,
                         const ViewingConditions& conditions);
    void appendGeometry(osg::Geometry& geometry, WatchedNode entry);
    uint32_t outerPlace(uint32_t place) const
    {
        const uint32_t outer = places[place].outer;
        return outer == kOutermost ? kNowhere : outer;
    }
    void fix(uint32_t place);
    void releaseGeometry(uint32_t index);
    void dropGonePlaces();

    std::unordered_map<const void*, uint32_t> _stateOf, _geometryOf;
    std::unordered_map<const osg::Node*, bool> _known; ///< while a whole graph is appended
    std::vector<uint32_t> _freeStates, _freeGeometries;
    PathBudget _untrackedBudget{kMostWatched}; ///< of all untracked nodes together
    std::size_t _gonePlaces = 0;
};

} // namespace osgRayTrace::engine
