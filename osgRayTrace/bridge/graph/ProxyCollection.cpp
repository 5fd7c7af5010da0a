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
    if (!reason) return;
    if (_leftToOsg == 0)
    {
        _report.count(reason);
        warnIfForced(drawable.className());
        rasterize();
    }
    const bool isSurface = std::strcmp(reason, "not-traced.custom-drawable") == 0;
    if (!_input.rasterizesRest || !isSurface) return;
    ++_untracked; // graphHash looks at the drawable
    if (const osg::Geometry* triangles = _triangles.of(drawable))
        collectProxy(drawable, *triangles);
    --_untracked;
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
