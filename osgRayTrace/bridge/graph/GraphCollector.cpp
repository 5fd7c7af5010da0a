// GraphCollector.cpp - traverses the scene graph with its transforms and states. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/GraphCollector.h"

#include "osgRayTrace/bridge/common/ClipPlanes.h"
#include "osgRayTrace/bridge/common/LibraryName.h"
#include "osgRayTrace/bridge/common/NodeKind.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"
#include "osgRayTrace/bridge/graph/StatesAbove.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"

#include <osg/Billboard>
#include <osg/Camera>
#include <osg/ClearNode>
#include <osg/ClipNode>
#include <osg/PagedLOD>
#include <osg/Projection>
#include <osg/ProxyNode>
#include <osg/TexGenNode>
#include <osg/Transform>

namespace osgRayTrace::engine
{

GraphCollector::GraphCollector(const ConversionInput& input, SoftwareVertices& vertices,
                               DrawableTriangles& triangles, const TextureConverter& textures,
                               RuleCaches& rules, ConversionReport& report)
    : PlacedVisitor(input),
      _vertices(vertices),
      _triangles(triangles),
      _textures(textures),
      _report(report),
      _states(statesAbove(input)),
      _rules(rules),
      _materials({input.materials, input.hook, input.inheritedState}, rules.textures)
{
    _report.setPlace([this] { return path(); });
    _report.setListener(
        [this](const std::string& what, uint64_t number)
        {
            const uint32_t in = subtree();
            if (in != kNoSubtree) _graph.subtrees[in].counts[what] += number;
        });
}

/// Moves below all nodes of a path but the last. Returns false if one of them places nothing.
bool GraphCollector::descendTo(const osg::NodePath& path)
{
    for (auto node = path.begin(); node + 1 != path.end(); ++node)
    {
        pushOntoNodePath(*node);
        pushState(**node);
        const osg::Transform* transform = (*node)->asTransform();
        if (transform && !pushMatrix(worldBelow(*transform))) return false;
    }
    return true;
}

bool GraphCollector::collectAt(const osg::NodePath& path)
{
    if (!descendTo(path)) return false;
    path.back()->accept(*this);
    return true;
}

CollectedGraph GraphCollector::take()
{
    _graph.states = _states.states();
    recordCuttingPlanes();
    _report.setPlace({});
    _report.setListener({});
    _materials.reportRules(_report);
    return std::move(_graph);
}

void GraphCollector::apply(osg::Node& node)
{
    if (collectsInCull(node) || (node.asGroup() ? leavesGroup(node) : collectLeaf(node))) return;
    const bool pushed = pushState(node);
    traverseChildren(node);
    if (pushed) _states.pop();
}

void GraphCollector::apply(osg::Transform& node)
{
    if (collectsInCull(node)) return;
    const bool pushed = pushState(node);
    if (node.getReferenceFrame() != osg::Transform::RELATIVE_RF && !_input.view)
        _report.count("approximated.absolute-transform"); // OpenGL has eye space, this world space
    traverseBelow(worldBelow(node), node);
    if (pushed) _states.pop();
}

void GraphCollector::apply(osg::Camera& node)
{
    if (&node == _input.root)
    {
        apply(static_cast<osg::Node&>(node)); // the viewer's camera has the matrices of the view
        return;
    }
    if (const char* reason = untracedCamera(node))
    {
        if (_lightsOnly) return;
        _report.count(reason);
        warnIfForced("a camera of its own");
        rasterize();
        return;
    }
    apply(static_cast<osg::Transform&>(node));
}

void GraphCollector::apply(osg::Projection&)
{
    if (_lightsOnly) return;
    _report.count("not-traced.projection");
    warnIfForced("a projection of its own");
    rasterize();
}

void GraphCollector::apply(osg::LightSource& node)
{
    if (node.getLight())
    {
        recordSpecial();
        const bool eyeSpace = node.getReferenceFrame() == osg::LightSource::ABSOLUTE_RF;
        _graph.lights.lights.push_back(
            {&node, eyeSpace ? osg::Matrixd() : engineFromLocal(), eyeSpace, path()});
        rasterize(RasterizedPart::PlaceState);
    }
    apply(static_cast<osg::Node&>(node));
}

/// Keeps the clear colour if OSG draws the background, so that mirrors show the same background.
void GraphCollector::apply(osg::ClearNode& node)
{
    recordSpecial();
    if (_input.rasterizesRest && node.getRequiresClear()) _graph.clearColor = node.getClearColor();
    rasterize(RasterizedPart::Clear);
    apply(static_cast<osg::Node&>(node));
}

void GraphCollector::apply(osg::ClipNode& node)
{
    recordPlanes(planeNumbers(node));
    if (const uint32_t in = subtree(); in != kNoSubtree) _graph.subtrees[in].special = true;
    rasterize(RasterizedPart::PlaceState);
    const bool inEyeSpace = node.getReferenceFrame() == osg::ClipNode::ABSOLUTE_RF;
    const osg::Matrixd engineFromPlane =
        inEyeSpace ? worldFromEye() * osg::Matrixd::translate(-_input.origin) : engineFromLocal();
    for (const osg::ref_ptr<osg::ClipPlane>& plane : node.getClipPlaneList())
        if (plane && !_graph.clipPlanes.set(*plane, engineFromPlane))
            _report.warn("skipped.clip-plane", "clip node '" + path() + "'",
                         "plane is not finite or has a number above 7, skipped");
    apply(static_cast<osg::Node&>(node));
}

void GraphCollector::apply(osg::PagedLOD& node)
{
    _graph.paged = true;
    apply(static_cast<osg::LOD&>(node));
}

void GraphCollector::apply(osg::ProxyNode& node)
{
    if (node.getNumFileNames() > node.getNumChildren()) _graph.paged = true;
    apply(static_cast<osg::Node&>(node));
}

void GraphCollector::apply(osg::TexGenNode& node)
{
    recordSpecial();
    const bool inScene = node.getReferenceFrame() == osg::TexGenNode::RELATIVE_RF;
    if (!inScene && !_input.view)
        _report.count("approximated.absolute-texgen"); // OpenGL has eye space, this world space
    const osg::Matrixd worldFromPlanes = inScene       ? _worldFromLocal.back()
                                         : _input.view ? worldFromEye()
                                                       : osg::Matrixd();
    if (node.getTexGen() && node.getTextureUnit() < kUnits)
        _graph.texGens[node.getTextureUnit()] = {
            node.getTexGen(), worldFromPlanes * osg::Matrixd::translate(-_input.origin)};
    rasterize(RasterizedPart::PlaceState);
    apply(static_cast<osg::Node&>(node));
}

void GraphCollector::apply(osg::Billboard& node)
{
    if (_lightsOnly) return;
    const bool pushed = pushState(node);
    const bool leaves = _leftToOsg > 0 || (_input.rasterizesRest && leavesDrawable(node));
    if (leaves && _leftToOsg == 0)
    {
        _report.count("rasterized.billboard");
        warnIfForced("a billboard with text, lines or the like");
        rasterize();
    }
    if (node.getMode() == osg::Billboard::POINT_ROT_EYE && !_input.view)
        _report.count("approximated.billboard"); // it is upright in the world, not in the view
    const osg::Vec3 eye = getEyePoint();
    const osg::Matrixd worldFromView = worldFromEye();
    const osg::Matrixd viewFromLocal =
        _worldFromLocal.back() * osg::Matrixd::inverse(worldFromView);
    // Since OSG 3.6 any child can be added, and a child that is no drawable has no position.
    const std::size_t positions = node.getPositionList().size();
    ++_untracked;
    _leftToOsg += leaves;
    for (unsigned int i = 0; i < node.getNumDrawables(); ++i)
    {
        const osg::ref_ptr<osg::Drawable> drawable = node.getDrawable(i);
        if (!drawable || i >= positions)
        {
            if (!leaves) _report.count("not-traced.billboard-child");
            continue;
        }
        osg::Matrixd viewFromDrawable = viewFromLocal;
        node.computeMatrix(viewFromDrawable, eye, node.getPosition(i));
        if (!pushMatrix(viewFromDrawable * worldFromView)) continue;
        drawable->accept(*this);
        _worldFromLocal.pop_back();
    }
    _leftToOsg -= leaves;
    --_untracked;
    if (pushed) _states.pop();
}

void GraphCollector::apply(osg::Geometry& geometry)
{
    if (_lightsOnly || isTooMuch(geometry) || leavesOut(geometry)) return;
    const osg::Geometry& posed = _vertices.posed(geometry, getNodePath());
    const bool isPosed = &posed != &geometry;
    const AssignedState assigned = assignedState(geometry);
    if (_leftToOsg > 0 || (_input.rasterizesRest && rasterizes(geometry, isPosed, assigned.state)))
    {
        const bool proxied = isProxied(geometry);
        recordLeft(geometry, assigned.state, proxied);
        if (proxied) collectUse(posed, assigned.state, true);
        return;
    }
    if (assigned.by) _report.countFor("traced.by-rule", "'" + *assigned.by + "'");
    if (!_input.rasterizesRest && leavesToOsg(hintOf(getNodePath())))
        _report.count("approximated.rasterize-hint"); // there is no rasterizer
    if (!isPosed && SoftwareVertices::isPosedByProgram(geometry))
        _report.count("approximated.hardware-pose"); // it is traced as it was bound
    if (geometry.getDrawCallback()) _report.count("approximated.draw-callback");
    const osg::Geometry& read =
        assigned.by ? _rules.layouts.laidOut(posed, assigned.attributes, assigned.unit) : posed;
    collectUse(read, assigned.state, false);
}

/// Adds a use of a geometry at the present place. A proxy has no path to pick: OSG's part has it.
void GraphCollector::collectUse(const osg::Geometry& geometry, uint32_t state, bool proxy)
{
    recordInScene();
    const PrimitiveRestart restart = restartOf(_states.states()[state]);
    const auto [found, isNew] =
        _indexOf.try_emplace({&geometry, restart.key()}, _graph.geometries.size());
    if (isNew)
        _graph.geometries.push_back({&geometry, path(), {}, restart, pointRadiusOf(geometry)});
    CollectedGeometry& collected = _graph.geometries[found->second];
    collected.watched &= _untracked == 0;
    collected.uses.push_back({engineFromLocal(), state, proxy ? NodeTree::kNone : pickPath(), proxy,
                              _culledLeaf, subtree()});
    _graph.hasProxies |= proxy;
}

void GraphCollector::traverseChildren(osg::Node& node)
{
    if (isTooDeep(node) || isTooMuch(node)) return;
    const bool untracked = &node != _input.root && kindOf(node) == NodeKind::Untracked;
    if (untracked && _untracked == 0) subtree(); // it may be empty now, but not later
    _untracked += untracked;
    traverse(node);
    _untracked -= untracked;
}

/// Returns true if the node is so deep that its children are skipped; a node with children is then
/// counted and named.
bool GraphCollector::isTooDeep(const osg::Node& node)
{
    if (getNodePath().size() < kDeepestPath) return false;
    const osg::Group* group = node.asGroup();
    if (group && group->getNumChildren() > 0)
        _report.warn("skipped.too-deep", "node '" + node.getName() + "'",
                     "lies below " + std::to_string(kDeepestPath - 1) +
                         " others, its children are skipped");
    return true;
}

/// Returns true if too many paths have been taken already; the node is then counted and named. OSG
/// draws the node, unless OSG's own traversal would not end either.
bool GraphCollector::isTooMuch(osg::Node& node)
{
    if (_visits.take()) return false;
    const uint64_t most = _rasterizedVisits.left();
    const uint64_t count = _counts.of(node, most, kDeepestPath);
    const std::string object = "node '" + path() + "'";
    const std::string limit = "comes after " + std::to_string(kMostPaths) + " paths to nodes, ";
    if (_input.rasterizesRest && count <= most)
    {
        _rasterizedVisits = PathBudget(most - count);
        _report.warn("rasterized.too-many-paths", object, limit + "left to OSG with all below it");
        rasterize();
    }
    else
        _report.warn("skipped.too-many-paths", object, limit + "left out with all below it");
    return true;
}

bool GraphCollector::pushState(osg::Node& node)
{
    const osg::StateSet* stateSet = node.getStateSet();
    if (stateSet) _states.push(*stateSet);
    return stateSet != nullptr;
}

/// Returns false if nothing can be placed by this matrix; the transform is then counted and named.
bool GraphCollector::pushMatrix(const osg::Matrixd& worldFromLocal)
{
    const char* fault = enterPlace(worldFromLocal);
    if (!fault) return true;
    recordAllInScene();
    _report.warn(
        fault, "transform '" + path() + "'",
        "matrix leaves no area, or is projective or not finite, skipped with all below it");
    return false;
}

void GraphCollector::traverseBelow(const osg::Matrixd& worldFromLocal, osg::Node& node)
{
    if (!pushMatrix(worldFromLocal)) return;
    traverseChildren(node);
    _worldFromLocal.pop_back();
}

/// Returns true if the node is a leaf of osgRayTrace or of another kit and has no children to
/// visit.
bool GraphCollector::collectLeaf(osg::Node& node)
{
    if (const auto* light = dynamic_cast<const AreaLight*>(&node))
    {
        recordSpecial();
        _graph.lights.areaLights.push_back({light, engineFromLocal(), path(), pickPath()});
        return true;
    }
    if (const auto* light = dynamic_cast<const EnvironmentLight*>(&node))
    {
        recordSpecial();
        _graph.lights.environments.push_back({light, engineFromLocal(), path()});
        return true;
    }
    if (const auto* volume = dynamic_cast<const MediumVolume*>(&node))
    {
        recordSpecial();
        if (volume->getShape() == MediumVolume::BOX && volume->getMedium())
            collectBox(*volume);
        else
            _graph.lights.volumes.push_back({volume, engineFromLocal(), path()});
        return true;
    }
    if (isFrom(&node, "osg")) return false;
    if (_lightsOnly) return true;
    if (const char* reason = untracedLeaf(node))
    {
        _report.count(reason);
        warnIfForced(node.className());
    }
    rasterize(); // leaves that only work in the cull traversal are kept, too
    return true;
}

osg::Matrixd GraphCollector::engineFromLocal() const
{
    return _worldFromLocal.back() * osg::Matrixd::translate(-_input.origin);
}

uint32_t GraphCollector::pickPath()
{
    return _input.picks && _culledLeaf == kNoCulledLeaf ? _graph.paths.add(getNodePath())
                                                        : NodeTree::kNone;
}

} // namespace osgRayTrace::engine
