// GraphCollector.h - finds what is visible in a scene graph, and where. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/MaterialAssignment.h"
#include "osgRayTrace/bridge/common/NodePathText.h"
#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/bridge/graph/CollectedGraph.h"
#include "osgRayTrace/bridge/graph/ConversionInput.h"
#include "osgRayTrace/bridge/graph/DrawableTriangles.h"
#include "osgRayTrace/bridge/graph/PathBudget.h"
#include "osgRayTrace/bridge/graph/PlacedVisitor.h"
#include "osgRayTrace/bridge/graph/RuleCaches.h"
#include "osgRayTrace/bridge/graph/SoftwareVertices.h"

#include <osg/Geometry>
#include <osg/Matrixd>
#include <osg/NodeVisitor>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// A path from the root has at most this many nodes; deeper nodes are skipped. Traversals are
/// recursive in OSG and here: a transform takes about 400 bytes of stack, more in debug builds, and
/// threads may have little stack.
constexpr std::size_t kDeepestPath = 5000;

/// Visits active children only (masks, switches, levels of detail for the eye point), multiplies
/// transforms in double and accumulates state. The collector counts what is not a part of the
/// traced scene.
class GraphCollector : public PlacedVisitor
{
public:
    /// textures holds the images that were converted before, rules what rules have derived.
    GraphCollector(const ConversionInput& input, SoftwareVertices& vertices,
                   DrawableTriangles& triangles, const TextureConverter& textures,
                   RuleCaches& rules, ConversionReport& report);

    /// Visits the last node of a path from the root, in the place and the state that the node has
    /// there. The other nodes of the path are of the plain classes that GraphWatch knows. Returns
    /// false if the node cannot be placed.
    bool collectAt(const osg::NodePath& path);

    /// Returns what becomes of the last node of a path, as a conversion would decide on what a cull
    /// traversal shows of it, with these answers of the hook, which is not asked. Nothing: the node
    /// cannot be placed, or an answer is not there.
    std::optional<CullOutcome> cullOutcomeAt(const osg::NodePath& path, const CullRecord& record,
                                             HookAnswers& answers);

    /// Collects leaves of a cull traversal of the last node of a path, as a conversion would.
    /// Returns false if the node cannot be placed.
    bool collectLeavesAt(const osg::NodePath& path, std::vector<CulledLeaf>& leaves);

    /// Returns what was found. The caller may call this only once, after the traversal.
    CollectedGraph take();

    // kindOf() in NodeKind.h knows the classes that are watched node by node: a class that gets an
    // apply() of its own here must be of the kind Untracked there, or NodeHashes.cpp must hash the
    // values of the class.
    using osg::NodeVisitor::apply;
    void apply(osg::Node& node) override;
    void apply(osg::Transform& node) override;
    void apply(osg::Camera& node) override;
    void apply(osg::Projection& node) override;
    void apply(osg::LightSource& node) override;
    void apply(osg::ClearNode& node) override;
    void apply(osg::ClipNode& node) override;
    void apply(osg::PagedLOD& node) override;
    void apply(osg::ProxyNode& node) override;
    void apply(osg::TexGenNode& node) override;
    void apply(osg::Billboard& node) override;
    void apply(osg::OccluderNode& node) override;
    void apply(osg::Drawable& drawable) override;
    void apply(osg::Geometry& geometry) override;

private:
    void traverseChildren(osg::Node& node);
    bool isTooDeep(const osg::Node& node);
    bool isTooMuch(osg::Node& node);
    bool pushState(osg::Node& node);
    bool pushMatrix(const osg::Matrixd& worldFromLocal);
    void traverseBelow(const osg::Matrixd& worldFromLocal, osg::Node& node);
    bool collectLeaf(osg::Node& node);
    bool leavesDrawable(osg::Billboard& billboard);
    bool leavesGroup(osg::Node& node);
    void collectVolume(osg::Group& group);
    void collectBox(const MediumVolume& volume);
    void collectIsoSurface(const osgVolume::VolumeTile& tile, bool hasMaterial);
    void traverseGroup(osg::Group& group);
    void rasterize(RasterizedPart::Kind kind = RasterizedPart::Draw, osg::Node* inPlace = nullptr);
    bool descendTo(const osg::NodePath& path);
    void walkBelow(osg::Node& node);
    std::size_t pushStates(const CapturedLeaf& leaf);
    void popStates(std::size_t count);
    GraphState stateOf(const CapturedLeaf& leaf);
    const char* leftReason(const CapturedLeaf& leaf);
    bool finds(const std::vector<CapturedLeaf>& walked, const std::vector<CapturedLeaf>& culled);
    CullOutcome cullOutcome();
    CullOutcome cullOutcome(const CullRecord& record);
    CullOutcome::Kind takesChosen(const osg::Drawable& drawable,
                                  const std::vector<CapturedLeaf>& culled, bool otherStages,
                                  CullOutcome& outcome);
    bool collectsChosen(osg::Drawable& drawable);
    bool leavesOut(const osg::Drawable& drawable);
    bool isForSomeViews(const osg::Node& node);
    bool collectsInCull(osg::Node& node);
    void decideOnLeaves(std::vector<CapturedLeaf>& leaves, CullOutcome& outcome);
    void collectCulled(osg::Node& node, CullOutcome& outcome, const char* reason);
    void collectLeaf(CulledLeaf& leaf);
    void collectProxy(osg::Drawable& drawable);
    static osg::ref_ptr<TracedLeaves> tracedLeaves(const CullOutcome& outcome);
    AssignedState assignedState(const osg::Drawable& drawable);
    const char* rasterizedReason(const osg::Geometry& geometry, bool isPosed, uint32_t state);
    bool rasterizes(const osg::Geometry& geometry, bool isPosed, uint32_t state);
    void recordLeft(const osg::Geometry& geometry, uint32_t state, bool proxied);
    float pointRadiusOf(const osg::Geometry& geometry);
    uint32_t subtree();
    void recordSpecial();
    void leave(const osg::Geometry& geometry);
    void recordInScene();
    void recordAllInScene();
    void recordPlanes(uint64_t numbers);
    void recordCuttingPlanes();
    void collectUse(const osg::Geometry& geometry, uint32_t state, bool proxy);
    bool isProxied(osg::Drawable& drawable);
    bool isProxied(const CulledLeaf& leaf);
    void warnIfForced(const char* what);
    osg::Matrixd worldFromEye() const { return engine::worldFromEye(_input.view, _input.eye); }
    osg::Matrixd engineFromLocal() const;
    uint32_t pickPath();
    std::string path() const { return pathText(getNodePath()); }

    SoftwareVertices& _vertices;
    DrawableTriangles& _triangles;
    const TextureConverter& _textures;
    ConversionReport& _report;
    PathBudget _visits;
    PathBudget _rasterizedVisits; // budget of OSG's visits in each frame to parts left to it
    PathCounts _counts;
    std::size_t _captured =
        0;                    // length of the path to the outermost captured node; 0: there is none
    int _untracked = 0;       // number of enclosing nodes that GraphWatch does not look into
    int _leftToOsg = 0;       // number of enclosing nodes that OSG draws with all below them
    bool _isLeft = false;     // OSG draws an enclosing group as a whole
    bool _lightsOnly = false; // leaves of a cull traversal stand for the drawables
    uint32_t _culledLeaf = kNoCulledLeaf; // such a leaf is visited, on a path that is not its own
    uint32_t _culledLeaves = 0;           // number of such leaves so far
    StateStack _states;
    RuleCaches& _rules;
    MaterialAssignment _materials; ///< assignment that keeps its additions to the states
    CollectedGraph _graph;
    /// Outermost nodes of unknown classes with clip nodes at or below them, and the numbers of
    /// their planes, as bits.
    std::vector<std::pair<const osg::Node*, uint64_t>> _unwatchedClips;
    std::map<std::pair<const osg::Geometry*, uint64_t>, std::size_t> _indexOf; // key with restart
};

} // namespace osgRayTrace::engine
