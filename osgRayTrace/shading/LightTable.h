// LightTable.h - the lights of a scene, ready to be sampled. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/shading/PlacedEnvironment.h"
#include "osgRayTrace/shading/RectangleLight.h"
#include "osgRayTrace/shading/SceneLightTree.h"

#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds a point on an area light as seen from a point to be lit.
struct AreaLightSample
{
    Vec3 wi{0.0f}; ///< unit, from the lit point towards the light
    float distance = 0.0f;
    float cosThetaL = 0.0f; ///< cosine at the light, > 0 on an emitting side
    Vec2 uv{0.0f};          ///< texture coordinates of the point, of emissionUvSet
    float pdfW = 0.0f;      ///< [1/sr] with respect to the lit point
    Vec3 point{0.0f};       ///< the point on the light
    Vec3 normal{0.0f};      ///< unit, normal of the light at the point; of either side
    float offset =
        0.0f; ///< distance off the light's plane that is clear of its own surface [length]
};

/// Holds a point on an area light.
struct LightPoint
{
    Vec3 position{0.0f};
    Vec3 normal{0.0f};   ///< unit, of the light's front
    Vec2 uv{0.0f};       ///< texture coordinates of the point, of emissionUvSet
    float offset = 0.0f; ///< along the normal: clears the light's own surface [length]
};

/// Holds the light that a directional, point or spot light sends to a point.
struct DeltaLightSample
{
    Vec3 wi{0.0f}; ///< unit, towards the light
    float distance = kInfinity;
    float attenuation = 0.0f; ///< distance and spot terms [OpenGL21, eq. 2.2, 2.3]
};

/// Up to this number of emitters there is no tree, and all point lights are sampled, as OpenGL
/// does.
constexpr std::size_t kMostWithoutTree = 8;

/// Points on a light are off its plane by this share of the sum of its coordinates, at most. The
/// scale is that of surface points: see surfacesOf.
constexpr float kLightOffsetScale = 32.0f * 0x1p-24f;

/// Holds the lights of a scene, ready to be sampled. The table is built once for a scene; thread
/// safe.
class LightTable
{
public:
    /// Builds the table. previous: table of the last snapshot, whose tables of the environment and
    /// of meshes and whose trees are taken over if possible; or null. materials: for what textures
    /// emit; null if nothing is textured. workers: threads that build the table; null: the calling
    /// thread does.
    explicit LightTable(const Scene& scene, const LightTable* previous = nullptr,
                        const MaterialTable* materials = nullptr, const Workers* workers = nullptr);

    const std::vector<uint32_t>& areaLights() const { return _areaLights; }
    const std::vector<uint32_t>& deltaLights() const { return _deltaLights; }

    /// Returns whether all area lights may be asked for a sample at each surface. Without a tree
    /// this is false only if the emitters are too many to be numbered.
    bool hasFewAreaLights() const { return _areaLights.size() <= kMostWithoutTree; }

    /// Returns the tree over the scene's emitters; null if they are so few that each may be
    /// sampled.
    const SceneLightTree* tree() const { return _tree.get(); }

    /// Returns the delta lights that are not in the tree; all of them without a tree.
    const std::vector<uint32_t>& lightsBesideTree() const
    {
        return _tree ? _lightsBesideTree : _deltaLights;
    }

    /// Returns the number of a light's emitter in the tree; primitive: the triangle of its mesh.
    /// kInvalid: the tree never chooses it.
    uint32_t emitterOf(uint32_t light, uint32_t primitive) const;

    /// Returns all lights in an order in which neighbours are neighbours in space: that of the
    /// tree, by the first of a light's emitters, and then those beside it. Without a tree it is
    /// their own.
    std::vector<uint32_t> lightsInSpace() const;

    /// Returns the triangles of an emitting mesh.
    const EmissiveMesh& mesh(uint32_t light) const { return _meshes[record(light).mesh]; }

    /// Returns an emitting mesh with its own tree; null if the light is none.
    const PlacedLightTree* ownTree(uint32_t light) const
    {
        const uint32_t number = record(light).placed;
        return number == kInvalid ? nullptr : &_placed[number];
    }

    /// Returns the environment, which may be black; null without one.
    const PlacedEnvironment* environment() const { return _environment.get(); }

    /// Returns the environment if surfaces get light from it, else null.
    const PlacedEnvironment* shiningEnvironment() const
    {
        return _environment && !_environment->isBlack() ? _environment.get() : nullptr;
    }

    /// Returns the area of an area light [length^2], by index into Scene::lights; 0: the light is
    /// never sampled.
    float area(uint32_t light) const { return record(light).area; }

    /// Returns the unit normal of the front of a parallelogram.
    Vec3 normal(uint32_t light) const { return record(light).normal; }

    /// Returns the light as a rectangle; null if it is none.
    const RectangleLight* rectangle(uint32_t light) const
    {
        const uint32_t number = record(light).rectangle;
        return number == kInvalid ? nullptr : &_rectangles[number];
    }

    /// Returns how far a point on the light may be off it by rounding [length].
    float pointOffset(uint32_t light) const { return record(light).offset; }

    struct Choice ///< kInvalid without lights
    {
        uint32_t light = kInvalid;
        float pmf = 0.0f;
    };
    /// Chooses one of the area lights in proportion to power. u in [0,1).
    Choice chooseAreaLight(float u) const;
    float areaLightPmf(uint32_t light) const { return record(light).pmf; }

    /// Chooses one of lightsBesideTree() in proportion to their colours. u in [0,1).
    Choice chooseDeltaLight(float u) const;

    /// Returns a point on an area light, uniform by area; nothing if the light is seen from its
    /// dark side. u, v in [0,1).
    std::optional<AreaLightSample> sampleArea(uint32_t light, Vec3 p, float u, float v) const;

    /// Returns the point that sampleArea would look at, seen from nowhere in particular: density 1
    /// / area.
    std::optional<LightPoint> samplePoint(uint32_t light, float u, float v) const;

    /// Returns the density [1/sr] of sampleArea for a ray that hit the light at a distance under a
    /// cosine.
    float pdfArea(uint32_t light, float distance, float cosThetaL) const
    {
        return distance * distance / (record(light).area * cosThetaL);
    }

    /// Returns the density [1/sr] of light samples at p for a ray from there: by solid angle if the
    /// light is a rectangle and that is wide, else as pdfArea.
    float pdfFrom(uint32_t light, Vec3 p, float distance, float cosThetaL) const
    {
        const RectangleLight* own = rectangle(light);
        const float angle = own ? sampledAngle(*own, plainOf(p)) : 0.0f;
        return angle > 0.0f ? 1.0f / angle : pdfArea(light, distance, cosThetaL);
    }

private:
    /// Holds an area light of some power.
    struct Record
    {
        float area = 0.0f;
        float pmf = 0.0f;
        float offset = 0.0f;
        Vec3 normal{0.0f};             ///< parallelograms only
        uint32_t mesh = kInvalid;      ///< index into _meshes
        uint32_t rectangle = kInvalid; ///< index into _rectangles
        uint32_t placed = kInvalid;    ///< index into _placed: the mesh has its own tree
        uint32_t emitters = 0;         ///< index of the first in SceneEmitters
    };
    const Record& record(uint32_t light) const
    {
        OSGRAYTRACE_ASSERT(light < _slots.size() && _slots[light] < _records.size());
        return _records[_slots[light]];
    }
    static Record parallelogram(const Light& light);
    std::optional<AreaLightSample> sampleAt(uint32_t index, Vec3 p, Vec3 q, Vec3 normal, Vec2 uv,
                                            bool twoSided) const;
    using LocalAreas = std::unordered_map<const Mesh*, std::shared_ptr<const EmissiveAreas>>;
    EmissiveMesh meshOf(uint32_t light, const LightTable* previous, LocalAreas& shared,
                        const Workers* workers) const;
    void plantMeshTrees(const LightTable* previous, const MaterialTable* materials,
                        const Workers* workers);
    void plantTree(const LightTable* previous, const MaterialTable* materials,
                   const Workers* workers);
    bool canBeNumbered(std::size_t unplaced) const;
    void dropMeshTrees();

    const Scene* _scene;
    std::vector<uint32_t> _areaLights;
    std::vector<uint32_t> _deltaLights;
    std::unique_ptr<const PlacedEnvironment> _environment;
    std::vector<uint32_t> _slots; ///< a light: index into _records
    std::vector<Record> _records; ///< the first record stands for all lights that are never sampled
    std::vector<float> _cumulative;      ///< an area light: running probability; the last is 1
    std::vector<float> _deltaCumulative; ///< a delta light: running probability; the last is 1
    std::vector<EmissiveMesh> _meshes;   ///< for records of LightKind::Mesh
    std::vector<RectangleLight> _rectangles;
    std::vector<PlacedLightTree> _placed; ///< the meshes with trees of their own, by light
    std::shared_ptr<const SceneLightTree> _tree;
    std::vector<uint32_t> _lightsBesideTree;
};

/// Returns the share of a point light's light that is left at a distance [OpenGL21, eq. 2.2].
/// spotTerm returns what a spot sends along a unit direction over what it sends along its axis
/// [OpenGL21, eq. 2.3].
float distanceTerm(const Light& light, float distance);
float spotTerm(const Light& light, Vec3 direction);

/// Returns the light that a Directional or Point light without size sends to p; light.eyeSpace must
/// have been resolved.
DeltaLightSample sampleDelta(const Light& light, Vec3 p);

} // namespace osgRayTrace::engine
