// MeshLightTree.cpp - makes trees of meshes, and finds where they are in the scene. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/MeshLightTree.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Boxes are widened by this share of their coordinates, and cones by this much of their cosine,
/// against rounding and for transforms that are uniform up to rounding.
constexpr float kBoxSlack = 1e-5f, kConeSlack = 1e-3f;

/// Returns the number of the emitter of each triangle of the mesh.
std::vector<uint32_t> numbersOf(const LightTree& tree, std::size_t triangles)
{
    std::vector<uint32_t> numbers(triangles, kInvalid);
    for (uint32_t k = 0; k < tree.size(); ++k)
        numbers[tree.emitter(k).primitive] = k;
    return numbers;
}

} // namespace

bool mayHaveOwnTree(const Mesh& mesh, const MeshPlace& place)
{
    return place.placed && mesh.triangles.size() >= kLeastOwnTree &&
           uniformScale(place.engineFromLocal.linear) > 0.0f;
}

std::shared_ptr<const MeshLightTree>
meshLightTree(const std::shared_ptr<const EmissiveAreas>& areas, const MeshRadiance& radiance,
              const Scene& scene, const MeshLightTree* previous, const Workers* workers)
{
    auto own = std::make_shared<MeshLightTree>();
    own->areas = areas;
    own->radiance = radiance;
    const EmissiveMesh mesh{areas, {}, radiance.uvSet};
    LightEmitters emitters(mesh.size());
    setTriangleEmitters(scene, mesh, radiance, 0, emitters.data(), workers);
    own->tree = LightTree::after(previous ? previous->tree : nullptr, emitters, workers);
    own->numbers = numbersOf(*own->tree, areas->mesh->triangles.size());
    return own;
}

LightEmitter PlacedLightTree::emitter(uint32_t number) const
{
    const LightEmitter& local = own->tree->emitter(number);
    const bool even = own->radiance.isEven();
    const Vec3 shines =
        even ? radiance : Vec3(local.radiance[0], local.radiance[1], local.radiance[2]);
    return triangleEmitter(mesh.triangleOf(local.primitive), light, shines, !even);
}

PlacedLightTree placedLightTree(const std::shared_ptr<const MeshLightTree>& own,
                                const EmissiveMesh& mesh, uint32_t light, Vec3 radiance)
{
    PlacedLightTree placed{own, mesh, light, radiance, {}, Mat3(1.0f)};
    const Affine& place = mesh.place.engineFromLocal;
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(place.linear));
    placed.localFromEngine.linear = Mat3(inverse);
    placed.localFromEngine.translation = Vec3(-(inverse * Vec3d(place.translation)));
    // The transform is a rotation, perhaps a reflection, and a scale.
    placed.localFromNormal = Mat3(inverse * double(uniformScale(place.linear)));
    return placed;
}

LightEmitter meshEmitter(const PlacedLightTree& placed)
{
    LightBounds bounds = placed.own->tree->bounds();
    const Affine& place = placed.mesh.place.engineFromLocal;
    const float scale = uniformScale(place.linear);
    placeBox(place, bounds.low, bounds.high);
    const Vec3 slack = kBoxSlack * glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    bounds.low -= slack;
    bounds.high += slack;
    bounds.axis = glm::normalize(place.linear * bounds.axis);
    bounds.cosCone = std::max(bounds.cosCone - kConeSlack, -1.0f);
    bounds.intensity *=
        scale * scale * (placed.own->radiance.isEven() ? luminance(placed.radiance) : 1.0f);
    return boundsEmitter(bounds, placed.light);
}

} // namespace osgRayTrace::engine
