// PolygonLight.h - irradiance from a polygon that emits, also behind an occluder. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Vec3d>

#include <vector>

namespace osgRayTrace::bench
{

/// Holds corners in order; a polygon is flat and convex.
using Polygon = std::vector<osg::Vec3d>;

/// Returns the part of a polygon with normal * (point - origin) >= 0.
Polygon clip(const Polygon& polygon, const osg::Vec3d& origin, const osg::Vec3d& normal);

/// Returns the irradiance at the point of a surface with this unit normal, for unit radiance,
/// whichever way the light's front is turned [Lambert60; Baum89, eq. 4]. The light is cut at the
/// surface's horizon.
double irradiance(const Polygon& light, const osg::Vec3d& point, const osg::Vec3d& normal);

/// Returns the irradiance with a convex occluder between the point and every point of the light:
/// that of the light without its part within the pyramid from the point through the occluder. An
/// empty occluder hides nothing.
double irradiance(const Polygon& light, const Polygon& occluder, const osg::Vec3d& point,
                  const osg::Vec3d& normal);

} // namespace osgRayTrace::bench
