// CullCollection.cpp - collects what exists in a cull traversal only. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/Hasher.h"
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

uint64_t signatureOf(const std::vector<CapturedLeaf>& leaves)
{
    Hasher hasher;
    for (const CapturedLeaf& leaf : leaves)
    {
        hasher.addData(leaf.drawable.get());
        for (const osg::ref_ptr<const osg::StateSet>& stateSet : leaf.states)
            hasher.addData(stateSet.get());
    }
    return hasher.value();
}

/// Returns whether each leaf has another one of the same drawable in the same place: OpenGL then
/// draws it in several passes.
std::vector<bool> inSeveralPasses(const std::vector<CapturedLeaf>& leaves)
{
    std::vector<bool> several(leaves.size());
    std::unordered_map<uint64_t, std::size_t> firstOf;
    for (std::size_t i = 0; i < leaves.size(); ++i)
    {
        Hasher hasher;
        hasher.addData(leaves[i].drawable.get());
        hasher.addMatrix(leaves[i].worldFromLocal);
        const auto [first, isFirst] = firstOf.try_emplace(hasher.value(), i);
        if (!isFirst) several[i] = several[first->second] = true;
    }
    return several;
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
    CullOutcome outcome;
    outcome.path = getNodePath();
    constexpr std::size_t kAbove = 2;
    for (std::size_t i = kAbove; i < outcome.path.size(); ++i)
        outcome.kept.push_back(outcome.path[i]);
    outcome.kind = CullOutcome::Left;
    if (!_input.pass->isClone) return outcome;

    const CullCapture capture(*_input.pass, *_input.view, _input.traversalMask);
    CapturedContent culled = capture.node(outcome.path, _worldFromLocal.back());
    outcome.error = culled.error;
    if (!outcome.error.empty()) return outcome;
    outcome.captured = culled.leaves.size();
    outcome.signature = signatureOf(culled.leaves);
    if (const osg::Drawable* drawable = outcome.path.back()->asDrawable())
    {
        outcome.kind = takesChosen(*drawable, culled, outcome);
        return outcome;
    }
    // A transform may ask the cull visitor for its eye, as those of skies do.
    const osg::Transform* transform = outcome.path.back()->asTransform();
    const osg::Matrixd& outer = _worldFromLocal.back();
    const CapturedContent walked = capture.below(
        outcome.path, transform ? worldFromLocal(*transform, outer, *this, _input.view) : outer);
    if (walked.error.empty() && finds(walked.leaves, culled.leaves))
    {
        outcome.kind = CullOutcome::Plain;
        return outcome;
    }
    outcome.kind = CullOutcome::Captured;
    outcome.otherStages = culled.otherStages;
    const std::vector<bool> several = inSeveralPasses(culled.leaves);
    for (std::size_t i = 0; i < culled.leaves.size(); ++i)
    {
        CapturedLeaf& leaf = culled.leaves[i];
        const char* reason = several[i] ? "rasterized.several-passes" : leftReason(leaf);
        if (reason)
            outcome.left.push_back({leaf.drawable, reason});
        else
            outcome.traced.push_back(std::move(leaf));
    }
    return outcome;
}

/// Decides what becomes of a drawable that may draw others in its place, as rigs of applications
/// do. Left: it draws itself. Plain: it draws others, or nothing, and they cannot be traced. In
/// both cases OSG draws it like any drawable that is not known. What is chosen is asked for by its
/// copy, which stays the same object from frame to frame.
CullOutcome::Kind GraphCollector::takesChosen(const osg::Drawable& drawable,
                                              const CapturedContent& culled, CullOutcome& outcome)
{
    for (const CapturedLeaf& leaf : culled.leaves)
        if (leaf.drawable == &drawable) return CullOutcome::Left;
    if (culled.leaves.empty() || culled.otherStages) return CullOutcome::Plain;
    std::vector<CapturedLeaf> traced;
    for (std::size_t i = 0; i < culled.leaves.size(); ++i)
    {
        CapturedLeaf leaf = culled.leaves[i];
        const osg::Geometry* geometry = leaf.drawable->asGeometry();
        if (!geometry) return CullOutcome::Plain;
        leaf.drawable = &_triangles.chosen(drawable, i, *geometry);
        if (leftReason(leaf)) return CullOutcome::Plain;
        traced.push_back(std::move(leaf));
    }
    outcome.traced = std::move(traced);
    return CullOutcome::Captured;
}

std::optional<CullOutcome> GraphCollector::cullOutcomeAt(const osg::NodePath& path,
                                                         HookAnswers& answers)
{
    if (!_input.pass || !_input.view || !descendTo(path)) return std::nullopt;
    pushOntoNodePath(path.back());
    _materials.repeatAnswers(answers);
    CullOutcome outcome = cullOutcome();
    if (_materials.lacksAnswers()) return std::nullopt;
    return outcome;
}

std::optional<uint64_t> GraphCollector::cullSignatureAt(const osg::NodePath& path)
{
    if (!_input.pass || !_input.view || !descendTo(path)) return std::nullopt;
    pushOntoNodePath(path.back());
    const CullCapture capture(*_input.pass, *_input.view, _input.traversalMask);
    const CapturedContent culled = capture.node(getNodePath(), _worldFromLocal.back());
    if (!culled.error.empty()) return std::nullopt;
    return signatureOf(culled.leaves);
}

/// Traverses what is below a node, with the node's state and transform.
void GraphCollector::walkBelow(osg::Node& node)
{
    const bool pushed = pushState(node);
    if (const osg::Transform* transform = node.asTransform())
        traverseBelow(worldFromLocal(*transform, _worldFromLocal.back(), *this, _input.view), node);
    else
        traverseChildren(node);
    if (pushed) _states.pop();
}

/// Returns true if the node was collected with all below it: OSG draws all of it by a hint, or its
/// own cull traversal has told what it shows.
bool GraphCollector::collectsInCull(osg::Node& node)
{
    if (_lightsOnly || _isLeft || _leftToOsg > 0 || &node == _input.root) return false;
    const bool someSee = isForSomeViews(node) && (node.asGroup() || cullReason(node));
    if (someSee || (_input.rasterizesRest && node.getUserDataContainer() && node.asGroup() &&
                    leavesToOsg(hintOf(getNodePath())) && isHintedAlike(node)))
    {
        rasterize();
        if (!node.asGroup())
        {
            _report.count("rasterized.view-mask");
            return true;
        }
        _isLeft = true;
        walkBelow(node);
        _isLeft = false;
        return true;
    }
    const char* reason = cullReason(node);
    if (!reason || hintOf(getNodePath()) == DrawHint::Trace) return false;
    if (!_input.pass || !_input.view)
    {
        _report.count("approximated.cull-traversal");
        _graph.cullUnknown = true;
        return false;
    }
    // A cull traversal of so many paths would not end, with this library or without.
    if (_counts.of(node, kMostPaths, kDeepestPath) > kMostPaths) return false;
    HookAnswers answers;
    _materials.keepAnswers(&answers);
    CullOutcome outcome = cullOutcome();
    const bool collected = outcome.kind != CullOutcome::Plain;
    if (collected) collectCulled(node, outcome, reason);
    _materials.keepAnswers(nullptr);
    outcome.answers = std::move(answers);
    _graph.cullOutcomes.push_back(std::move(outcome));
    return collected;
}

/// Returns true if a drawable of the application's was collected by what it chooses in cull.
bool GraphCollector::collectsChosen(osg::Drawable& drawable)
{
    if (!_input.rasterizesRest || !_input.pass || !_input.view || _isLeft || _leftToOsg > 0 ||
        leavesToOsg(hintOf(getNodePath())) || isForSomeViews(drawable))
        return false;
    const char* reason = cullReason(drawable);
    if (!reason) return false;
    HookAnswers answers;
    _materials.keepAnswers(&answers);
    CullOutcome outcome = cullOutcome();
    const bool collected = outcome.kind == CullOutcome::Captured;
    if (collected) collectCulled(drawable, outcome, reason);
    _materials.keepAnswers(nullptr);
    outcome.answers = std::move(answers);
    if (outcome.kind != CullOutcome::Left) _graph.cullOutcomes.push_back(std::move(outcome));
    return collected;
}

/// Collects a node by the leaves of its cull traversal.
void GraphCollector::collectCulled(osg::Node& node, const CullOutcome& outcome, const char* reason)
{
    if (!outcome.error.empty())
        _report.warn("warned.cull-exception", "node '" + path() + "'",
                     "has thrown an exception in a cull traversal, left to OSG: " + outcome.error);
    _lightsOnly = true;
    walkBelow(node);
    _lightsOnly = false;
    if (outcome.isDrawn())
    {
        _report.count(reason);
        rasterize();
        if (_graph.rasterized.size() > 0) _graph.rasterized.back().traced = tracedLeaves(outcome);
    }
    else
        rasterize(RasterizedPart::Pick);
    for (const CullOutcome::LeftLeaf& leaf : outcome.left)
    {
        pushOntoNodePath(leaf.drawable.get());
        _report.count(leaf.reason);
        popFromNodePath();
        if (const osg::Geometry* geometry = leaf.drawable->asGeometry())
            _graph.leftGeometries.push_back(geometry);
    }
    ++_untracked;
    _isCaptured = true;
    for (const CapturedLeaf& leaf : outcome.traced)
    {
        if (!pushMatrix(leaf.worldFromLocal)) continue;
        const std::size_t pushed = pushStates(leaf);
        pushOntoNodePath(leaf.drawable.get());
        _report.count("converted.culled");
        apply(*leaf.drawable->asGeometry());
        popFromNodePath();
        popStates(pushed);
        _worldFromLocal.pop_back();
    }
    _isCaptured = false;
    --_untracked;
}

osg::ref_ptr<TracedLeaves> GraphCollector::tracedLeaves(const CullOutcome& outcome)
{
    if (outcome.traced.empty()) return nullptr;
    osg::ref_ptr<TracedLeaves> traced = new TracedLeaves;
    for (const CapturedLeaf& leaf : outcome.traced)
        if (traced->drawables.insert(leaf.drawable.get()).second)
            traced->kept.push_back(leaf.drawable);
    return traced;
}

} // namespace osgRayTrace::engine
