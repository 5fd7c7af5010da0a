// CullWatch.cpp - compares the leaves of cull traversals with what they were. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/CullWatch.h"

#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/changes/StateHash.h"
#include "osgRayTrace/bridge/common/FlatMatrix.h"
#include "osgRayTrace/bridge/geometry/BufferHashes.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kDrawablesALook = 1000;
/// The setup of a traversal takes as long as so many drawables, by the samples of a profiler.
constexpr std::size_t kDrawablesASubtree = 7;
/// In one of so many rounds, places are compared where nothing was added, not only drawables.
constexpr std::size_t kRoundsByDrawables = 16;

/// Returns a hash of what of a drawable is no part of its shape: a patch cannot redo it.
uint64_t attributesHash(const osg::Drawable& drawable)
{
    Hasher hasher;
    hasher.add(drawable.getDrawCallback() != nullptr, drawable.getDataVariance());
    const osg::Geometry* geometry = drawable.asGeometry();
    if (!geometry) return hasher.value();
    forEachBuffer(*geometry, true,
                  [&hasher](const osg::BufferData* data, bool shape)
                  {
                      hasher.add(data != nullptr);
                      if (data && !shape) hasher.add(bufferHash(bufferKindOf(*data), *data));
                  });
    return hasher.value();
}

/// Returns whether a drawable can be traced or have a proxy, in some state. Particles, texts and
/// the like cannot.
bool canBeInScene(const osg::Drawable& drawable)
{
    if (drawable.asGeometry()) return true;
    const char* reason = untracedDrawable(drawable);
    return !reason || std::strcmp(reason, "not-traced.custom-drawable") == 0;
}

/// Returns whether anything that has this place has an area.
bool showsAnything(const osg::Matrixd& worldFromLocal)
{
    return placingMatrix(worldFromLocal, 0.0).has_value();
}

/// Returns how many leaves OSG draws, by the reason that the report counts.
std::map<std::string, int64_t> leftOf(const std::vector<CulledLeaf>& leaves)
{
    std::map<std::string, int64_t> left;
    for (const CulledLeaf& leaf : leaves)
        if (leaf.left) ++left[leaf.left];
    return left;
}

/// Returns whether leaves in the scene are of the same drawables, in the same order and way.
bool sameDrawables(const std::vector<CulledLeaf>& before, const std::vector<CulledLeaf>& now)
{
    auto next = before.begin();
    for (const CulledLeaf& leaf : now)
    {
        if (!leaf.isInScene()) continue;
        if (next == before.end() || next->drawable != leaf.drawable || next->proxy != leaf.proxy)
            return false;
        ++next;
    }
    return next == before.end();
}

/// Returns the part of the scene that each leaf has become, by its number.
CullWatch::LeafUses usesOf(const CollectedGraph& graph)
{
    CullWatch::LeafUses uses;
    for (const CollectedGeometry& geometry : graph.geometries)
        for (std::size_t i = 0; i < geometry.uses.size(); ++i)
            if (geometry.uses[i].culled != kNoCulledLeaf)
                uses[geometry.uses[i].culled] = {geometry.geometry.get(), static_cast<uint32_t>(i),
                                                 static_cast<uint32_t>(geometry.uses.size())};
    return uses;
}

} // namespace

uint64_t CullWatch::hashOf(const osg::StateSet& stateSet) const
{
    Hasher hasher;
    addStateSet(hasher, stateSet, _plain.reads.get());
    return hasher.value();
}

uint64_t CullWatch::hashOf(osg::Drawable& drawable) const
{
    return graphHash(drawable, _plain);
}

/// Returns whether the state of a leaf has the values that it had when it was converted. Callbacks
/// may take turns with two state sets of the same values. What OSG draws may get other state sets
/// in each frame, for its programs: its proxy keeps the material that it has.
bool CullWatch::sameStates(const CulledLeaf& before, const WatchedLeaf& values,
                           const CulledLeaf& now) const
{
    if (before.states.size() != now.states.size()) return false;
    for (std::size_t i = 0; i < now.states.size(); ++i)
    {
        const osg::StateSet &then = *before.states[i], &stateSet = *now.states[i];
        if (now.proxy && &then != &stateSet) continue;
        if (hashOf(then) != values.states[i]) return false;
        if (&then != &stateSet && then.compare(stateSet, true) != 0) return false;
    }
    return true;
}

/// Returns a hash of the values that decide, beside the drawables, places and state sets of the
/// record, on what becomes of a subtree: those of its drawables that can be in the scene, of its
/// state, and of the state and the hints above it.
uint64_t CullWatch::contentOf(const CullOutcome& outcome) const
{
    Hasher hasher;
    for (const osg::Node* node : outcome.path)
    {
        hasher.add(ownHint(*node));
        if (node->getStateSet()) hasher.add(hashOf(*node->getStateSet()));
    }
    for (const osg::ref_ptr<const osg::StateSet>& stateSet : outcome.record.stateSets())
        hasher.add(hashOf(*stateSet));
    for (const osg::ref_ptr<osg::Drawable>& drawable : outcome.record.drawables())
        if (canBeInScene(*drawable))
            hasher.add(hashOf(*drawable), drawable->getDrawCallback() != nullptr,
                       drawable->getDataVariance());
    return hasher.value();
}

CullWatch::WatchedLeaf CullWatch::valuesOf(const CulledLeaf& leaf) const
{
    WatchedLeaf values;
    for (const osg::ref_ptr<const osg::StateSet>& stateSet : leaf.states)
        values.states.push_back(hashOf(*stateSet));
    values.content = hashOf(*leaf.drawable);
    values.attributes = attributesHash(*leaf.drawable);
    return values;
}

CullWatch::Watched CullWatch::watchedOf(CullOutcome& outcome, const LeafUses& uses) const
{
    Watched watched;
    watched.drawn = outcome.isDrawn();
    watched.left = leftOf(outcome.leaves);
    for (CulledLeaf& leaf : std::exchange(outcome.leaves, {}))
    {
        if (!leaf.isInScene()) continue;
        WatchedLeaf& values = watched.values.emplace_back(valuesOf(leaf));
        const auto use = uses.find(leaf.number);
        if (use != uses.end()) values.use = use->second;
        watched.leaves.push_back(std::move(leaf));
    }
    watched.captured = outcome.record.size();
    watched.signature = outcome.record.signature();
    watched.outcome = std::move(outcome);
    if (watched.outcome.kind == CullOutcome::Captured)
        watched.content = contentOf(watched.outcome);
    else
        watched.outcome.record = CullRecord();
    return watched;
}

void CullWatch::record(CollectedGraph& graph, std::shared_ptr<const ShaderReads> reads)
{
    _plain.reads = std::move(reads);
    _watched.clear();
    _captured.clear();
    _unknown = graph.cullUnknown;
    _next = _credit = 0;
    _plainAbove = nullptr;
    const LeafUses uses = usesOf(graph);
    for (CullOutcome& outcome : graph.cullOutcomes)
    {
        if (outcome.kind == CullOutcome::Captured) _captured.insert(outcome.path.back());
        _watched.push_back(watchedOf(outcome, uses));
    }
    graph.cullOutcomes.clear();
}

void CullWatch::replace(const osg::NodePath& path, CollectedGraph& graph, const LeafUses& uses)
{
    const auto isIn = [&path](const Watched& watched)
    {
        const osg::NodePath& at = watched.outcome.path;
        return at.size() >= path.size() && std::equal(path.begin(), path.end(), at.begin());
    };
    auto at = std::find_if(_watched.begin(), _watched.end(), isIn);
    const auto index = at - _watched.begin();
    _watched.erase(std::remove_if(at, _watched.end(), isIn), _watched.end());
    std::vector<Watched> fresh;
    for (CullOutcome& outcome : graph.cullOutcomes)
        fresh.push_back(watchedOf(outcome, uses));
    graph.cullOutcomes.clear();
    _watched.insert(_watched.begin() + index, std::make_move_iterator(fresh.begin()),
                    std::make_move_iterator(fresh.end()));
    _captured.clear();
    for (const Watched& watched : _watched)
        if (watched.outcome.kind == CullOutcome::Captured)
            _captured.insert(watched.outcome.path.back());
    _next = 0;
    _plainAbove = nullptr;
}

void CullWatch::renumber(const osg::Geometry& geometry, const std::vector<uint32_t>& gone,
                         uint32_t left)
{
    for (Watched& watched : _watched)
        for (WatchedLeaf& leaf : watched.values)
        {
            if (leaf.use.geometry != &geometry) continue;
            const auto before = std::lower_bound(gone.begin(), gone.end(), leaf.use.use);
            leaf.use.use -= static_cast<uint32_t>(before - gone.begin());
            leaf.use.uses = left;
        }
}

/// Finds what differs in a leaf. Returns false if the graph must be converted.
bool CullWatch::compare(CulledLeaf& before, WatchedLeaf& values, const CulledLeaf& now,
                        double eyeDistance, CullChanges& changes) const
{
    if (now.drawable != before.drawable || now.proxy != before.proxy) return false;
    if (now.proxy && !values.use.geometry) return true; // it encloses the scene
    if (!sameStates(before, values, now)) return false;
    if (!sameMatrix(now.worldFromLocal, before.worldFromLocal, eyeDistance))
    {
        if (values.use.geometry)
            changes.moved.push_back({values.use, now.worldFromLocal});
        else if (showsAnything(before.worldFromLocal) || showsAnything(now.worldFromLocal))
            return false;
        before.worldFromLocal = now.worldFromLocal;
    }
    const uint64_t content = hashOf(*now.drawable);
    if (content == values.content) return true;
    values.content = content;
    // Other geometries than the drawable itself are made in conversions alone.
    if (values.use.geometry != now.drawable || attributesHash(*now.drawable) != values.attributes)
        return false;
    changes.deformed.push_back(values.use.geometry);
    return true;
}

/// Finds what differs in the leaves of a subtree. Returns false if the graph must be converted.
bool CullWatch::compare(Watched& before, CullOutcome& now, double eyeDistance,
                        CullChanges& changes) const
{
    if (now.kind != before.outcome.kind || now.isDrawn() != before.drawn) return false;
    CullSplice splice;
    splice.path = before.outcome.path;
    std::map<std::string, int64_t> left = leftOf(now.leaves);
    if (left != before.left)
    {
        splice.countsMore = left;
        for (const auto& [reason, count] : before.left)
            splice.countsMore[reason] -= count;
        before.left = std::move(left);
    }
    if (!sameDrawables(before.leaves, now.leaves))
    {
        if (!spliceLeaves(before, now, eyeDistance, changes, splice)) return false;
    }
    else
    {
        std::size_t count = 0;
        for (const CulledLeaf& leaf : now.leaves)
        {
            if (!leaf.isInScene()) continue;
            if (!compare(before.leaves[count], before.values[count], leaf, eyeDistance, changes))
                return false;
            ++count;
        }
    }
    if (splice.removed.empty() && splice.added.empty() && splice.countsMore.empty()) return true;
    for (const CulledLeaf& leaf : now.leaves)
        if (leaf.left && !leaf.proxy && !leaf.made && leaf.drawable->asGeometry())
            splice.left.push_back(leaf.drawable->asGeometry());
    changes.splices.push_back(std::move(splice));
    return true;
}

/// Finds which proxies of a subtree came and went, and what differs in the other leaves. Returns
/// false if the graph must be converted: something that is traced came or went, a drawable has
/// several leaves, or the order is another one.
bool CullWatch::spliceLeaves(Watched& before, const CullOutcome& now, double eyeDistance,
                             CullChanges& changes, CullSplice& splice) const
{
    std::unordered_map<const osg::Drawable*, std::size_t> indexOf;
    for (std::size_t i = 0; i < before.leaves.size(); ++i)
        if (!indexOf.try_emplace(before.leaves[i].drawable, i).second) return false;
    std::unordered_set<const osg::Drawable*> seen;
    std::vector<CulledLeaf> leaves;
    std::vector<WatchedLeaf> values;
    std::size_t next = 0;
    for (const CulledLeaf& leaf : now.leaves)
    {
        if (!leaf.isInScene()) continue;
        if (!seen.insert(leaf.drawable).second) return false;
        const auto found = indexOf.find(leaf.drawable);
        if (found == indexOf.end())
        {
            const osg::Geometry* geometry = leaf.drawable->asGeometry();
            if (!leaf.proxy || leaf.made || !geometry) return false;
            splice.added.push_back(leaf);
            leaves.push_back(leaf);
            values.push_back(valuesOf(leaf));
            values.back().use = {geometry, 0, 1};
            continue;
        }
        if (found->second < next) return false;
        next = found->second + 1;
        CulledLeaf& then = before.leaves[found->second];
        WatchedLeaf& thenValues = before.values[found->second];
        if (!compare(then, thenValues, leaf, eyeDistance, changes)) return false;
        leaves.push_back(then);
        values.push_back(std::move(thenValues));
    }
    for (std::size_t i = 0; i < before.leaves.size(); ++i)
    {
        CulledLeaf& leaf = before.leaves[i];
        if (seen.count(leaf.drawable)) continue;
        const ChangedUse& use = before.values[i].use;
        if (!leaf.proxy || (use.geometry && use.uses != 1)) return false;
        if (use.geometry) splice.removed.push_back(use);
        splice.gone.push_back(std::move(leaf));
    }
    before.leaves = std::move(leaves);
    before.values = std::move(values);
    return true;
}

CullChanges CullWatch::look(const ConversionInput& input, const Caches& caches)
{
    CullChanges changes;
    if (!input.pass || !input.view) return changes;
    changes.holds = !_unknown;
    if (_unknown) return changes;
    CullRepetition repetition(input);
    _credit += kDrawablesALook;
    for (std::size_t count = 0; count < _watched.size(); ++count)
    {
        Watched& watched = _watched[_next];
        const std::size_t cost = kDrawablesASubtree + watched.captured;
        changes.complete = cost <= _credit;
        if (!changes.complete) return changes;
        changes.holds = lookAt(watched, repetition, input, caches, changes);
        if (!changes.holds) return changes;
        _credit -= cost;
        _next = (_next + 1) % _watched.size();
        if (_next > 0) continue;
        _plainAbove = nullptr;
        ++_rounds;
    }
    _credit = 0;
    return changes;
}

/// Returns false if the graph must be converted.
bool CullWatch::lookAt(Watched& watched, CullRepetition& repetition, const ConversionInput& input,
                       const Caches& caches, CullChanges& changes)
{
    CullOutcome& then = watched.outcome;
    if (then.kind == CullOutcome::Left || isInPlain(then)) return true;
    const auto sameState = [this](const osg::StateSet& before, const osg::StateSet& now)
    { return hashOf(before) == hashOf(now) || before.compare(now, true) == 0; };
    const bool plain = then.kind == CullOutcome::Plain;
    CullRecord seen;
    CullRecord& record = plain ? seen : then.record;
    const std::optional<bool> repeats = repetition.repeats(then.path, record, sameState);
    if (!repeats) return false;
    if (plain && _rounds % kRoundsByDrawables != 0 && record.signature() == watched.signature)
    {
        _plainAbove = &then;
        return true;
    }
    const uint64_t content = plain ? 0 : contentOf(then);
    if (*repeats && content == watched.content) return true;
    ConversionReport unused;
    GraphCollector collector(input, caches.vertices, caches.triangles, caches.textures,
                             caches.rules, unused);
    std::optional<CullOutcome> now = collector.cullOutcomeAt(then.path, record, then.answers);
    unused.setPlace({});
    unused.setListener({});
    if (!now) return false;
    const std::size_t moved = changes.moved.size(), deformed = changes.deformed.size();
    if (!compare(watched, *now, input.eye.length(), changes))
    {
        changes.moved.resize(moved);
        changes.deformed.resize(deformed);
        changes.others.push_back(then.path);
        return true;
    }
    watched.signature = record.signature();
    watched.captured = record.size();
    watched.content = content;
    return true;
}

/// Returns whether an outcome is plain below a plain one whose drawables are as they were.
bool CullWatch::isInPlain(const CullOutcome& outcome) const
{
    return _plainAbove && outcome.kind == CullOutcome::Plain &&
           outcome.path.size() > _plainAbove->path.size() &&
           std::equal(_plainAbove->path.begin(), _plainAbove->path.end(), outcome.path.begin());
}

bool CullWatch::covers(const osg::NodePath& path) const
{
    return std::any_of(_watched.begin(), _watched.end(),
                       [&path](const Watched& watched)
                       {
                           const CullOutcome& outcome = watched.outcome;
                           return outcome.kind != CullOutcome::Plain &&
                                  std::find(path.begin(), path.end(), outcome.path.back()) !=
                                      path.end();
                       });
}

} // namespace osgRayTrace::engine
