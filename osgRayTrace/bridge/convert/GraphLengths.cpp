// GraphLengths.cpp - finds the lengths of a collected graph and applies its unit. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/GraphLengths.h"

#include <osgRayTrace/AreaLight>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

LengthCounts lengthsOf(const CollectedGraph& graph)
{
    LengthCounts lengths;
    for (const CollectedGeometry& geometry : graph.geometries)
    {
        const VertexBounds& bounds = *geometry.bounds;
        if (bounds.count == 0) continue;
        for (const GeometryUse& use : geometry.uses)
            lengths.add(largestCoordinate(bounds, use.engineFromLocal), bounds.count);
    }
    for (const CollectedAreaLight& source : graph.lights.areaLights)
    {
        const AreaLight& light = *source.light;
        for (const osg::Vec3d& p :
             {osg::Vec3d(), osg::Vec3d(light.getEdgeU()), osg::Vec3d(light.getEdgeV())})
        {
            const osg::Vec3d q = (osg::Vec3d(light.getCorner()) + p) * source.engineFromLocal;
            lengths.add(std::max({std::fabs(q.x()), std::fabs(q.y()), std::fabs(q.z())}));
        }
    }
    for (const CollectedTile& source : graph.lights.tiles)
    {
        const osgVolume::Locator* locator = source.tile->getLocator();
        if (!locator && source.tile->getLayer()) locator = source.tile->getLayer()->getLocator();
        const osg::Matrixd engineFromCube =
            locator ? locator->getTransform() * source.engineFromLocal : source.engineFromLocal;
        for (const double end : {0.0, 1.0})
        {
            const osg::Vec3d p = osg::Vec3d(end, end, end) * engineFromCube;
            lengths.add(std::max({std::fabs(p.x()), std::fabs(p.y()), std::fabs(p.z())}));
        }
    }
    return lengths;
}

void applyUnit(double unit, CollectedGraph& graph)
{
    if (unit == 1.0) return;
    const osg::Matrixd scale = osg::Matrixd::scale(1.0 / unit, 1.0 / unit, 1.0 / unit);
    for (CollectedGeometry& geometry : graph.geometries)
        for (GeometryUse& use : geometry.uses)
            use.engineFromLocal.postMult(scale);
    for (CollectedLight& light : graph.lights.lights)
        if (!light.eyeSpace) light.engineFromLocal.postMult(scale);
    for (CollectedAreaLight& light : graph.lights.areaLights)
        light.engineFromLocal.postMult(scale);
    for (CollectedVolume& volume : graph.lights.volumes)
        volume.engineFromLocal.postMult(scale);
    for (CollectedTile& tile : graph.lights.tiles)
        tile.engineFromLocal.postMult(scale);
    for (PlacedTexGen& texGen : graph.texGens)
        texGen.engineFromLocal.postMult(scale);
    graph.clipPlanes.applyUnit(unit);
}

} // namespace osgRayTrace::engine
