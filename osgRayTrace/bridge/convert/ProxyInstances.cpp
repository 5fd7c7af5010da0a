// ProxyInstances.cpp - adds uses of geometries that OSG draws, or that nobody sees. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/SceneBuilder.h"
#include "osgRayTrace/bridge/graph/Proxies.h"

namespace osgRayTrace::engine
{

/// Records a use of which nothing is traced.
void SceneBuilder::addNothing(const CollectedGeometry& geometry, const GeometryUse& use)
{
    recordUse(geometry, use,
              {kInvalid, use.proxy ? kInvalid : effects(use.state, ConversionCounts())});
}

Material materialOf(MaterialConverter& materials, const GeometryUse& use,
                    const CollectedGraph& graph, const SurfaceInputs& inputs)
{
    const GraphState& state = graph.states[use.state];
    Material material = materials.material(use.proxy ? proxyState(state) : state, inputs,
                                           {use.engineFromLocal, &graph.texGens});
    if (use.proxy) hideFromCamera(material);
    return material;
}

/// Makes the instance of a proxy. The state of a proxy changes nothing of what camera rays see,
/// such as the ambient light, and its omissions are not counted: OSG draws with all of the state.
TracedUse SceneBuilder::newProxy(const CollectedGeometry& geometry, const GeometryUse& use,
                                 Instance instance)
{
    instance.material = _convertedGraph.materials.add(
        materialOf(_materials, use, _graph, surfaceInputs(*geometry.geometry, _input.pointRadius)));
    instance.changed = _rules.now;
    _report.count("traced.proxy");
    return {appendInstance(instance), kInvalid, proxyEffects(use.state)};
}

/// Returns the index of the effects of a proxy with this state.
uint32_t SceneBuilder::proxyEffects(uint32_t state)
{
    std::optional<StateEffects>& known = _effects[state];
    if (!known) known = stateEffectsOf(_graph.states[state], _caches.textures);
    StateEffects wanted = *known;
    wanted.proxied = true;
    return _convertedGraph.index.effects(wanted);
}

/// Returns where the omissions of a geometry are counted: nowhere if OSG draws all of its uses.
ConversionReport& SceneBuilder::reportOf(const CollectedGeometry& geometry)
{
    return geometry.isProxy() ? _proxyReport : _report;
}

} // namespace osgRayTrace::engine
