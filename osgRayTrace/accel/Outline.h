// Outline.h - boxes around the parts of a mesh, and how far it reaches where it is placed. Layer:
// accel; private to it.
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

/// Boxes that together hold all triangles of a mesh. A ball that is turned reaches no farther than
/// before, but the box around it does, by up to the root of three: rays would enter instances that
/// they pass by. The more triangles, the more boxes, up to 64.
class Outline
{
public:
    /// bounds: of the triangles.
    Outline(const Mesh& mesh, const Box& bounds);

    /// One box.
    explicit Outline(const Box& bounds);

    /// What holds the mesh where the transform puts it, rounding errors included.
    Box placedBounds(const Affine& engineFromLocal) const;

private:
    struct Boxes
    {
        Vec3Lanes centre, half;
    };

    static void extend(const std::vector<Boxes>& parts, const Affine& m, Vec3Lanes& low,
                       Vec3Lanes& high);

    Box _whole;
    std::vector<Boxes> _parts; ///< the last lanes may repeat one; empty: there is the whole alone
};

} // namespace osgRayTrace::engine
