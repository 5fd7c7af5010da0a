// PlaneScenes.h - a plane under an area light, with and without an occluder: direct light that has
// a formula. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/PolygonLight.h"
#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

/// What the plane z = 0 is lit by.
struct PlaneLighting
{
    Polygon light;    ///< above the plane
    Polygon occluder; ///< between them, black; may be empty
};

/// S1: a unit square at height 1. Also on an earth-sized ellipsoid's surface, as a tile of it.
ReportScene squareLightScene();
/// S1 with a regular hexagon made of triangles with emission.
ReportScene hexagonLightScene();
/// S2: S1 with a straight edge at height 1/2, parallel to a side of the light.
ReportScene axisEdgeScene();
/// S2 with the edge turned by 17 degrees.
ReportScene rotatedEdgeScene();
/// S1 with a disc of 48 sides at height 1/2.
ReportScene roundBlockerScene();

PlaneLighting squareLighting();
PlaneLighting axisEdgeLighting();
PlaneLighting rotatedEdgeLighting();
PlaneLighting roundBlockerLighting();

/// The plane, the light as a node of its own (AreaLight if it has four corners) and the occluder.
osg::ref_ptr<osg::Group> planeGraph(const PlaneLighting& lighting);

/// Radiance that leaves the plane for an irradiance of 1 from light of unit radiance, red, green,
/// blue.
osg::Vec3d planeScale();

} // namespace osgRayTrace::bench
