// ClippedUse.h - uses of geometries that clip planes may cut. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ClipPlanes.h"
#include "osgRayTrace/bridge/geometry/BoundArrays.h"
#include "osgRayTrace/bridge/geometry/MeshRequest.h"

#include <osg/Geometry>
#include <osg/Matrixd>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds a use for which clip planes are on. Its mesh is made at its place.
struct ClippedUse
{
    osg::ref_ptr<const osg::Geometry> geometry;
    osg::Matrixd engineFromLocal;
    uint64_t numbers = 0; ///< numbers of the planes, as bits
    MeshRequest request;  ///< request of its own mesh, with the planes that cut it
    uint32_t variant = 0; ///< see GeometryCache::mesh
    Clipping clipping = Clipping::None;
    bool own = true;              ///< false: the instance shares the mesh of others
    uint32_t instance = kInvalid; ///< kInvalid: nothing is left of the use
};

/// Returns how a geometry in a place is clipped: Partly if in doubt or if its bounds are not whole.
inline Clipping clippingOf(const osg::Geometry& geometry, const VertexBounds& bounds,
                           const osg::Matrixd& engineFromLocal, const std::vector<Vec4d>& planes)
{
    const osg::Array* positions = positionArray(geometry);
    if (planes.empty()) return Clipping::None;
    if (!positions || bounds.count != positions->getNumElements()) return Clipping::Partly;
    return clippingOf(bounds, engineFromLocal, planes);
}

} // namespace osgRayTrace::engine
