// SceneExtent.h - the size of a scene, and its unit of length for float arithmetic. Layer: bridge.
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
    /// Adds a length; lengths that are 0 or not finite are left out.
    void add(double length, uint64_t count = 1);

    /// Returns a limit such that length <= limit() holds for all lengths but outliers, which no
    /// float arithmetic can have together with the median; 0 if there are no lengths.
    double limit() const;

    /// Returns Scene::unit for coordinates of these lengths: 1 if floats and Embree can have the
    /// lengths as they are. Small scenes are enlarged to about 1. Large scenes are reduced as
    /// little as possible, because they are the ones with small things in them.
    double unit() const;

    /// Returns whether all lengths are such that unit() is 1 whatever other such lengths there are.
    bool areOrdinary() const;

private:
    LengthCounts ordinary() const;

    std::map<int, uint64_t> _counts; ///< counts by binary exponent
};

/// Returns whether a length is ordinary in the sense of LengthCounts::areOrdinary.
bool isOrdinaryLength(double length);

/// Holds a box around the vertices of a geometry, in the geometry's own coordinates, without
/// outliers.
struct VertexBounds
{
    Vec3d low{0.0}, high{0.0};
    uint64_t count = 0; ///< number of vertices; 0: there is no box

    Vec3d centre() const { return 0.5 * (low + high); }
    double radius() const { return 0.5 * glm::length(high - low); }
};

/// Returns the bounds of any readable array, in double; OSG's own bounds are in float.
VertexBounds vertexBounds(const osg::Array& positions);

/// Returns the largest coordinate of the box under an affine map.
double largestCoordinate(const VertexBounds& bounds, const osg::Matrixd& matrix);

/// Returns whether so few floats lie between the bounds that the rounding shows, as with world
/// coordinates baked into a geometry far from the world's origin.
bool areCoarseInFloat(const VertexBounds& bounds);

} // namespace osgRayTrace::engine
