// WatchedGraph.h - the visible nodes of a graph in one array, with hashes of their values. Layer:
// bridge.
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
/// Value of WatchedPlace::outer without a place around.
constexpr uint32_t kOutermost = kNowhere >> 2;

/// Largest number of watched nodes, which is more than a conversion takes, as the watch also looks
/// at nodes that the conversion leaves to OSG.
constexpr std::size_t kMostWatched = 2 * kMostPaths;

/// Holds a node on one path, see WatchedGraph::nodes.
struct WatchedNode
{
    osg::Node* node = nullptr; ///< kept alive by WatchedGraph::kept
    uint64_t hash = 0;
    uint32_t parent = kNowhere; ///< index in nodes
    uint32_t end = 0;           ///< index in nodes, behind all nodes below
    uint32_t state = kNowhere;  ///< index in states; a geometry's is with the WatchedGeometry
    uint32_t place = kNowhere;  ///< place that contains the node; for a transform its own place
    uint32_t item = kNowhere;   ///< index: Geometry in geometries, Untracked in untrackedNodes
    NodeKind kind = NodeKind::Group;
    uint8_t hint = 0;
    bool repeated = false;     ///< true: the same node came before, and the look is taken there
    bool stateChanged = false; ///< while a look runs: the node's state has changed
    bool stateDecides = false; ///< while a look runs: more than the look of surfaces is another
};

/// Holds a transform on a path.
struct WatchedPlace
{
    uint64_t hash = 0;        ///< hash of the transform's matrix
    uint32_t node = kNowhere; ///< kNowhere: gone
    uint32_t outer : 30;      ///< place around it; kOutermost: none
    uint32_t fixed : 1;       ///< true: the place contains more than plain nodes and geometry
    uint32_t moved : 1;       ///< while a look runs
};

/// Holds a geometry once, on however many paths it is.
struct WatchedGeometry
{
    osg::Geometry* geometry = nullptr; ///< one of the nodes; null: gone
    uint64_t arrays = 0;               ///< hash of the arrays
    uint64_t conversion = 0;           ///< hash of the other values, see conversionHash
    uint32_t uses = 0;                 ///< number of uses in nodes
    uint32_t state = kNowhere;
    const osg::StateSet* stateSet = nullptr; ///< one of the states
    // The members below are used while a look runs.
    uint64_t looked = 0;
    uint32_t counted = 0;
    bool stateChanged = false; ///< true: the geometry has other state or arrays
    bool stateDecides = false; ///< as in WatchedNode
};

struct WatchedBuffer
{
    Kept<const osg::BufferData> data;
    uint64_t hash = 0;
    uint32_t geometry = 0;
    BufferKind kind = BufferKind::Other;
    bool shape = false;      ///< true: positions, normals or primitives
    BufferContents contents; ///< values as of the last change of the hash
};

struct WatchedState
{
    Kept<const osg::StateSet> stateSet; ///< null: gone
    uint64_t hash = 0;
    uint64_t decisions = 0; ///< hash without the values that only change the look of surfaces
    KeptObjects kept;       ///< objects in the hash
    uint32_t uses = 0;      ///< number of nodes and geometries that use it
    bool changed = false;   ///< while a look runs
    bool decides = false;   ///< while a look runs: decisions has changed
};

struct WatchedLight
{
    uint32_t node = 0;
    uint64_t hash = 0;
    KeptObjects kept; ///< objects in the hash
};

struct WatchedClip
{
    uint32_t node = 0;
    uint64_t hash = 0; ///< see clipHash
};

/// Holds a child that a mask hides.
struct HiddenNode
{
    Kept<osg::Node> node;
    uint32_t parent = 0;
};

/// Holds a node whose class is not known, with all nodes below.
struct UntrackedNode
{
    UntrackedNode() = default;
    UntrackedNode(UntrackedNode&&) = default;
    UntrackedNode& operator=(UntrackedNode&&) = default;

    osg::Matrixd sceneFromLocal;
    KeptObjects kept;                         ///< objects in the hash
    std::size_t budget = 0;                   ///< budget for the hash
    uint64_t structure = 0;                   ///< structureHash()
    std::optional<uint64_t> contents;         ///< hash by versions, as of the last change
    std::unique_ptr<BufferVersions> versions; ///< null: the node has not changed
};

/// Holds all nodes that a traversal would visit, in its order, each on every path. Objects that are
/// compared by their address are kept alive until their replacement was compared with them: nodes,
/// state sets with their attributes and images, arrays. Objects that the application lets go of are
/// therefore freed with the next look. Subtrees can be taken out and put in.
struct WatchedGraph
{
    std::vector<WatchedNode> nodes;
    std::vector<Kept<osg::Node>> kept; ///< references to the nodes; null for the owner
    std::vector<WatchedPlace> places;  ///< outer places come before the places in them
    std::vector<WatchedGeometry> geometries;
    std::vector<WatchedBuffer> buffers;
    std::vector<WatchedState> states;
    std::vector<WatchedLight> lights;
    std::vector<WatchedClip> clips;
    std::vector<HiddenNode> hidden;
    std::vector<UntrackedNode> untrackedNodes;
    const osg::Node* owner = nullptr; ///< decorator, if any, which owns the object that watches it
    std::size_t repeats = 0;          ///< number of nodes with repeated set
    unsigned int traversalMask = 0xffffffffu;
    std::shared_ptr<const ShaderReads> reads; ///< see ViewingConditions
    bool truncated = false;                   ///< true: there are more nodes than kMostWatched
    std::size_t firstDepth = 1; ///< number of nodes on the path to the first one, including it

    bool isVisible(const osg::Node& node) const
    {
        return (traversalMask & node.getNodeMask()) != 0;
    }

    /// Returns whether vertex attributes are watched beside the fixed arrays.
    bool watchesAttributes() const { return reads && reads->attributes; }

    /// Appends the visible nodes from a node on, which lies below depth others.
    void append(osg::Node& node, uint32_t parent, const osg::Matrixd& sceneFromParent,
                std::size_t depth, const ViewingConditions& conditions);

    /// Inserts the visible nodes from a node on before the node at this index, which is a child of
    /// parent or behind its last.
    void insert(uint32_t at, osg::Node& node, uint32_t parent, const ViewingConditions& conditions);

    /// Takes out a node with all nodes below it, which the result keeps alive.
    std::vector<Kept<osg::Node>> erase(uint32_t at);

    /// Returns whether a node is on several paths, and looked at on one of them alone.
    bool isRepeated(const osg::Node& node) const;

    /// Returns whether a node in the subtree is also elsewhere, and looked at in one place alone.
    bool isRepeatedElsewhere(uint32_t at) const;

    /// Returns the value of WatchedState::decisions.
    uint64_t decisionsHash(const osg::StateSet& stateSet) const;

    void setState(uint32_t& state, const osg::StateSet* stateSet);

    /// Sets the buffers of geometries that have other arrays now.
    void resetBuffers(const std::vector<uint32_t>& exchanged);

    osg::Matrixd sceneFromLocal(uint32_t place) const;

    /// Returns the matrix of the planes of a clip node, which is at this index.
    osg::Matrixd sceneFromPlanes(uint32_t node, const ViewingConditions& conditions) const;

    osg::NodePath pathTo(uint32_t node) const;

    /// Forgets the list of nodes that came before, which only append() needs.
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
    /// Nodes that came before; filled while a whole graph is appended.
    std::unordered_map<const osg::Node*, bool> _known;
    std::vector<uint32_t> _freeStates, _freeGeometries;
    PathBudget _untrackedBudget{kMostWatched}; ///< budget of all untracked nodes together
    std::size_t _gonePlaces = 0;
};

} // namespace osgRayTrace::engine
