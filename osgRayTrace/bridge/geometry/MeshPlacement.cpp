// MeshPlacement.cpp - chooses the coordinates of a placed mesh, and places it. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/geometry/MeshPlacement.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Local coordinates are moved to their centre if the centre is so many radii away from the origin:
/// otherwise an instance would lose the digits in float that its large coordinates lose.
constexpr double kFarFromOrigin = 64.0;

Affine toAffine(const osg::Matrixd& m)
{
    Affine affine;
    affine.linear = Mat3(Vec3(m(0, 0), m(0, 1), m(0, 2)), Vec3(m(1, 0), m(1, 1), m(1, 2)),
                         Vec3(m(2, 0), m(2, 1), m(2, 2)));
    affine.translation = Vec3(m(3, 0), m(3, 1), m(3, 2));
    return affine;
}

bool isPlaceable(const Affine& affine)
{
    constexpr float kSmallest = 1e-8f, kLargest = 1e8f;
    if (!isFinite(affine.translation)) return false;
    for (int column = 0; column < 3; ++column)
    {
        const float length = glm::length(affine.linear[column]);
        if (!(length >= kSmallest && length <= kLargest)) return false;
    }
    return std::fabs(glm::determinant(glm::dmat3(affine.linear))) > 1e-28;
}

} // namespace

MeshFrame meshFrame(const VertexBounds& bounds)
{
    MeshFrame frame;
    if (bounds.count == 0) return frame;
    const osg::Vec3d centre(bounds.centre().x, bounds.centre().y, bounds.centre().z);
    if (centre.length() > kFarFromOrigin * bounds.radius())
    {
        frame.meshFromLocal.makeTranslate(-centre);
        frame.localFromMesh.makeTranslate(centre);
    }
    LengthCounts lengths;
    lengths.add(largestCoordinate(bounds, frame.meshFromLocal));
    const double unit = lengths.unit(), inverse = 1.0 / unit;
    if (unit == 1.0) return frame;
    frame.meshFromLocal.postMultScale(osg::Vec3d(inverse, inverse, inverse));
    frame.localFromMesh.preMultScale(osg::Vec3d(unit, unit, unit));
    return frame;
}

bool isMirrored(const osg::Matrixd& m)
{
    const osg::Vec3d x(m(0, 0), m(0, 1), m(0, 2)), y(m(1, 0), m(1, 1), m(1, 2)),
        z(m(2, 0), m(2, 1), m(2, 2));
    return (x ^ y) * z < 0.0;
}

bool placeInstance(Instance& instance, const osg::Matrixd& engineFromMesh)
{
    const Affine affine = toAffine(engineFromMesh);
    if (!isPlaceable(affine)) return false;
    instance.placed = true;
    instance.engineFromLocal = affine;
    instance.mirrored = glm::determinant(glm::dmat3(affine.linear)) < 0.0;
    return true;
}

} // namespace osgRayTrace::engine
