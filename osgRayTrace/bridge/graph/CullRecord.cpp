// CullRecord.cpp - reads a state graph, and compares it with what was read. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/CullRecord.h"

#include "osgRayTrace/bridge/common/Hasher.h"

#include <osgUtil/RenderStage>
#include <osgUtil/StateGraph>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_set>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

bool sameBits(const osg::Matrixd& a, const osg::Matrixd& b)
{
    return std::memcmp(a.ptr(), b.ptr(), 16 * sizeof(double)) == 0;
}

} // namespace

/// Holds how far the comparison of a traversal with the record has come.
struct CullRecord::Comparison
{
    const SameState& sameState;
    const osg::RefMatrix& projection;
    bool sameView;              ///< the view has the same matrix
    osg::Matrixd worldFromView; ///< of the view of now
    std::size_t entry = 0;      ///< index of the next leaf
    uint32_t chain = 0;         ///< index of the state sets of the next leaf
    /// Pairs of state sets that have been found the same.
    std::vector<std::pair<const osg::StateSet*, const osg::StateSet*>> same{};

    bool isSame(const osg::StateSet* then, const osg::StateSet* now)
    {
        if (then == now) return true;
        if (!sameState) return false;
        const std::pair pair(then, now);
        if (std::find(same.begin(), same.end(), pair) != same.end()) return true;
        if (!sameState(*then, *now)) return false;
        same.push_back(pair);
        return true;
    }

    bool isSame(const std::vector<const osg::StateSet*>& then, const osgUtil::StateGraph& now)
    {
        auto next = then.rbegin();
        for (const osgUtil::StateGraph* graph = &now; graph; graph = graph->_parent)
        {
            if (!graph->getStateSet()) continue;
            if (next == then.rend() || !isSame(*next, graph->getStateSet())) return false;
            ++next;
        }
        return next == then.rend();
    }
};

bool CullRecord::take(osgUtil::RenderStage& stage, const osg::Matrixd& viewFromWorld,
                      const osg::RefMatrix& projection, const SameState& sameState)
{
    const bool otherStages =
        !stage.getPreRenderList().empty() || !stage.getPostRenderList().empty();
    const osg::Matrixd worldFromView = osg::Matrixd::inverse(viewFromWorld);
    if (_taken && otherStages == _otherStages)
    {
        Comparison comparison{sameState, projection, sameBits(_viewFromWorld, viewFromWorld),
                              worldFromView};
        if (repeats(stage, comparison) && comparison.entry == _entries.size())
        {
            _viewFromWorld = viewFromWorld;
            return true;
        }
    }
    *this = CullRecord();
    add(stage, projection);
    for (Entry& entry : _entries)
        entry.worldFromLocal.mult(entry.viewFromLocal, worldFromView);
    listObjects();
    _viewFromWorld = viewFromWorld;
    _otherStages = otherStages;
    _taken = true;
    return false;
}

void CullRecord::fail(std::string error)
{
    *this = CullRecord();
    _error = std::move(error);
}

bool CullRecord::repeats(const osgUtil::RenderBin& bin, Comparison& comparison)
{
    for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
        if (!repeats(*graph, comparison)) return false;
    for (const auto& [number, inner] : bin.getRenderBinList())
        if (!repeats(*inner, comparison)) return false;
    return true;
}

bool CullRecord::repeats(const osgUtil::StateGraph& graph, Comparison& comparison)
{
    bool isFirst = true;
    for (const osg::ref_ptr<osgUtil::RenderLeaf>& leaf : graph._leaves)
    {
        if (!leaf->getDrawable()) continue;
        if (comparison.entry == _entries.size()) return false;
        Entry& entry = _entries[comparison.entry];
        const bool isProjected = leaf->_projection != &comparison.projection;
        if (leaf->getDrawable() != entry.drawable || isProjected != entry.isProjected ||
            leaf->_traversalOrderNumber != entry.order || entry.chain != comparison.chain)
            return false;
        if (std::exchange(isFirst, false) && !comparison.isSame(_chains[entry.chain], graph))
            return false;
        ++comparison.entry;
        if (!leaf->_modelview) continue;
        if (comparison.sameView && sameBits(*leaf->_modelview, entry.viewFromLocal)) continue;
        osg::Matrixd worldFromLocal;
        worldFromLocal.mult(*leaf->_modelview, comparison.worldFromView);
        if (!sameMatrix(worldFromLocal, entry.worldFromLocal,
                        comparison.worldFromView.getTrans().length()))
            return false;
        entry.viewFromLocal = *leaf->_modelview;
    }
    if (!isFirst) ++comparison.chain;
    return true;
}

void CullRecord::add(osgUtil::RenderBin& bin, const osg::RefMatrix& projection)
{
    for (const osgUtil::StateGraph* graph : bin.getStateGraphList())
    {
        const std::size_t before = _entries.size();
        for (const osg::ref_ptr<osgUtil::RenderLeaf>& leaf : graph->_leaves)
        {
            if (!leaf->getDrawable()) continue;
            Entry& entry = _entries.emplace_back();
            entry.drawable = const_cast<osg::Drawable*>(leaf->getDrawable());
            if (leaf->_modelview) entry.viewFromLocal = *leaf->_modelview;
            entry.chain = static_cast<uint32_t>(_chains.size());
            entry.order = leaf->_traversalOrderNumber;
            entry.isProjected = leaf->_projection != &projection;
        }
        if (_entries.size() == before) continue;
        std::vector<const osg::StateSet*>& chain = _chains.emplace_back();
        for (; graph; graph = graph->_parent)
            if (graph->getStateSet()) chain.push_back(graph->getStateSet());
        std::reverse(chain.begin(), chain.end());
    }
    for (const auto& [number, inner] : bin.getRenderBinList())
        add(*inner, projection);
}

/// Lists what the entries refer to, which keeps it alive.
void CullRecord::listObjects()
{
    std::unordered_set<const osg::Object*> seen;
    for (const Entry& entry : _entries)
        if (seen.insert(entry.drawable).second) _drawables.emplace_back(entry.drawable);
    for (const std::vector<const osg::StateSet*>& chain : _chains)
        for (const osg::StateSet* stateSet : chain)
            if (seen.insert(stateSet).second) _stateSets.emplace_back(stateSet);
}

std::vector<CapturedLeaf> CullRecord::leaves() const
{
    std::vector<uint32_t> ordered(_entries.size());
    std::iota(ordered.begin(), ordered.end(), 0u);
    std::stable_sort(ordered.begin(), ordered.end(),
                     [this](uint32_t a, uint32_t b)
                     { return _entries[a].order < _entries[b].order; });
    std::vector<CapturedLeaf> leaves;
    leaves.reserve(ordered.size());
    for (const uint32_t i : ordered)
    {
        const Entry& entry = _entries[i];
        const std::vector<const osg::StateSet*>& chain = _chains[entry.chain];
        leaves.push_back({entry.drawable,
                          entry.worldFromLocal,
                          {chain.begin(), chain.end()},
                          entry.isProjected});
    }
    return leaves;
}

uint64_t CullRecord::signature() const
{
    Hasher hasher;
    for (const Entry& entry : _entries)
    {
        hasher.addData(entry.drawable);
        hasher.add(entry.order, entry.chain);
    }
    for (const std::vector<const osg::StateSet*>& chain : _chains)
    {
        hasher.add(chain.size());
        for (const osg::StateSet* stateSet : chain)
            hasher.addData(stateSet);
    }
    return hasher.value();
}

bool sameMatrix(const osg::Matrixd& a, const osg::Matrixd& b, double eyeDistance)
{
    constexpr double kRounding = 1e-11;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
        {
            const double size = row == 3 ? eyeDistance + std::abs(a(row, column)) : 1.0;
            const double bound = kRounding * (size + std::abs(a(row, column)));
            if (!(std::abs(a(row, column) - b(row, column)) <= bound)) return false;
        }
    return true;
}

} // namespace osgRayTrace::engine
