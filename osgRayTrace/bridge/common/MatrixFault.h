// MatrixFault.h - whether a transform can place anything. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Matrixd>

#include <cmath>

namespace osgRayTrace::engine
{

/// Returns what is wrong with a matrix, as a key of the report (see ReportReasons.h), or null. A
/// matrix is singular if its axes, made unit, span no more than smallestVolume: so a tiny or a flat
/// scale is fine.
inline const char* matrixFault(const osg::Matrixd& m, double smallestVolume)
{
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(m.ptr()[i])) return "skipped.not-finite-transform";
    if (m(0, 3) != 0.0 || m(1, 3) != 0.0 || m(2, 3) != 0.0 || m(3, 3) != 1.0)
        return "skipped.projective-transform";
    osg::Vec3d x(m(0, 0), m(0, 1), m(0, 2)), y(m(1, 0), m(1, 1), m(1, 2)),
        z(m(2, 0), m(2, 1), m(2, 2));
    x.normalize();
    y.normalize();
    z.normalize();
    return std::fabs((x ^ y) * z) > smallestVolume ? nullptr : "skipped.singular-transform";
}

} // namespace osgRayTrace::engine
