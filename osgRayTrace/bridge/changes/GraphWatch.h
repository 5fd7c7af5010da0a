// GraphWatch.h - finds what has changed in a scene graph, in next to no time if nothing has. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/changes/GraphChanges.h"
#include "osgRayTrace/bridge/changes/WatchedGraph.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"

#include <functional>
#include <unordered_set>

namespace osgRayTrace::engine
{

/// Names what the last conversion has made of nodes of classes that the watch does not know.
struct ConvertedNodes
{
    const std::unordered_set<const osg::Node*>& captured; ///< see CullWatch
    const std::unordered_set<const osg::Node*>* inScene; ///< CollectedGraph::inScene; null: unknown
    uint64_t cuttingPlanes = ~uint64_t(0);               ///< CollectedGraph::cuttingPlanes
    std::function<bool(const osg::Geometry&)> isLeft;    ///< SceneIndex::isLeft; null: unknown
};

/// Holds a graph as it was seen last (see WatchedGraph). A look compares the nodes of the graph one
/// after the other, without a traversal. The watch knows nodes of the plain classes one by one; of
/// any other node (level of detail, billboard, a class of the application's own) it knows only
/// whether anything in the node and below it has changed. graphHash documents that, and which
/// changes go unseen. The watch does not look at bounds.
class GraphWatch
{
public:
    /// fetchesAhead: see Prefetch.h; false is for comparisons.
    explicit GraphWatch(bool fetchesAhead = true) : _fetchesAhead(fetchesAhead) {}
    GraphWatch(GraphWatch&&) = default;
    GraphWatch& operator=(GraphWatch&&) = default;

    /// Records the graph as it is.
    void record(osg::Node& root, const ViewingConditions& conditions);

    /// Forgets the graph: the next look finds everything changed, and nothing of the graph is kept
    /// alive until then.
    void forget();

    /// Returns what has changed in the graph below the same root since the last look or record(),
    /// under conditions that differ at most in the eye, the view, the inherited state and reads.
    /// converted: nodes at and below which others follow what nodes of unknown classes show, and
    /// nodes of which nothing but what OSG draws is in the picture; null: there are none.
    GraphChanges look(osg::Node& root, const ViewingConditions& conditions,
                      const ConvertedNodes* converted = nullptr);

    /// Returns the path that the geometry had at the last look, for messages, or the name of the
    /// geometry alone if there is no such path. ChangedUse documents the parameter use.
    std::string pathOf(const osg::Geometry& geometry, uint32_t use) const;

private:
    osg::Node* firstNode(osg::Node& root) const;
    void takeVersions(WatchedGraph& before);
    void mustConvert(GraphChanges& changes, ConversionCause cause, uint32_t node) const;
    void mustRecord(GraphChanges& changes, ConversionCause cause, uint32_t node) const;
    bool giveUp(GraphChanges& changes, ConversionCause cause, uint32_t node) const;
    std::string pathTo(uint32_t node) const;
    uint64_t hidingHash() const;
    bool lookAtNodes(GraphChanges& changes);
    bool isAsItWas(WatchedNode& node);
    bool isUntrackedAsItWas(WatchedNode& node);
    bool isContentAsItWas(WatchedNode& node);
    bool movesWithOthers(WatchedNode& node);
    bool isFollowed(const WatchedNode& node) const;
    bool isOutOfScene(const WatchedNode& node) const;
    bool redo(uint32_t index, GraphChanges& changes);
    bool redoUntracked(uint32_t index, ConversionCause cause, GraphChanges& changes);
    bool redoChildren(uint32_t index, GraphChanges& changes);
    bool remove(uint32_t index, GraphChanges& changes);
    bool add(uint32_t at, osg::Node& node, uint32_t parent, GraphChanges& changes);
    bool hide(uint32_t index, GraphChanges& changes);
    bool lookAtHidden(GraphChanges& changes);
    bool lookAtGeometry(uint32_t index, GraphChanges& changes);
    void lookAtBuffers(GraphChanges& changes);
    void lookAtStates();
    void lookAtLights(GraphChanges& changes);
    void lookAtClips(GraphChanges& changes);
    void findChanged(GraphChanges& changes);
    uint32_t usesBefore(uint32_t geometry, uint32_t node) const;

    bool _fetchesAhead;
    bool _recorded = false;
    ObjectName _first;        ///< first watched node; none: nothing is visible
    ViewingConditions _plain; ///< conditions of the last look without inherited state
    uint64_t _inheritedHash = 0;
    uint64_t _hidingHash = 0;   ///< see hidingHash()
    KeptObjects _inheritedKept; ///< objects that the hash refers to
    WatchedGraph _graph;
    uint64_t _looks = 0;

    // These members serve a look while it runs:
    osg::Node* _root = nullptr;
    const ConvertedNodes* _converted = nullptr;
    bool _anyMoved = false, _anyStateChanged = false;
    std::vector<uint32_t> _exchanged; ///< geometries that have other arrays
};

} // namespace osgRayTrace::engine
