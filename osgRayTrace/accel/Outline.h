// Outline.h - boxes around the parts of a mesh, and how far it reaches where it is placed. Layer:
// accel; private to it. SPDX-License-Identifier: MIT
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

    std::vector<Boxes> _boxes; ///< the last lanes may repeat one
    Vec3 _farthest{0.0f};      ///< largest magnitude of coordinates
};

} // namespace osgRayTrace::engine
