// ConvertedSubtree.cpp - keeps what unwatched subtrees have become. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/ConvertedSubtree.h"

#include "osgRayTrace/bridge/common/Hasher.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace osgRayTrace::engine
{

uint64_t placeHash(const osg::Matrixd& engineFromLocal)
{
    Hasher hasher;
    hasher.addMatrix(engineFromLocal);
    return hasher.value();
}

std::vector<ConvertedSubtree::Place> placesOf(const CollectedGraph& graph)
{
    std::vector<ConvertedSubtree::Place> places;
    for (const CollectedGeometry& geometry : graph.geometries)
        for (const GeometryUse& use : geometry.uses)
            places.push_back({geometry.geometry.get(), placeHash(use.engineFromLocal)});
    return places;
}

void ConvertedSubtrees::record(CollectedGraph& graph)
{
    all.clear();
    for (UnwatchedSubtree& subtree : graph.subtrees)
        static_cast<UnwatchedSubtree&>(all.emplace_back()) = std::move(subtree);
    for (const CollectedGeometry& geometry : graph.geometries)
        for (const GeometryUse& use : geometry.uses)
            if (use.subtree != kNoSubtree)
                all[use.subtree].places.push_back(
                    {geometry.geometry.get(), placeHash(use.engineFromLocal)});
    partSubtrees = std::move(graph.rasterizedSubtrees);
    enclosures = std::move(graph.enclosures);
}

uint32_t ConvertedSubtrees::find(const osg::NodePath& path) const
{
    uint32_t found = kNoSubtree;
    for (uint32_t i = 0; i < all.size(); ++i)
    {
        const osg::NodePath& at = all[i].path;
        if (at.size() > path.size() || at.back() != path[at.size() - 1] ||
            !std::equal(at.begin(), at.end(), path.begin()))
            continue;
        if (found != kNoSubtree) return kNoSubtree;
        found = i;
    }
    return found;
}

Enclosure* ConvertedSubtrees::enclosure(const osg::Geometry& geometry)
{
    const auto found =
        std::find_if(enclosures.begin(), enclosures.end(),
                     [&](const Enclosure& one) { return one.geometry == &geometry; });
    return found == enclosures.end() ? nullptr : &*found;
}

void ConvertedSubtrees::setParts(uint32_t subtree, RasterizedParts fresh)
{
    const auto begin = static_cast<std::ptrdiff_t>(all[subtree].parts);
    const auto count = std::count(partSubtrees.begin(), partSubtrees.end(), subtree);
    const auto more = static_cast<std::ptrdiff_t>(fresh.size()) - count;
    RasterizedParts now(parts->begin(), parts->begin() + begin);
    now.insert(now.end(), std::make_move_iterator(fresh.begin()),
               std::make_move_iterator(fresh.end()));
    now.insert(now.end(), parts->begin() + begin + count, parts->end());
    parts = std::make_shared<const RasterizedParts>(std::move(now));
    const auto at =
        partSubtrees.erase(partSubtrees.begin() + begin, partSubtrees.begin() + begin + count);
    partSubtrees.insert(at, static_cast<std::size_t>(count + more), subtree);
    for (std::size_t i = subtree + 1; i < all.size(); ++i)
        all[i].parts = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(all[i].parts) + more);
}

} // namespace osgRayTrace::engine
