// SceneBuilder.h - turns what was collected of a graph into parts of a Scene. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/MaterialConverter.h"
#include "osgRayTrace/bridge/convert/ConversionState.h"

#include <osg/LightModel>

namespace osgRayTrace::engine
{

/// The rules say how a Scene is made from what was collected.
struct BuildRules
{
    double unit = 1.0;
    bool linear = false;
    bool setsColor = false;  ///< see MaterialRules
    bool comparable = false; ///< comparable with the last snapshot: differences are changes
    bool patches = false;    ///< adds to a scene that is there: all instances are placed
    Stamp now = 0;
};

/// Adds what was collected to a Scene: the whole graph to a new Scene, or later additions to a copy
/// of the last Scene.
class SceneBuilder
{
public:
    SceneBuilder(const ConversionInput& input, const CollectedGraph& graph, const BuildRules& rules,
                 ConversionCaches& caches, ConvertedGraph& convertedGraph, Scene& scene,
                 ConversionReport& report);

    /// Builds a whole new scene.
    void build();

    /// Returns the instances of all uses of the graph's geometries in turn, with kInvalid for a use
    /// that is not traced. The list is complete after build().
    const std::vector<uint32_t>& instances() const { return _instances; }

    /// Adds one more geometry, which gets a BVH of its own.
    void add(const CollectedGeometry& geometry);

    /// Adds one more path to a geometry that is there and placed, before the use with the number
    /// before. Returns false if the path cannot be placed.
    bool addUse(const CollectedGeometry& geometry, const GeometryUse& use, uint32_t before);

private:
    void recordNew();
    bool isPlaced(const CollectedGeometry& geometry);
    void putFlatFirst();
    void addGeometry(const CollectedGeometry& geometry);
    void warnIfCoarse(const CollectedGeometry& geometry);
    void warnIfOpen(const CollectedGeometry& geometry, const Instance& instance);
    Clipping clipBy(const CollectedGeometry& geometry, const GeometryUse& use,
                    MeshRequest& request);
    void recordClipped(const CollectedGeometry& geometry, const GeometryUse& use,
                       const MeshRequest& request, uint32_t variant, Clipping clipping, bool own);
    void addPlacedUses(const CollectedGeometry& geometry);
    void addBaked(const CollectedGeometry& geometry, const GeometryUse& use,
                  const std::shared_ptr<const Mesh>& mesh);
    void addInstance(const CollectedGeometry& geometry, const GeometryUse& use, Instance instance);
    TracedUse newInstance(const CollectedGeometry& geometry, const GeometryUse& use,
                          Instance instance);
    TracedUse newProxy(const CollectedGeometry& geometry, const GeometryUse& use,
                       Instance instance);
    ConversionReport& reportOf(const CollectedGeometry& geometry);
    void recordUse(const CollectedGeometry& geometry, const TracedUse& use);
    void addAreaLight(const CollectedAreaLight& source, ConversionCaches::Quad& quad);
    void addNothing(const CollectedGeometry& geometry, const GeometryUse& use);
    uint32_t effects(uint32_t state, const ConversionCounts& counts);
    void setAmbient(const GraphState& state);
    uint32_t addMesh(const std::shared_ptr<const Mesh>& mesh);
    uint32_t appendInstance(const Instance& instance);
    MeshRequest requestFor(const CollectedGeometry& geometry, const osg::Matrixd& transform) const;

    const ConversionInput& _input;
    const CollectedGraph& _graph;
    BuildRules _rules;
    bool _newJoinStatic = false;
    ConversionCaches& _caches;
    ConvertedGraph& _convertedGraph;
    Scene& _scene;
    ConversionReport& _report;
    ConversionReport _proxyReport; ///< what is left out of proxies, which nobody reads
    ConversionReport _materialReport;
    MaterialConverter _materials;
    std::vector<std::optional<StateEffects>> _effects; ///< effects by state
    std::vector<uint32_t> _instances;
    const osg::LightModel* _lightModel = nullptr; // first light model met
};

} // namespace osgRayTrace::engine
