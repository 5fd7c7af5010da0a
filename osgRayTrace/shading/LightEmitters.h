// LightEmitters.h - the parts of lights between which a LightTree chooses. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/LargeArray.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/shading/EmissiveMesh.h"
#include "osgRayTrace/shading/LightBounds.h"
#include "osgRayTrace/shading/RectangleLight.h"

#include <functional>
#include <vector>

namespace osgRayTrace::engine
{

class LightTable;
class MaterialTable;

/// Bits of LightEmitter::flags. An emitter without the first two and
/// the last is a parallelogram.
constexpr uint32_t kTriangle = 1; ///< of a mesh that emits; shines to both sides
constexpr uint32_t kPoint = 2;    ///< point or spot light
constexpr uint32_t kTwoSided = 4;
constexpr uint32_t kTextured = 8;   ///< the radiance depends on the point
constexpr uint32_t kRectangle = 16; ///< a parallelogram with right angles
constexpr uint32_t kMesh = 32;      ///< stands for a mesh that has a tree of its own

/// A parallelogram, a triangle or a point light, in words that sixteen lanes gather. Emitters of
/// equal words have equal bounds. The members of a point light other than its place are its axis
/// (edgeU), its cut-off, exponent and radius (edgeV), its attenuation (radiance), its brightness
/// (area) and the bits of its range (primitive). Those of a mesh are the lowest corner of its box,
/// the edges of the box (edgeU), the axis of its normals (edgeV), the cosine of their cone
/// (radiance) and its intensity (area).
struct LightEmitter
{
    float corner[3];
    float edgeU[3], edgeV[3];
    float area;
    float radiance[3]; ///< of a textured triangle: the mean
    uint32_t light;
    uint32_t primitive; ///< triangle of the mesh
    uint32_t flags;

    bool isPoint() const { return (flags & kPoint) != 0; }
    bool isMesh() const { return (flags & kMesh) != 0; }
};
static_assert(sizeof(LightEmitter) == 64, "an emitter is a cache line");

using LightEmitters = UnclearedArray<LightEmitter>;

/// Returns an emitter of kRectangle as a rectangle.
OSGRAYTRACE_INLINE RectangleLight rectangleLight(const LightEmitter& e)
{
    return rectangleLight({e.corner[0], e.corner[1], e.corner[2]},
                          {e.edgeU[0], e.edgeU[1], e.edgeU[2]},
                          {e.edgeV[0], e.edgeV[1], e.edgeV[2]});
}

/// Returns whether a LightTree chooses a light: directional lights, environments, lights of a view
/// and those so far away that squares of distances are no floats have samples of their own.
bool isInTree(const Light& light);

/// What the triangles of a mesh shine.
struct MeshRadiance
{
    const MaterialTable* materials = nullptr; ///< null: all triangles shine alike
    uint32_t material = 0;                    ///< 0 if they shine alike
    uint32_t uvSet = 0;                       ///< 0 if they shine alike
    Vec3 light{0.0f};                         ///< mean radiance

    bool isEven() const { return materials == nullptr; }
    bool operator==(const MeshRadiance& o) const
    {
        return materials == o.materials && material == o.material && uvSet == o.uvSet &&
               light == o.light;
    }
};

/// Returns what the triangles of a light's mesh shine. materials: null if nothing is textured.
MeshRadiance meshRadiance(const Scene& scene, const Light& light, const MaterialTable* materials);

/// Sets emitters[k] to that of the mesh's triangle of index indices[k] - first, for all k below
/// count.
void setTriangleEmitters(const Scene& scene, const EmissiveMesh& mesh, const MeshRadiance& radiance,
                         uint32_t light, const uint32_t* indices, std::size_t count,
                         std::size_t first, LightEmitter* emitters);

/// Sets emitters[k] to the emitter of index indices[k], for all k below count. Thread safe.
using EmitterSource =
    std::function<void(const uint32_t* indices, std::size_t count, LightEmitter* emitters)>;

/// Returns the emitters of all indices below count. workers: may be null.
LightEmitters allEmitters(const EmitterSource& source, std::size_t count, const Workers* workers);

/// Returns an emitter of kMesh with these bounds, of areas that shine to both sides.
LightEmitter boundsEmitter(const LightBounds& bounds, uint32_t light);

/// What the emitters of a scene are made of: the parts of all lights with power that isInTree, a
/// mesh with a tree of its own as one part. Equal sources have equal emitters.
struct SceneEmitters
{
    /// Emitters of consecutive indices: the triangles of a mesh, or some of the others.
    struct Part
    {
        std::size_t first = 0;                      ///< index of the first emitter
        std::shared_ptr<const EmissiveAreas> areas; ///< null: the part is not a mesh
        MeshRadiance radiance;
        uint32_t light = 0;     ///< of a mesh
        std::size_t single = 0; ///< of others: index into singles

        bool operator==(const Part& o) const
        {
            return first == o.first && areas == o.areas && radiance == o.radiance &&
                   light == o.light && single == o.single;
        }
    };
    std::vector<Part> parts;           ///< in order
    std::vector<LightEmitter> singles; ///< what is no triangle
    std::vector<std::size_t> meshes;   ///< indices of those that stand for meshes, in order
    std::size_t size = 0;              ///< how many emitters there are

    bool operator==(const SceneEmitters& o) const;
};

/// Returns what the emitters of a scene are made of. materials: null if nothing is textured.
SceneEmitters sceneEmitters(const Scene& scene, const LightTable& table,
                            const MaterialTable* materials);

/// Returns the emitters of a scene, all of which must outlive what is returned.
EmitterSource emitterSource(const SceneEmitters& from, const Scene& scene, const LightTable& table);

/// Returns bounds of the light that an emitter sends out.
LightBounds boundsOf(const LightEmitter& emitter);

} // namespace osgRayTrace::engine
