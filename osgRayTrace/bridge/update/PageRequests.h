// PageRequests.h - asks for the files that a view would load. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>

namespace osgUtil
{
class CullVisitor;
}

namespace osgRayTrace::engine
{

/// Requests the pages (PagedLOD, ProxyNode) below the node that the visitor is at, and marks those
/// in use, as the visitor's own traversal of the frustum would. If the scene is traced, nothing
/// else requests pages. Cull threads call this.
void requestPages(osg::Group& scene, osgUtil::CullVisitor& visitor);

} // namespace osgRayTrace::engine
