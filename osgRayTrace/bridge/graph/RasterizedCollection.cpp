// RasterizedCollection.cpp - collects the parts that GraphCollector leaves to OSG. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/LibraryName.h"
#include "osgRayTrace/bridge/geometry/PointSolids.h"
#include "osgRayTrace/bridge/graph/DrawHint.h"
#include "osgRayTrace/bridge/graph/GraphCollector.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"
#include "osgRayTrace/bridge/graph/VolumeTiles.h"

#include <osg/Billboard>
#include <osg/Material>
#include <osg/OccluderNode>

#include <algorithm>

namespace osgRayTrace::engine
{

/// Names an occluder. Rays meet what it hides from a view: shadows, mirrors and other views show
/// it.
void GraphCollector::apply(osg::OccluderNode& node)
{
    if (node.getOccluder()) _report.count("approximated.occluder");
    apply(static_cast<osg::Node&>(node));
}

/// Returns whether the mask of the last node of the path hides it from some of the views: those
/// that see it have it from OSG.
bool GraphCollector::isForSomeViews(const osg::Node& node)
{
    const bool hidden =
        std::any_of(_input.viewMasks.begin(), _input.viewMasks.end(),
                    [&node](unsigned int mask) { return (node.getNodeMask() & mask) == 0; });
    return hidden && _input.rasterizesRest && hintOf(getNodePath()) != DrawHint::Trace;
}

/// Returns whether OSG has to draw something in the billboard. OSG then draws all of the billboard,
/// because it places its drawables.
bool GraphCollector::leavesDrawable(osg::Billboard& billboard)
{
    bool leaves = isForSomeViews(billboard);
    for (unsigned int i = 0; i < billboard.getNumDrawables() && !leaves; ++i)
    {
        osg::Drawable* drawable = billboard.getDrawable(i);
        if (!drawable) continue;
        const osg::Geometry* geometry = drawable->asGeometry();
        pushOntoNodePath(drawable);
        leaves = !geometry || rasterizedReason(*geometry, false, assignedState(*geometry).state) ||
                 untracedSets(*geometry, _input.pointRadius);
        popFromNodePath();
    }
    return leaves;
}

/// Returns whether the group is of a kit that draws its children in a way of its own, by a cull
/// traversal only. OSG draws such a group if there is OpenGL, and proxies of an effect's children
/// are traced. Without OpenGL the children stand for the effect, as they do if the effect is hinted
/// to be traced. Volumes are traced, unless a tile of theirs is one that rays cannot show; without
/// OpenGL they are then left out.
bool GraphCollector::leavesGroup(osg::Node& node)
{
    const bool effect = isFrom(&node, "osgFX"), volume = isFrom(&node, "osgVolume");
    if (!effect && !volume) return false;
    if (_lightsOnly) return true;
    const char* untraced = nullptr;
    if (volume && _leftToOsg == 0)
    {
        untraced = hintOf(getNodePath()) == DrawHint::Rasterize ? "it is hinted to be drawn by OSG"
                                                                : untracedTileBelow(node);
        if (!untraced)
        {
            collectVolume(*node.asGroup());
            return true;
        }
        warnIfForced("a volume");
    }
    const bool traces = effect && hintOf(getNodePath()) == DrawHint::Trace;
    if (_leftToOsg > 0 || (_input.rasterizesRest && !traces))
    {
        if (_leftToOsg == 0 && effect) _report.count("rasterized.effect");
        if (untraced)
            _report.warn("rasterized.volume", "volume '" + path() + "'",
                         std::string(untraced) + ", drawn by OSG");
        rasterize();
        ++_leftToOsg;
        if (effect) traverseGroup(*node.asGroup());
        --_leftToOsg;
        return true;
    }
    if (effect) _report.count("approximated.effect");
    if (volume)
        _report.warn("not-traced.volume", "volume '" + path() + "'",
                     std::string(untraced ? untraced : "OSG draws what it is in") + ", left out");
    if (effect) traverseGroup(*node.asGroup());
    return true;
}

/// Collects a tile of osgVolume, or traverses a group of tiles, all of which are traced.
void GraphCollector::collectVolume(osg::Group& group)
{
    const auto* tile = dynamic_cast<const osgVolume::VolumeTile*>(&group);
    if (!tile)
    {
        traverseGroup(group);
        return;
    }
    recordSpecial();
    const bool pushed = pushState(group);
    const GraphState& state = _states.states()[_states.top()];
    CollectedTile found{tile, engineFromLocal(), path(),
                        state.attribute<PhysicalMaterial>(kPhysicalMaterialSlot)};
    const osg::StateSet* own = group.getStateSet();
    const auto* material =
        own ? dynamic_cast<const osg::Material*>(own->getAttribute(osg::StateAttribute::MATERIAL))
            : nullptr;
    if (material) found.diffuse = material->getDiffuse(osg::Material::FRONT);
    if (propertiesOf(*tile).isoValue)
        collectIsoSurface(*tile, material || found.material);
    else
        _graph.lights.tiles.push_back(found);
    if (pushed) _states.pop();
}

/// Collects the isosurface of the tile at the end of the path as if it were a child of the tile.
void GraphCollector::collectIsoSurface(const osgVolume::VolumeTile& tile, bool hasMaterial)
{
    const IsoSurfaces::Result found = _triangles.isoSurfaces.of(tile, hasMaterial);
    if (found.repaired > 0) _report.count("repaired.voxel", found.repaired);
    if (found.fault)
    {
        _report.warn("skipped.volume", "volume '" + path() + "'",
                     std::string(found.fault) + ", skipped");
        return;
    }
    _report.count("converted.isosurface");
    if (!found.node) return;
    ++_untracked;
    found.node->accept(*this);
    --_untracked;
}

/// Collects the box of the volume at the end of the path. Nothing picks it, and OSG never draws it,
/// so that no leaf of a cull traversal stands for it.
void GraphCollector::collectBox(const MediumVolume& volume)
{
    const osg::Geometry* box = _triangles.mediumBoxes.of(volume);
    if (!box)
    {
        _report.warn("skipped.medium-volume", "medium volume '" + path() + "'",
                     "its box has no extent along some axis, skipped");
        return;
    }
    if (volume.getStateSet()) _states.push(*volume.getStateSet());
    _states.push(*box->getStateSet());
    ++_untracked;
    collectUse(*box, _states.top(), false);
    _graph.geometries[_indexOf.at({box, restartOf(_states.states()[_states.top()]).key()})]
        .uses.back()
        .path = NodeTree::kNone;
    --_untracked;
    _states.pop();
    if (volume.getStateSet()) _states.pop();
}

/// Traverses the children, whatever the group's own traverse does.
void GraphCollector::traverseGroup(osg::Group& group)
{
    if (isTooDeep(group) || isTooMuch(group)) return;
    const bool pushed = pushState(group);
    ++_untracked;
    for (unsigned int i = 0; i < group.getNumChildren(); ++i)
        if (const osg::ref_ptr<osg::Node> child = group.getChild(i)) child->accept(*this);
    --_untracked;
    if (pushed) _states.pop();
}

/// Leaves the node that is visited to OSG, unless OSG draws a node above it with all below.
void GraphCollector::rasterize(RasterizedPart::Kind kind, osg::Node* inPlace)
{
    if (!_input.rasterizesRest || _leftToOsg > 0) return;
    if (_isLeft && kind == RasterizedPart::Draw)
    {
        if (const osg::Geometry* geometry = getNodePath().back()->asGeometry()) leave(*geometry);
        return;
    }
    _graph.rasterizedSubtrees.push_back(subtree());
    _graph.rasterized.push_back(rasterizedPart(kind, getNodePath()));
    _graph.rasterized.back().inPlace = inPlace;
    _graph.rasterizedPaths.push_back(pickPath());
}

/// Returns the state of the drawable at the end of the path, with the material that a rule of the
/// user's gives it.
AssignedState GraphCollector::assignedState(const osg::Drawable& drawable)
{
    const osg::StateSet* stateSet = drawable.getStateSet();
    if (stateSet) _states.push(*stateSet);
    AssignedState assigned = _materials.stateOf(getNodePath(), _states);
    if (stateSet) _states.pop();
    return assigned;
}

/// Returns why OpenGL, if available, draws the geometry at the end of the path, whose state has
/// this number; null: it is traced.
const char* GraphCollector::rasterizedReason(const osg::Geometry& geometry, bool isPosed,
                                             uint32_t state)
{
    const osg::StateSet* stateSet = geometry.getStateSet();
    const osg::StateAttribute* poses =
        isPosed && stateSet ? stateSet->getAttribute(osg::StateAttribute::PROGRAM) : nullptr;
    const char* reason = rasterizedState(_states.states()[state], _textures, poses);
    const DrawHint hint = hintOf(getNodePath());
    if (leavesToOsg(hint)) return "rasterized.hint";
    if (_isLeft || isForSomeViews(*getNodePath().back())) return "rasterized.view-mask";
    return hint == DrawHint::Trace ? nullptr : reason;
}

/// Leaves to OSG the parts that it draws better. Returns true if nothing is left to trace.
bool GraphCollector::rasterizes(const osg::Geometry& geometry, bool isPosed, uint32_t state)
{
    if (const char* reason = rasterizedReason(geometry, isPosed, state))
    {
        _report.count(reason);
        rasterize();
        return true;
    }
    const osg::ref_ptr<osg::Geometry> rest = untracedSets(geometry, _input.pointRadius);
    if (!rest) return false;
    warnIfForced("lines, points or instanced primitives");
    const bool all = rest->getNumPrimitiveSets() == geometry.getNumPrimitiveSets();
    rasterize(RasterizedPart::Draw, all ? nullptr : rest.get());
    return false; // primitive sets without triangles are counted where triangles are made
}

/// Records why OSG draws the geometry, whose state has this number, if it is a part of its own.
void GraphCollector::recordLeft(const osg::Geometry& geometry, uint32_t state, bool proxied)
{
    if (_graph.rasterized.empty()) return;
    RasterizedPart& part = _graph.rasterized.back();
    if (part.path.empty() || part.path.back() != &geometry) return;
    part.left = {rasterizedState(_states.states()[state], _textures, nullptr), proxied};
}

/// Returns the radius of the geometry's points and lines, and names a geometry that has too many.
float GraphCollector::pointRadiusOf(const osg::Geometry& geometry)
{
    const float radius = solidRadius(geometry, _input.pointRadius);
    if (radius < _input.pointRadius && solidCount(geometry) > 0)
        _report.warn("warned.too-many-points", "geometry '" + path() + "'",
                     "has more than " + std::to_string(kMostSolids) +
                         " points and lines, which are not traced");
    return radius;
}

/// Names a node that is hinted to be traced but cannot be.
void GraphCollector::warnIfForced(const char* what)
{
    if (hintOf(getNodePath()) != DrawHint::Trace) return;
    _report.warn("warned.trace-hint", "node '" + path() + "'",
                 std::string("is hinted to be ray traced, but cannot be: ") + what);
}

} // namespace osgRayTrace::engine
