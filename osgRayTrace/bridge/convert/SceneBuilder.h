// SceneBuilder.h - turns what was collected of a graph into parts of a Scene. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/MaterialConverter.h"
#include "osgRayTrace/bridge/convert/ConversionState.h"

#include <osg/LightModel>

namespace osgRayTrace::engine
{

/// How a Scene is made from what was collected.
struct BuildRules
{
    double unit = 1.0;
    bool linear = false;
    bool setsColor = false;  ///< see MaterialRules
    bool comparable = false; ///< with the last snapshot: what differs has changed
    Stamp now = 0;
};

/// Adds what was collected to a Scene: of the whole graph to a new one, or of what came later to a
/// copy of the last one.
class SceneBuilder
{
public:
    SceneBuilder(const ConversionInput& input, const CollectedGraph& graph, const BuildRules& rules,
                 ConversionCaches& caches, ConvertedGraph& convertedGraph, Scene& scene,
                 ConversionReport& report);

    /// A new scene, all of it.
    void build();

    /// Of all uses of the graph's geometries in turn, kInvalid for what is not traced. After
    /// build().
    const std::vector<uint32_t>& instances() const { return _instances; }

    /// One more geometry, which gets a BVH of its own.
    void add(const CollectedGeometry& geometry);

    /// Of one that is there and placed: one more path, before the use of this number. False: it
    /// cannot be placed.
    bool addUse(const CollectedGeometry& geometry, const GeometryUse& use, uint32_t before);

private:
    void recordNew();
    bool isPlaced(const CollectedGeometry& geometry);
    void putFlatFirst();
    void addGeometry(const CollectedGeometry& geometry);
    void warnIfCoarse(const CollectedGeometry& geometry);
    Clipping clipBy(const CollectedGeometry& geometry, const GeometryUse& use,
                    MeshRequest& request);
    void addPlacedUses(const CollectedGeometry& geometry);
    void addBaked(const CollectedGeometry& geometry, const GeometryUse& use,
                  const std::shared_ptr<const Mesh>& mesh);
    void addInstance(const CollectedGeometry& geometry, const GeometryUse& use, Instance instance);
    TracedUse newInstance(const CollectedGeometry& geometry, const GeometryUse& use,
                          Instance instance);
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
    ConversionReport _materialReport;
    MaterialConverter _materials;
    std::vector<std::optional<StateEffects>> _effects; ///< by state
    std::vector<uint32_t> _instances;
    const osg::LightModel* _lightModel = nullptr; // the first one met
};

} // namespace osgRayTrace::engine
