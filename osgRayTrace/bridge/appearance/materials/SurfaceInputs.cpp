// SurfaceInputs.cpp - reads colours and coordinates of a geometry. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/SurfaceInputs.h"

#include "osgRayTrace/bridge/common/ArrayReader.h"
#include "osgRayTrace/bridge/geometry/BoundArrays.h"
#include "osgRayTrace/bridge/geometry/PointSolids.h"

#include "osgRayTrace/scene/TextureMapping.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

SurfaceInputs surfaceInputs(const osg::Geometry& geometry, float pointRadius)
{
    SurfaceInputs inputs;
    inputs.isOfSolids = hasSolidsAlone(geometry, pointRadius);
    const unsigned int units = std::min(geometry.getNumTexCoordArrays(), kUvSets);
    for (unsigned int unit = 0; unit < units; ++unit)
        inputs.uvSets |= isReadable(geometry.getTexCoordArray(unit)) ? 1u << unit : 0u;
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
