// ProxyCollection.cpp - collects proxies of what GraphCollector leaves to OSG. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/GraphCollector.h"
#include "osgRayTrace/bridge/graph/Proxies.h"
#include "osgRayTrace/bridge/graph/UntracedParts.h"

#include <cstring>

namespace osgRayTrace::engine
{

void GraphCollector::apply(osg::Drawable& drawable)
{
    const char* reason = _lightsOnly ? nullptr : untracedDrawable(drawable);
    if (!reason || leavesOut(drawable)) return;
    const bool isSurface = std::strcmp(reason, "not-traced.custom-drawable") == 0;
    if (isSurface && collectsChosen(drawable)) return;
    if (_leftToOsg == 0)
    {
        _report.count(reason);
        warnIfForced(drawable.className());
        rasterize();
    }
    if (!_input.rasterizesRest || !isSurface) return;
    if (!isProxied(drawable)) return;
    recordInScene(); // with or without triangles as yet
    ++_untracked;    // graphHash looks at the drawable
    if (const osg::Geometry* triangles = _triangles.of(drawable))
        collectUse(*triangles, assignedState(drawable).state, true);
    --_untracked;
}

/// Returns true if the drawable is seen in no view; picks find it.
bool GraphCollector::leavesOut(const osg::Drawable& drawable)
{
    if (!isForTheMouse(drawable)) return false;
    _report.count("not-traced.mouse-handle");
    rasterize(RasterizedPart::Pick);
    if (const osg::Geometry* geometry = drawable.asGeometry()) leave(*geometry);
    return true;
}

/// Returns whether the drawable at the end of the path, which OSG draws, has a proxy.
bool GraphCollector::isProxied(osg::Drawable& drawable)
{
    const bool pushed = pushState(drawable);
    const GraphState& state = _states.states()[_states.top()];
    if (pushed) _states.pop();
    return hasProxy(drawable, getNodePath(), {}, state, _textures);
}

/// Returns whether a leaf of the cull traversal of the node at the end of the path, which OSG
/// draws, has a proxy. Drawables of no node that are no geometry may be others in each traversal.
bool GraphCollector::isProxied(const CulledLeaf& leaf)
{
    if (leaf.isProjected) return false;
    const bool tellsTriangles =
        leaf.drawable->asGeometry() ||
        (std::strcmp(leaf.left, "not-traced.custom-drawable") == 0 &&
         leaf.drawable->getNumParents() > 0 && _triangles.of(*leaf.drawable));
    return tellsTriangles &&
           hasProxy(*leaf.drawable, getNodePath(), leaf.states, stateOf(leaf), _textures);
}

} // namespace osgRayTrace::engine
