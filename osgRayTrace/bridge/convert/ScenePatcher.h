// ScenePatcher.h - makes a new Scene from the last one, redoing only what changed. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/MaterialConverter.h"
#include "osgRayTrace/bridge/changes/GraphChanges.h"
#include "osgRayTrace/bridge/convert/ConversionState.h"
#include "osgRayTrace/bridge/convert/SceneBuilder.h"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

/// Makes one patch. The patcher's changes to convertedGraph and caches belong to the scene that
/// patch() returns. If patch() returns no scene, the changes belong to none, and the graph must be
/// converted again.
class ScenePatcher
{
public:
    /// The scene last must be in units of 1 and have ordinary lengths (see SceneExtent).
    ScenePatcher(const Scene& last, const ConversionInput& input, ConversionCaches& caches,
                 ConvertedGraph& convertedGraph, Stamp now);

    /// Returns the new scene, or null if the changes take more than a patch: see reason().
    std::shared_ptr<Scene> patch(const GraphChanges& changes);

    const ConversionReason& reason() const { return _reason; }

    /// Returns whether patch() has changed something.
    bool changed() const { return _changed; }

    /// Returns whether instances came or went.
    bool spliced() const { return _spliced; }

    /// Returns whether some mesh left the static BVH.
    bool leftStatic() const { return _leftStatic; }

    /// Returns how many more geometries are converted now than before; fewer make it negative.
    int64_t geometriesMore() const { return _geometries; }
    int64_t instancesMore() const { return _instances; }
    int64_t proxiesMore() const { return _proxies; }

    /// Returns what else the report counts more, by its keys; fewer make it negative.
    const std::map<std::string, int64_t>& countsMore() const { return _countsMore; }

    /// Returns whether OSG draws other parts than before: see ConvertedSubtrees.
    bool otherParts() const { return _otherParts; }

    /// Returns whether files have come that are read when they are seen.
    bool paged() const { return _paged; }

private:
    bool splice(const GraphSplice& splice);
    bool remove(const GraphSplice& splice);
    bool splice(const CullSplice& splice);
    bool removeProxy(const ChangedUse& gone);
    bool addProxies(const CullSplice& splice);
    bool findBounds(CollectedGraph& graph);
    ConversionCause addProxy(const CollectedGraph& graph, const CollectedGeometry& geometry,
                             uint32_t subtree);
    bool redo(const ChangedSubtree& changed);
    ConversionCause exchange(uint32_t subtree, const CollectedGraph& graph);
    ConversionCause removeUses(const osg::Geometry& geometry, uint32_t subtree);
    ConversionCause addUses(const CollectedGraph& graph, const CollectedGeometry& geometry,
                            uint32_t subtree);
    void record(uint32_t subtree, CollectedGraph& graph, const ConversionCounts& counts);
    void recordPlaces(const std::vector<MovedUse>& moved);
    void takeNewMaterials();
    void removeInstance(uint32_t index);
    void removeMesh(uint32_t index);
    ConversionCause removeUse(TracedGeometry& traced, uint32_t use);
    bool isLastOf(uint32_t effects) const;
    bool add(const GraphSplice& splice);
    BuildRules patchRules(uint32_t subtree) const;
    ConversionCause stateCause(const CollectedGraph& graph,
                               const CollectedGeometry& geometry) const;
    ConversionCause addGeometry(const CollectedGraph& graph, const CollectedGeometry& geometry,
                                const GraphSplice& splice);
    bool moveAndDeform(const GraphChanges& changes);
    bool encloseStill(const std::vector<MovedUse>& moved);
    bool recut(const std::vector<PlacedClip>& clips);
    bool recut(ClippedUse& use);
    bool changeStates(const std::vector<StateChange>& uses);
    bool changeState(const StateChange& use, StateStack& states, MaterialConverter& converter,
                     ConversionReport& report);
    bool changeLeft(const StateChange& use, const TracedUse& traced, const GraphState& state,
                    StateEffects effects, const SurfacePlacement& place,
                    MaterialConverter& converter);
    bool relightLamps();
    bool relight();
    void setBackground();
    void takeMaterials();
    void dropRemoved();
    uint32_t emptyMeshIndex();
    bool refuse(ConversionCause cause, const osg::NodePath& path);
    bool refuse(ConversionCause cause, const osg::Geometry& geometry, uint32_t use);
    osg::NodePath fromRoot(const osg::NodePath& path) const;
    bool refuseLamp(const std::string& path);

    const Scene& _last;
    const ConversionInput& _input;
    ConversionCaches& _caches;
    ConvertedGraph& _convertedGraph;
    Stamp _now;
    std::shared_ptr<Scene> _scene;
    std::vector<std::pair<uint32_t, Material>>
        _newMaterials; ///< instances that get other materials
    std::vector<osg::ref_ptr<const osg::Geometry>> _removed;
    std::set<uint32_t> _redone;      ///< subtrees that have been collected again
    std::set<uint32_t> _goneEffects; ///< effects of uses that are gone from them
    std::map<std::string, int64_t> _countsMore;
    bool _otherParts = false, _paged = false;
    int64_t _geometries = 0, _instances = 0, _proxies = 0;
    bool _changed = false;
    bool _leftStatic = false;
    bool _recolors = false; ///< a use has begun or ceased to set the current colour
    bool _spliced = false;
    ConversionReason _reason;
};

} // namespace osgRayTrace::engine
