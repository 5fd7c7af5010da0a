// PolygonLight.h - irradiance from a polygon that emits, also behind an occluder. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Vec3d>

#include <vector>

namespace osgRayTrace::bench
{

/// Corners in order, flat, convex.
using Polygon = std::vector<osg::Vec3d>;

/// The part of a polygon with normal * (point - origin) >= 0.
Polygon clip(const Polygon& polygon, const osg::Vec3d& origin, const osg::Vec3d& normal);

/// Irradiance at the point of a surface with this unit normal, for unit radiance, whichever way the
/// light's front is turned [Lambert60; Baum89, eq. 4]. The light is cut at the surface's horizon.
double irradiance(const Polygon& light, const osg::Vec3d& point, const osg::Vec3d& normal);

/// The same with a convex occluder between the point and every point of the light: what is left
/// when the part of the light within the pyramid from the point through the occluder is taken away.
/// An empty occluder hides nothing.
double irradiance(const Polygon& light, const Polygon& occluder, const osg::Vec3d& point,
                  const osg::Vec3d& normal);

} // namespace osgRayTrace::bench
