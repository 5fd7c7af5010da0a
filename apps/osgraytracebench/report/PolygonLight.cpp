// PolygonLight.cpp - Lambert's formula in double. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/PolygonLight.h"

#include <cmath>

namespace osgRayTrace::bench
{

using osg::Vec3d;

Polygon clip(const Polygon& polygon, const Vec3d& origin, const Vec3d& normal)
{
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const Vec3d& a = polygon[i];
        const Vec3d& b = polygon[(i + 1) % polygon.size()];
        const double heightA = normal * (a - origin), heightB = normal * (b - origin);
        if (heightA >= 0.0) kept.push_back(a);
        if ((heightA < 0.0) != (heightB < 0.0))
            kept.push_back(a + (b - a) * (heightA / (heightA - heightB)));
    }
    return kept;
}

double irradiance(const Polygon& light, const Vec3d& point, const Vec3d& normal)
{
    const Polygon seen = clip(light, point, normal);
    double sum = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i)
    {
        const Vec3d a = seen[i] - point, b = seen[(i + 1) % seen.size()] - point;
        const Vec3d axis = a ^ b;
        const double length = axis.length();
        if (length > 0.0) sum += std::atan2(length, a * b) * (axis * normal) / length;
    }
    return 0.5 * std::abs(sum);
}

double irradiance(const Polygon& light, const Polygon& occluder, const Vec3d& point,
                  const Vec3d& normal)
{
    const double whole = irradiance(light, point, normal);
    if (occluder.empty()) return whole;
    Vec3d centre;
    for (const Vec3d& corner : occluder)
        centre += corner / static_cast<double>(occluder.size());
    Polygon hidden = light;
    for (std::size_t i = 0; i < occluder.size() && !hidden.empty(); ++i)
    {
        const Vec3d side = (occluder[i] - point) ^ (occluder[(i + 1) % occluder.size()] - point);
        hidden = clip(hidden, point, side * (centre - point) >= 0.0 ? side : -side);
    }
    return whole - irradiance(hidden, point, normal);
}

} // namespace osgRayTrace::bench
