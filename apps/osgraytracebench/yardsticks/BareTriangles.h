// BareTriangles.h - a mesh in buffers of Embree's own. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <embree3/rtcore.h>

#include <osg/Array>
#include <osg/PrimitiveSet>

#include <cstring>

namespace osgRayTrace::bench
{

/// Returns one copy of vertices and indices; not committed. The caller owns it.
inline RTCGeometry newBareTriangles(RTCDevice device, const osg::Vec3Array& vertices,
                                    const osg::DrawElementsUInt& indices)
{
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* const corners = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0,
                                                  RTC_FORMAT_FLOAT3, 12, vertices.size());
    void* const triangles = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0,
                                                    RTC_FORMAT_UINT3, 12, indices.size() / 3);
    std::memcpy(corners, vertices.getDataPointer(), vertices.getTotalDataSize());
    std::memcpy(triangles, indices.getDataPointer(), indices.getTotalDataSize());
    return mesh;
}

} // namespace osgRayTrace::bench
