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
    ++_untracked; // graphHash looks at the drawable
    if (const osg::Geometry* triangles = _triangles.of(drawable))
        collectProxy(drawable, *triangles);
    --_untracked;
}

/// Returns true if the drawable is seen in no view; picks find it.
bool GraphCollector::leavesOut(const osg::Drawable& drawable)
{
    if (!isForTheMouse(drawable)) return false;
    _report.count("not-traced.mouse-handle");
    rasterize(RasterizedPart::Pick);
    if (const osg::Geometry* geometry = drawable.asGeometry())
        _graph.leftGeometries.push_back(geometry);
    return true;
}

/// Adds a proxy of the drawable at the end of the path, which OSG draws, if it is to have one.
void GraphCollector::collectProxy(osg::Drawable& drawable, const osg::Geometry& triangles)
{
    const bool pushed = pushState(drawable);
    if (hasProxy(drawable, getNodePath(), _states.states()[_states.top()], _textures))
        collectUse(triangles, _materials.stateOf(getNodePath(), _states).state, true);
    if (pushed) _states.pop();
}

} // namespace osgRayTrace::engine
