// CullWatch.cpp - compares the leaves of cull traversals with what they were. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/CullWatch.h"

#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/bridge/changes/StateHash.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

constexpr std::size_t kDrawablesALook = 1000;
/// The setup of a traversal takes as long as so many drawables.
constexpr std::size_t kDrawablesASubtree = 4;
/// In one of so many rounds, places are compared where nothing was added, not only drawables.
constexpr std::size_t kRoundsByDrawables = 16;

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

/// Returns whether a state set has the values that another one had when it was converted. Callbacks
/// may take turns with two state sets of the same values.
bool CullWatch::sameValues(const osg::StateSet& before, uint64_t hashBefore,
                           const osg::StateSet& now) const
{
    if (hashOf(before) != hashBefore) return false;
    return &before == &now || before.compare(now, true) == 0;
}

CullWatch::LeafValues CullWatch::valuesOf(const CapturedLeaf& leaf) const
{
    LeafValues values;
    for (const osg::ref_ptr<const osg::StateSet>& stateSet : leaf.states)
        values.states.push_back(hashOf(*stateSet));
    values.content = hashOf(*leaf.drawable);
    return values;
}

void CullWatch::record(std::vector<CullOutcome> outcomes, bool unknown,
                       std::shared_ptr<const ShaderReads> reads)
{
    _plain.reads = std::move(reads);
    _watched.clear();
    _unknown = unknown;
    _next = _credit = 0;
    _plainAbove = nullptr;
    for (CullOutcome& outcome : outcomes)
    {
        Watched& watched = _watched.emplace_back();
        for (const CapturedLeaf& leaf : outcome.traced)
            watched.values.push_back(valuesOf(leaf));
        watched.outcome = std::move(outcome);
    }
}

bool CullWatch::isSame(const Watched& before, const CullOutcome& now, double eyeDistance) const
{
    const CullOutcome& then = before.outcome;
    if (now.kind != then.kind || now.isDrawn() != then.isDrawn() ||
        now.traced.size() != then.traced.size())
        return false;
    for (std::size_t i = 0; i < now.traced.size(); ++i)
    {
        const CapturedLeaf &leaf = now.traced[i], &last = then.traced[i];
        const LeafValues& values = before.values[i];
        if (leaf.drawable != last.drawable || leaf.states.size() != last.states.size() ||
            !sameMatrix(leaf.worldFromLocal, last.worldFromLocal, eyeDistance) ||
            hashOf(*leaf.drawable) != values.content)
            return false;
        for (std::size_t s = 0; s < leaf.states.size(); ++s)
            if (!sameValues(*last.states[s], values.states[s], *leaf.states[s])) return false;
    }
    return true;
}

bool CullWatch::holds(const ConversionInput& input, const Caches& caches)
{
    if (!input.pass || !input.view) return true;
    if (_unknown) return false;
    _credit += kDrawablesALook;
    for (std::size_t count = 0; count < _watched.size(); ++count)
    {
        Watched& watched = _watched[_next];
        const std::size_t cost = kDrawablesASubtree + watched.outcome.captured;
        if (cost > _credit) return true;
        if (!holds(watched, input, caches)) return false;
        _credit -= cost;
        _next = (_next + 1) % _watched.size();
        if (_next > 0) continue;
        _plainAbove = nullptr;
        ++_rounds;
    }
    _credit = 0;
    return true;
}

bool CullWatch::holds(Watched& watched, const ConversionInput& input, const Caches& caches)
{
    const CullOutcome& then = watched.outcome;
    if (then.kind == CullOutcome::Left || isInPlain(then)) return true;
    ConversionReport unused;
    if (then.kind == CullOutcome::Plain && _rounds % kRoundsByDrawables != 0)
    {
        GraphCollector collector(input, caches.vertices, caches.triangles, caches.textures,
                                 caches.rules, unused);
        const std::optional<uint64_t> signature = collector.cullSignatureAt(then.path);
        unused.setPlace({});
        if (signature == then.signature)
        {
            _plainAbove = &then;
            return true;
        }
    }
    GraphCollector collector(input, caches.vertices, caches.triangles, caches.textures,
                             caches.rules, unused);
    const std::optional<CullOutcome> now =
        collector.cullOutcomeAt(then.path, watched.outcome.answers);
    unused.setPlace({});
    if (!now || !isSame(watched, *now, input.eye.length())) return false;
    watched.outcome.signature = now->signature;
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
