// SurfaceInputs.cpp - reads colours and coordinates of a geometry. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/SurfaceInputs.h"

#include "osgRayTrace/bridge/common/ArrayReader.h"
#include "osgRayTrace/bridge/geometry/BoundArrays.h"
#include "osgRayTrace/bridge/geometry/PointSolids.h"

#include <cmath>

namespace osgRayTrace::engine
{

SurfaceInputs surfaceInputs(const osg::Geometry& geometry, float pointRadius)
{
    SurfaceInputs inputs;
    inputs.isOfSolids = hasSolidsAlone(geometry, pointRadius);
    inputs.hasTextureCoordinates = isReadable(geometry.getTexCoordArray(0));
    inputs.hasSecondCoordinates = isReadable(geometry.getTexCoordArray(1));
    inputs.hasTangents = tangentArray(geometry) != nullptr;
    const osg::Array* colors = geometry.getColorArray();
    const osg::Array::Binding binding = bindingOf(colors);
    inputs.hasVertexColors =
        binding == osg::Array::BIND_PER_VERTEX || binding == osg::Array::BIND_PER_PRIMITIVE_SET;
    if (binding != osg::Array::BIND_OVERALL) return inputs;
    forEachRow(*colors, {1, nullptr, IntegerMeaning::Normalized},
               [&inputs](std::size_t, const Vec4d& row)
               {
                   inputs.overallColor = Vec4(row);
                   inputs.hasOverallColor = isFinite(Vec3(row)) && std::isfinite(row.w);
               });
    return inputs;
}

} // namespace osgRayTrace::engine
