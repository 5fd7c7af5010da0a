// PickIndex.cpp - records the use of the graph behind each instance. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/pick/PickIndex.h"

#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether osgUtil's intersectors of lines can meet the node: they meet triangles and
/// quads, but never lines, points and patches.
bool hasFaces(osg::Node& node)
{
    const osg::Geometry* geometry = node.asGeometry();
    if (!geometry) return true;
    const osg::Geometry::PrimitiveSetList& sets = geometry->getPrimitiveSetList();
    return std::any_of(sets.begin(), sets.end(),
                       [](const osg::ref_ptr<osg::PrimitiveSet>& set) {
                           return set && set->getMode() >= GL_TRIANGLES &&
                                  set->getMode() <= GL_POLYGON;
                       });
}

} // namespace

PickIndex::PickIndex(CollectedGraph& graph, const std::vector<uint32_t>& instances)
    : _paths(std::move(graph.paths))
{
    // Parts come in the order of the traversal, which is also the order of the numbers of paths.
    std::size_t use = 0;
    for (const CollectedGeometry& geometry : graph.geometries)
    {
        const auto source = static_cast<uint32_t>(_geometries.size());
        _geometries.push_back({geometry.geometry, geometry.restart, geometry.pointRadius > 0.0f});
        for (const GeometryUse& placed : geometry.uses)
        {
            const uint32_t instance = instances[use++];
            if (placed.path == NodeTree::kNone) continue;
            const uint32_t byView = _paths.placedByView(placed.path);
            if (byView != NodeTree::kNone) _parts.push_back({byView, nullptr});
            if (instance == kInvalid || byView != NodeTree::kNone) continue;
            if (instance >= _uses.size()) _uses.resize(instance + 1);
            _uses[instance] = {placed.path, source};
        }
    }
    for (std::size_t i = 0; i < graph.rasterized.size(); ++i)
    {
        const RasterizedPart& part = graph.rasterized[i];
        const uint32_t path = graph.rasterizedPaths[i];
        const bool picked = part.kind == RasterizedPart::Draw || part.kind == RasterizedPart::Pick;
        if (picked && path != NodeTree::kNone) addPart(path, part.inPlace.get());
    }
    for (const CollectedAreaLight& light : graph.lights.areaLights)
        if (light.pickPath != NodeTree::kNone) addPart(light.pickPath, nullptr);
    const auto before = [](const Part& a, const Part& b) { return a.path < b.path; };
    const auto same = [](const Part& a, const Part& b) { return a.path == b.path; };
    std::stable_sort(_parts.begin(), _parts.end(), before);
    _parts.erase(std::unique(_parts.begin(), _parts.end(), same), _parts.end());
}

void PickIndex::addPart(uint32_t path, osg::Node* inPlace)
{
    const uint32_t byView = _paths.placedByView(path);
    if (byView != NodeTree::kNone)
        _parts.push_back({byView, nullptr});
    else if (hasFaces(inPlace ? *inPlace : _paths.node(path)))
        _parts.push_back({path, inPlace});
}

PickIndex::Use PickIndex::use(uint32_t instance) const
{
    return instance < _uses.size() ? _uses[instance] : Use();
}

GeometryTriangle PickIndex::triangle(const Use& use, const Mesh& mesh, uint32_t triangle) const
{
    std::shared_ptr<const PrimitiveNumbers> numbers;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        std::shared_ptr<const PrimitiveNumbers>& known = _numbers[use.geometry];
        if (!known || !known->isOf(mesh))
        {
            const Source& source = _geometries[use.geometry];
            known = std::make_shared<PrimitiveNumbers>(*source.geometry, source.restart,
                                                       source.solids, mesh);
        }
        numbers = known;
    }
    return numbers->at(triangle);
}

} // namespace osgRayTrace::engine
