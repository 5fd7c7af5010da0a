// SurfaceTable.h - what shading needs of each instance, and nothing twice. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/scene/Scene.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Pointers into a mesh; null where it lacks the attribute.
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
};

/// The mesh of an instance, and what the instance makes of it.
struct SurfaceRecord : MeshArrays
{
    const Instance* placed = nullptr; ///< its transform; null: positions are in engine space
    uint32_t material = 0;
    uint32_t light = kInvalid;
};

/// Indexed by instance. Put together when asked for: instances of one mesh are many.
class SurfaceTable
{
public:
    SurfaceTable() = default;

    /// The scene is kept by pointers into it. Takes over from a previous table, of the previous
    /// scene, if there is one.
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
