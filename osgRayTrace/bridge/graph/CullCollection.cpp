// CullCollection.cpp - collects what exists in a cull traversal only. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/Hasher.h"
#include "osgRayTrace/bridge/graph/CullCapture.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"

#include <osg/Transform>

#include <algorithm>
#include <unordered_map>

namespace osgRayTrace::engine
{

namespace
{

bool sameState(const GraphState& a, const GraphState& b)
{
    const bool sameLights = a.moreLights == b.moreLights ||
                            (a.moreLights && b.moreLights && *a.moreLights == *b.moreLights);
    return sameLights && a.modesOn == b.modesOn && a.modesOverride == b.modesOverride &&
           a.attributes == b.attributes && a.attributesOverride == b.attributesOverride &&
           a.generated == b.generated && a.generatedOverride == b.generatedOverride;
}

/// Returns whether a state set has a light. Lights of the graph are nodes; the place of another one
/// follows from what is drawn first with it.
bool hasLight(const osg::StateSet& stateSet)
{
    for (const auto& [type, pair] : stateSet.getAttributeList())
        if (type.first == osg::StateAttribute::LIGHT) return true;
    return false;
}

bool sameLeaf(const CapturedLeaf& a, const CapturedLeaf& b, double eyeDistance)
{
    return a.drawable == b.drawable && sameMatrix(a.worldFromLocal, b.worldFromLocal, eyeDistance);
}

/// Returns whether state sets are equal, with all that is not followed. A callback may make new
/// ones in each traversal.
bool sameStateSets(const std::vector<osg::ref_ptr<const osg::StateSet>>& a,
                   const std::vector<osg::ref_ptr<const osg::StateSet>>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const auto& one, const auto& other)
                      { return one == other || one->compare(*other, true) == 0; });
}

/// Tells which of OpenGL's passes over a drawable in one place a leaf is.
enum class Pass : uint8_t
{
    Only,
    First,
    Later,
};

std::vector<Pass> passesOf(const std::vector<CapturedLeaf>& leaves)
{
    std::vector<Pass> passes(leaves.size(), Pass::Only);
    std::unordered_map<uint64_t, std::size_t> firstOf;
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
        Hasher hasher;
        hasher.addData(leaves[i].drawable.get());
        hasher.addMatrix(leaves[i].worldFromLocal);
        const auto [first, isFirst] = firstOf.try_emplace(hasher.value(), i);
        if (isFirst) continue;
        passes[first->second] = Pass::First;
        passes[i] = Pass::Later;
    }
    return passes;
}

} // namespace

/// Pushes the state sets of a leaf but for the drawable's own. Returns their number.
std::size_t GraphCollector::pushStates(const CapturedLeaf& leaf)
{
    std::size_t count = leaf.states.size();
    const osg::StateSet* own = leaf.drawable->getStateSet();
    if (count > 0 && own && leaf.states.back() == own) --count;
    for (std::size_t i = 0; i < count; ++i)
        _states.push(*leaf.states[i]);
    return count;
}

void GraphCollector::popStates(std::size_t count)
{
    for (; count > 0; --count)
        _states.pop();
}

/// Returns why OSG draws a leaf of a cull traversal; null: the leaf is traced.
const char* GraphCollector::leftReason(const CapturedLeaf& leaf)
{
    if (leaf.isProjected) return "not-traced.projection";
    const osg::Geometry* geometry = leaf.drawable->asGeometry();
    if (!geometry)
    {
        const char* reason = untracedDrawable(*leaf.drawable);
        return reason ? reason : "not-traced.custom-drawable";
    }
    const bool lit = std::any_of(leaf.states.begin(), leaf.states.end(),
                                 [](const auto& stateSet) { return hasLight(*stateSet); });
    if (lit) return "rasterized.pushed-light";
    if (untracedSets(*geometry, _input.pointRadius)) return "rasterized.mixed-primitives";
    const std::size_t pushed = pushStates(leaf);
    pushOntoNodePath(leaf.drawable.get());
    const char* reason = rasterizedReason(*geometry, false, assignedState(*geometry).state);
    popFromNodePath();
    popStates(pushed);
    return reason;
}

/// Returns the state of a leaf as far as it is followed.
GraphState GraphCollector::stateOf(const CapturedLeaf& leaf)
{
    for (const auto& stateSet : leaf.states)
        _states.push(*stateSet);
    const GraphState state = _states.states()[_states.top()];
    popStates(leaf.states.size());
    return state;
}

/// Returns whether the walk of the collector finds all leaves of a cull traversal, in their order
/// and with their state. The cull traversal may leave some out: what only hides, hides nothing.
bool GraphCollector::finds(const std::vector<CapturedLeaf>& walked,
                           const std::vector<CapturedLeaf>& culled)
{
    const auto isSame = [this](const CapturedLeaf& a, const CapturedLeaf& b)
    {
        if (!sameLeaf(a, b, _input.eye.length())) return false;
        if (sameStateSets(a.states, b.states)) return true;
        // What OSG draws may need uniforms, which are not followed.
        return !leftReason(b) && sameState(stateOf(a), stateOf(b));
    };
    auto next = walked.begin();
    for (const CapturedLeaf& leaf : culled)
    {
        while (next != walked.end() && !isSame(*next, leaf))
            ++next;
        if (next == walked.end()) return false;
        ++next;
    }
    return true;
}

/// Decides what becomes of the last node of the node path.
CullOutcome GraphCollector::cullOutcome()
{
    CullRecord record;
    if (_input.pass->isClone)
        CullCapture(*_input.pass, *_input.view, _input.traversalMask)
            .node(getNodePath(), _worldFromLocal.back(), record);
    CullOutcome outcome = cullOutcome(record);
    outcome.record = std::move(record);
    return outcome;
}

/// Decides what becomes of the last node of the node path, of which a cull traversal has shown
/// this.
CullOutcome GraphCollector::cullOutcome(const CullRecord& record)
{
    CullOutcome outcome;
    outcome.path = getNodePath();
    constexpr std::size_t kAbove = 2;
    for (std::size_t i = kAbove; i < outcome.path.size(); ++i)
        outcome.kept.push_back(outcome.path[i]);
    outcome.kind = CullOutcome::Left;
    if (!_input.pass->isClone || !record.error().empty()) return outcome;

    std::vector<CapturedLeaf> culled = record.leaves();
    if (const osg::Drawable* drawable = outcome.path.back()->asDrawable())
    {
        outcome.kind = takesChosen(*drawable, culled, record.otherStages(), outcome);
        return outcome;
    }
    // A transform may ask the cull visitor for its eye, as those of skies do.
    const osg::Transform* transform = outcome.path.back()->asTransform();
    const osg::Matrixd& outer = _worldFromLocal.back();
    CullCapture capture(*_input.pass, *_input.view, _input.traversalMask);
    const CullRecord walked =
        capture.below(outcome.path, transform ? worldBelow(*transform) : outer);
    if (walked.error().empty() && finds(walked.leaves(), culled))
    {
        outcome.kind = CullOutcome::Plain;
        return outcome;
    }
    outcome.kind = CullOutcome::Captured;
    outcome.otherStages = record.otherStages();
    decideOnLeaves(culled, outcome);
    return outcome;
}

/// Decides which leaves of a cull traversal are traced, and which have proxies.
void GraphCollector::decideOnLeaves(std::vector<CapturedLeaf>& leaves, CullOutcome& outcome)
{
    const std::vector<Pass> passes = passesOf(leaves);
    const char* leftMade = nullptr; // why OSG draws one of the leaves that are of no node
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
        CulledLeaf& leaf = outcome.leaves.emplace_back();
        static_cast<CapturedLeaf&>(leaf) = std::move(leaves[i]);
        const osg::Geometry* geometry = leaf.drawable->asGeometry();
        leaf.made = geometry && geometry->getNumParents() == 0;
        if (leaf.made) leaf.drawable = &_triangles.chosen(*outcome.path.back(), i, *geometry);
        leaf.left = passes[i] != Pass::Only ? "rasterized.several-passes" : leftReason(leaf);
        if (leaf.made && leaf.left) leftMade = leaf.left;
    }
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
        CulledLeaf& leaf = outcome.leaves[i];
        // RasterizedParts cannot tell those that are traced from the others.
        if (leaf.made && leftMade) leaf.left = leftMade;
        leaf.proxy = leaf.left && passes[i] != Pass::Later && isProxied(leaf);
    }
}

/// Decides what becomes of a drawable that may draw others in its place, as rigs of applications
/// do. Left: it draws itself. Plain: it draws others, or nothing, and they cannot be traced. In
/// both cases OSG draws it like any drawable that is not known. What is chosen is asked for by its
/// copy, which stays the same object from frame to frame.
CullOutcome::Kind GraphCollector::takesChosen(const osg::Drawable& drawable,
                                              const std::vector<CapturedLeaf>& culled,
                                              bool otherStages, CullOutcome& outcome)
{
    for (const CapturedLeaf& leaf : culled)
        if (leaf.drawable == &drawable) return CullOutcome::Left;
    if (culled.empty() || otherStages) return CullOutcome::Plain;
    std::vector<CulledLeaf> leaves;
    for (std::size_t i = 0; i < culled.size(); ++i)
    {
        CulledLeaf& leaf = leaves.emplace_back();
        static_cast<CapturedLeaf&>(leaf) = culled[i];
        const osg::Geometry* geometry = leaf.drawable->asGeometry();
        if (!geometry) return CullOutcome::Plain;
        leaf.made = true;
        leaf.drawable = &_triangles.chosen(drawable, i, *geometry);
        if (leftReason(leaf)) return CullOutcome::Plain;
    }
    outcome.leaves = std::move(leaves);
    return CullOutcome::Captured;
}

std::optional<CullOutcome> GraphCollector::cullOutcomeAt(const osg::NodePath& path,
                                                         const CullRecord& record,
                                                         HookAnswers& answers)
{
    if (!descendTo(path)) return std::nullopt;
    pushOntoNodePath(path.back());
    _materials.repeatAnswers(answers);
    CullOutcome outcome = cullOutcome(record);
    if (_materials.lacksAnswers()) return std::nullopt;
    return outcome;
}

} // namespace osgRayTrace::engine
