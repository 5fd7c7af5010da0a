// Outline.h - boxes around the parts of a mesh, and bounds at a place. Layer: accel; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/scene/Mesh.h"

#include <vector>

namespace osgRayTrace::engine
{

struct Box
{
    Vec3 low{kInfinity}, high{-kInfinity};
};

/// Boxes that together hold all triangles of a mesh. A turned ball reaches no farther than before,
/// but the box around the ball does, by up to the root of three: rays would enter instances that
/// they pass by. The number of boxes grows with the number of triangles, up to 64.
class Outline
{
public:
    /// Parts the mesh into boxes; bounds are the bounds of the triangles.
    Outline(const Mesh& mesh, const Box& bounds);

    /// Makes an outline of one box.
    explicit Outline(const Box& bounds);

    /// Returns a box that holds the mesh at the place of the transform, rounding errors included.
    Box placedBounds(const Affine& engineFromLocal) const;

private:
    struct Boxes
    {
        Vec3Lanes centre, half;
    };

    static void extend(const std::vector<Boxes>& parts, const Affine& m, Vec3Lanes& low,
                       Vec3Lanes& high);

    Box _whole;
    std::vector<Boxes> _parts; ///< the parts; the last lanes may repeat one; empty: the whole alone
};

} // namespace osgRayTrace::engine
