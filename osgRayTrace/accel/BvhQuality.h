// BvhQuality.h - how much a refitted BVH has degraded. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Mesh.h"

#include <vector>

namespace osgRayTrace::engine
{

/// A stand-in for the BVH of a mesh, which Embree shows nobody: the triangles in the order of a
/// space-filling curve through the mesh at the time of the build, in groups of a few. When
/// triangles that were neighbours part, the boxes around the groups grow as those of the BVH do
/// [Lauterbach06, sect. 4].
class BvhQuality
{
public:
    explicit BvhQuality(const Mesh& mesh);

    /// Returns the area of the groups' boxes divided by the area of the mesh's box, relative to
    /// that quotient at the time of the build. The result is 1 for a mesh that only moved, turned
    /// by right angles or was scaled. The result is infinity for a mesh that was a point or a line,
    /// whose order says nothing, and is a point or a line no more. mesh must have the same
    /// triangles as the mesh of the build.
    double degradation(const Mesh& mesh) const;

private:
    double groupArea(const Mesh& mesh) const;

    std::vector<uint32_t> _order; ///< the indices of triangles along the curve
    double _areaWhenBuilt = 0.0;
};

/// The degradation from which on a build pays: rays then cost about that much more.
constexpr double kDegraded = 1.6;

} // namespace osgRayTrace::engine
