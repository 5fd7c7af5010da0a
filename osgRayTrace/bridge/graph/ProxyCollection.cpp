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
    if (!isProxied(drawable)) return;
    ++_untracked; // graphHash looks at the drawable
    if (const osg::Geometry* triangles = _triangles.of(drawable))
        collectUse(*triangles, assignedState(drawable).state, true);
    --_untracked;
}

/// Returns whether the drawable at the end of the path, which OSG draws, has a proxy.
bool GraphCollector::isProxied(osg::Drawable& drawable)
{
    const bool pushed = pushState(drawable);
    const GraphState& state = _states.states()[_states.top()];
    if (pushed) _states.pop();
    return hasProxy(drawable, getNodePath(), state, _textures);
}

} // namespace osgRayTrace::engine
