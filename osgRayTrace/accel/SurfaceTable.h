// SurfaceTable.h - the data of each instance that shading needs, none of them twice. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/scene/Scene.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Pointers to the arrays of a mesh. A pointer is null if the mesh lacks the attribute.
struct MeshArrays
{
    const UVec3* triangles = nullptr;
    const Vec3* positions = nullptr;
    const Vec3* normals = nullptr;
    const Vec2* uvs = nullptr;
    const Vec2* uvs1 = nullptr;
    const float* rs = nullptr;
    const float* rs1 = nullptr;
    const Vec4* colors = nullptr;
    const Vec4* tangents = nullptr;
    const std::vector<SharedArray<Vec2>>* moreUvs = nullptr; ///< null: there are none

    /// Returns the texture coordinates of a set; null if there are none.
    const Vec2* uvsOfSet(uint32_t set) const
    {
        if (set < kFirstMoreUvs) return set == 0 ? uvs : uvs1;
        const std::size_t more = set - kFirstMoreUvs;
        if (!moreUvs || more >= moreUvs->size() || (*moreUvs)[more].empty()) return nullptr;
        return (*moreUvs)[more].data();
    }
};

/// The mesh of an instance with the transform, the material and the light of the instance.
struct SurfaceRecord : MeshArrays
{
    const Instance* placed = nullptr; ///< owner of the transform; null: already in engine space
    uint32_t material = 0;
    uint32_t light = kInvalid;
};

/// A table indexed by instance. operator[] puts a record together on request, because many
/// instances can share one mesh.
class SurfaceTable
{
public:
    SurfaceTable() = default;

    /// Keeps pointers into the scene, which must outlive the table. If there is a previous scene,
    /// the table takes the pointers of unchanged meshes from the table of that scene.
    SurfaceTable(const Scene& scene, const SurfaceTable* previous, const Scene* previousScene);

    std::size_t size() const { return _size; }
    bool isEmpty(uint32_t mesh) const
    {
        OSGRAYTRACE_ASSERT(mesh < _meshes.size());
        return !_meshes[mesh].triangles;
    }

    SurfaceRecord operator[](std::size_t instance) const
    {
        OSGRAYTRACE_ASSERT(instance < _size);
        const Instance& use = _instances[instance];
        OSGRAYTRACE_ASSERT(use.mesh < _meshes.size());
        return {_meshes[use.mesh], use.placed ? &use : nullptr, use.material, use.light};
    }

private:
    const Instance* _instances = nullptr;
    std::size_t _size = 0;
    std::vector<MeshArrays> _meshes;
};

} // namespace osgRayTrace::engine
