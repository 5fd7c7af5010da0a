// SceneExtent.h - how large a scene is, and its unit of length for float arithmetic. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <osg/Array>
#include <osg/Matrixd>

#include <cstdint>
#include <map>

namespace osgRayTrace::engine
{

/// Counts lengths by their power of two.
class LengthCounts
{
public:
    /// Lengths that are 0 or not finite are left out.
    void add(double length, uint64_t count = 1);

    /// Such that length <= limit() holds for all lengths but outliers: those that no float
    /// arithmetic can have together with the median. 0 if there are no lengths.
    double limit() const;

    /// Of Scene, for coordinates of these lengths: 1 if floats and Embree can have them as they
    /// are. Small scenes are enlarged to about 1, and large ones are made as small as they have to
    /// be and no smaller: they are the ones with small things in them.
    double unit() const;

    /// All of them are such that unit() is 1 whatever other such lengths there are.
    bool areOrdinary() const;

private:
    LengthCounts ordinary() const;

    std::map<int, uint64_t> _counts; ///< by binary exponent
};

/// Of LengthCounts::areOrdinary.
bool isOrdinaryLength(double length);

/// A box around the vertices of a geometry, in its own coordinates; without outliers.
struct VertexBounds
{
    Vec3d low{0.0}, high{0.0};
    uint64_t count = 0; ///< of vertices; 0: the box is none

    Vec3d centre() const { return 0.5 * (low + high); }
    double radius() const { return 0.5 * glm::length(high - low); }
};

/// Of any readable array, in double: OSG has bounds in float.
VertexBounds vertexBounds(const osg::Array& positions);

/// Largest coordinate of the box under an affine map.
double largestCoordinate(const VertexBounds& bounds, const osg::Matrixd& matrix);

/// Whether so few floats lie between the bounds that they show: world coordinates baked into a
/// geometry far from the world's origin.
bool areCoarseInFloat(const VertexBounds& bounds);

} // namespace osgRayTrace::engine
