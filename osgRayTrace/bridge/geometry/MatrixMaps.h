// MatrixMaps.h - a matrix of OSG as a map of points and as a map of normals. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <osg/Matrixd>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgRayTrace::engine
{

/// Maps points by an osg::Matrixd: row vectors times matrix.
struct PointMap
{
    Vec3d x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0}, translation{0.0};

    explicit PointMap(const std::optional<osg::Matrixd>& matrix)
    {
        if (!matrix) return;
        const osg::Matrixd& m = *matrix;
        x = {m(0, 0), m(0, 1), m(0, 2)};
        y = {m(1, 0), m(1, 1), m(1, 2)};
        z = {m(2, 0), m(2, 1), m(2, 2)};
        translation = {m(3, 0), m(3, 1), m(3, 2)};
    }

    Vec3d operator()(const Vec3d& p) const { return x * p.x + y * p.y + z * p.z + translation; }
};

/// Maps normals by the inverse transpose times the sign of the determinant that keeps outward
/// normals outward. The map consists of the cofactors, scaled to about 1 so that tiny and huge
/// transforms stay in range.
struct NormalMap
{
    Vec3d x{1.0, 0.0, 0.0}, y{0.0, 1.0, 0.0}, z{0.0, 0.0, 1.0};

    explicit NormalMap(const std::optional<osg::Matrixd>& matrix)
    {
        if (!matrix) return;
        const PointMap m(matrix);
        double largest = 0.0;
        for (const Vec3d& row : {m.x, m.y, m.z})
            largest = std::max({largest, std::fabs(row.x), std::fabs(row.y), std::fabs(row.z)});
        const Vec3d a = m.x / largest, b = m.y / largest, c = m.z / largest;
        const double sign = glm::dot(glm::cross(a, b), c) < 0.0 ? -1.0 : 1.0;
        x = glm::cross(b, c) * sign;
        y = glm::cross(c, a) * sign;
        z = glm::cross(a, b) * sign;
    }

    Vec3d operator()(const Vec3d& n) const { return x * n.x + y * n.y + z * n.z; }
};

} // namespace osgRayTrace::engine
