// FlatMatrix.h - places what a transform flattens to a plane. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/MatrixFault.h"

#include <osg/Matrixd>

#include <algorithm>
#include <optional>

namespace osgRayTrace::engine
{

/// Returns an invertible matrix that takes points to a plane but for a small part of their distance
/// from the local origin, as a singular matrix takes them there: a millionth for a scale of 0 along
/// one axis, a thousandth for others, as of shadows on the ground, whose inverse has to be found in
/// floats. OpenGL draws such figures. Returns nothing if the figures have no area left, or if the
/// matrix is projective or not finite.
inline std::optional<osg::Matrixd> flatMatrix(osg::Matrixd m)
{
    constexpr double kScaled = 1e-6, kProjected = 1e-3, kNoArea = 1e-12;
    if (matrixFault(m, -1.0)) return std::nullopt;
    osg::Vec3d axes[3];
    for (int i = 0; i < 3; ++i)
        axes[i].set(m(i, 0), m(i, 1), m(i, 2));
    const osg::Vec3d areas[] = {axes[1] ^ axes[2], axes[2] ^ axes[0], axes[0] ^ axes[1]};
    const auto isShorter = [](const osg::Vec3d& a, const osg::Vec3d& b)
    { return a.length2() < b.length2(); };
    osg::Vec3d normal = *std::max_element(areas, areas + 3, isShorter);
    const double size = std::max_element(axes, axes + 3, isShorter)->length();
    const bool isScaled = std::min_element(axes, axes + 3, isShorter)->length2() == 0.0;
    const double thickness = size * (isScaled ? kScaled : kProjected);
    if (!(normal.normalize() > kNoArea * size * size)) return std::nullopt;
    // The areas, seen along the normal, are the local direction that the matrix loses.
    osg::Vec3d lost(normal * areas[0], normal * areas[1], normal * areas[2]);
    lost.normalize();
    for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c)
            m(i, c) += thickness * lost[i] * normal[c];
    return m;
}

/// Returns a matrix with which things can be placed that have the places of this one; nothing if
/// nothing can. See matrixFault().
inline std::optional<osg::Matrixd> placingMatrix(const osg::Matrixd& m, double smallestVolume)
{
    if (!matrixFault(m, smallestVolume)) return m;
    const std::optional<osg::Matrixd> flat = flatMatrix(m);
    return flat && !matrixFault(*flat, smallestVolume) ? flat : std::nullopt;
}

} // namespace osgRayTrace::engine
