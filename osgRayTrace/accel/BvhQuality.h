// BvhQuality.h - how much a refitted BVH has suffered from the deformation of its mesh. Layer:
// accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Mesh.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Embree shows nobody its BVH. This stands for it: the triangles in the order of a space-filling
/// curve through the mesh as it was when its BVH was built, in groups of a few. Boxes around the
/// groups grow as those of the BVH do when triangles that were neighbours part [Lauterbach06, sect.
/// 4].
class BvhQuality
{
public:
    explicit BvhQuality(const Mesh& mesh);

    /// Area of the groups' boxes by that of the mesh's box, relative to what it was: 1 for a mesh
    /// that only moved, turned by right angles or was scaled; infinity for one that was a point or
    /// a line, whose order says nothing, and is no more. mesh has the same triangles.
    double degradation(const Mesh& mesh) const;

private:
    double groupArea(const Mesh& mesh) const;

    std::vector<uint32_t> _order; ///< of triangles
    double _areaWhenBuilt = 0.0;
};

/// From here on a build pays: rays then cost about that much more.
constexpr double kDegraded = 1.6;

} // namespace osgRayTrace::engine
