// PlaneScenes.h - a plane under an area light: direct light that has a formula. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/PolygonLight.h"
#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

/// Describes the light of the plane z = 0.
struct PlaneLighting
{
    Polygon light;    ///< above the plane
    Polygon occluder; ///< between light and plane, black; may be empty
};

/// Returns S1: a unit square at height 1, also as a tile on the surface of an earth-sized
/// ellipsoid.
ReportScene squareLightScene();
/// Returns S1 with a regular hexagon made of triangles with emission.
ReportScene hexagonLightScene();
/// Returns S2: S1 with a straight edge at height 1/2, parallel to a side of the light.
ReportScene axisEdgeScene();
/// Returns S2 with the edge turned by 17 degrees.
ReportScene rotatedEdgeScene();
/// Returns S1 with a disc of 48 sides at height 1/2.
ReportScene roundBlockerScene();

PlaneLighting squareLighting();
PlaneLighting axisEdgeLighting();
PlaneLighting rotatedEdgeLighting();
PlaneLighting roundBlockerLighting();

/// Returns the plane, the light as a node of its own (AreaLight if it has four corners) and the
/// occluder.
osg::ref_ptr<osg::Group> planeGraph(const PlaneLighting& lighting);

/// Returns the radiance (red, green, blue) that leaves the plane for an irradiance of 1 from light
/// of unit radiance.
osg::Vec3d planeScale();

} // namespace osgRayTrace::bench
