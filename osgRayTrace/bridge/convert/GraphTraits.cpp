// GraphTraits.cpp - looks through the states of all uses. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/GraphTraits.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialConverter.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether a use that camera rays meet has a state for which is(state) is true.
template <class Is> bool anyUse(const CollectedGraph& graph, const Is& is)
{
    for (const CollectedGeometry& geometry : graph.geometries)
        for (const GeometryUse& use : geometry.uses)
            if (!use.proxy && is(graph.states[use.state])) return true;
    return false;
}

} // namespace

bool isLinear(const CollectedGraph& graph, RayTraceSettings::ColorRule rule)
{
    if (rule != RayTraceSettings::AUTOMATIC_COLOR) return rule == RayTraceSettings::LINEAR;
    if (!graph.lights.areaLights.empty() || !graph.lights.environments.empty() ||
        !graph.lights.volumes.empty())
        return true;
    for (const CollectedTile& tile : graph.lights.tiles)
        if (tile.material) return true;
    return anyUse(graph, [](const GraphState& state)
                  { return state.attributes[kPhysicalMaterialSlot] != nullptr; });
}

bool setsColor(const CollectedGraph& graph)
{
    return anyUse(graph, setsCurrentColor);
}

} // namespace osgRayTrace::engine
