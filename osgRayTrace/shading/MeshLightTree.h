// MeshLightTree.h - a light tree over one large emitting mesh, in the mesh's own space. Layer:
// shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/EmissiveMesh.h"
#include "osgRayTrace/shading/LightTree.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// Returns whether a mesh may have a tree of its own: it is large, a transform places it, and
/// importances are the same in its space, as its place stretches all directions alike. The tree
/// does not depend on the place of the mesh, so that a move costs as much as that of a single
/// light.
bool mayHaveOwnTree(const Mesh& mesh, const MeshPlace& place);

/// A tree over the triangles of a mesh, which all instances of the mesh share that shine alike.
struct MeshLightTree
{
    std::shared_ptr<const EmissiveAreas> areas; ///< in the mesh's own space
    MeshRadiance radiance; ///< materials are compared alone; even: of radiance 1
    std::shared_ptr<const LightTree> tree;

    /// Returns the number of a triangle of the mesh; kInvalid: none.
    uint32_t numberOf(uint32_t primitive) const
    {
        const uint32_t index = areas->indexOf(primitive);
        return index == kInvalid ? kInvalid : tree->numberOf(index);
    }
};

/// Makes the tree of a mesh. areas: of at least two triangles. previous: a tree whose shape is
/// taken over if it has as many emitters, and they have not moved far apart; or null. workers: may
/// be null. The scene is not kept.
std::shared_ptr<const MeshLightTree>
meshLightTree(const std::shared_ptr<const EmissiveAreas>& areas, const MeshRadiance& radiance,
              const Scene& scene, const MeshLightTree* previous, const Workers* workers);

/// Holds a mesh with its tree, where it is in the scene.
struct PlacedLightTree
{
    std::shared_ptr<const MeshLightTree> own;
    EmissiveMesh mesh;
    uint32_t light = 0;
    Vec3 radiance{0.0f};    ///< of the light
    Affine localFromEngine; ///< of surface points that are to be lit
    Mat3 localFromNormal;   ///< of their unit normals
    float areaScale = 1.0f; ///< area in the scene over that in the mesh's space

    /// Returns whether both send the same light from the same places.
    bool operator==(const PlacedLightTree& o) const
    {
        return own == o.own && mesh.place == o.mesh.place && light == o.light &&
               radiance == o.radiance;
    }

    /// Returns an emitter of the mesh in engine space.
    LightEmitter emitter(uint32_t number) const;
};

/// Returns a mesh with its tree at a place whose uniformScale() is above 0.
PlacedLightTree placedLightTree(const std::shared_ptr<const MeshLightTree>& own,
                                const EmissiveMesh& mesh, uint32_t light, Vec3 radiance);

/// Returns the emitter that stands for all of a mesh in the tree over the scene.
LightEmitter meshEmitter(const PlacedLightTree& placed);

} // namespace osgRayTrace::engine
