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

void placeWords(const Mat3& linear, float (&words)[3])
{
    const Vec3 placed = linear * Vec3(words[0], words[1], words[2]);
    for (int k = 0; k < 3; ++k)
        words[k] = placed[k];
}

} // namespace

bool mayHaveOwnTree(const Mesh& mesh, const MeshPlace& place)
{
    return place.placed && mesh.triangles.size() >= kLeastLargeMesh &&
           uniformScale(place.engineFromLocal.linear) > 0.0f;
}

std::shared_ptr<const MeshLightTree>
meshLightTree(const std::shared_ptr<const EmissiveAreas>& areas, const MeshRadiance& radiance,
              const Scene& scene, const MeshLightTree* previous, const Workers* workers)
{
    auto own = std::make_shared<MeshLightTree>();
    own->areas = areas;
    own->radiance = radiance;
    EmissiveMesh mesh;
    mesh.areas = areas;
    mesh.uvSet = radiance.uvSet;
    const auto source = [&](const uint32_t* indices, std::size_t count, LightEmitter* emitters)
    { setTriangleEmitters(scene, mesh, radiance, 0, indices, count, 0, emitters); };
    own->tree =
        LightTree::after(previous ? previous->tree.get() : nullptr, source, mesh.size(), workers);
    return own;
}

LightEmitter PlacedLightTree::emitter(uint32_t number) const
{
    LightEmitter emitter = own->tree->emitter(number);
    const Affine& place = mesh.place.engineFromLocal;
    const Vec3 corner =
        transformPoint(place, Vec3(emitter.corner[0], emitter.corner[1], emitter.corner[2]));
    for (int k = 0; k < 3; ++k)
        emitter.corner[k] = corner[k];
    placeWords(place.linear, emitter.edgeU);
    placeWords(place.linear, emitter.edgeV);
    emitter.area *= areaScale;
    emitter.light = light;
    for (int k = 0; own->radiance.isEven() && k < 3; ++k)
        emitter.radiance[k] = radiance[k];
    return emitter;
}

PlacedLightTree placedLightTree(const std::shared_ptr<const MeshLightTree>& own,
                                const EmissiveMesh& mesh, uint32_t light, Vec3 radiance)
{
    PlacedLightTree placed{own, mesh, light, radiance, {}, Mat3(1.0f), 1.0f};
    const Affine& place = mesh.place.engineFromLocal;
    const float scale = uniformScale(place.linear);
    placed.areaScale = scale * scale;
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(place.linear));
    placed.localFromEngine.linear = Mat3(inverse);
    placed.localFromEngine.translation = Vec3(-(inverse * Vec3d(place.translation)));
    // The transform is a rotation, perhaps a reflection, and a scale.
    placed.localFromNormal = Mat3(inverse * double(scale));
    return placed;
}

LightEmitter meshEmitter(const PlacedLightTree& placed)
{
    LightBounds bounds = placed.own->tree->bounds();
    const Affine& place = placed.mesh.place.engineFromLocal;
    placeBox(place, bounds.low, bounds.high);
    const Vec3 slack = kBoxSlack * glm::max(glm::abs(bounds.low), glm::abs(bounds.high));
    bounds.low -= slack;
    bounds.high += slack;
    bounds.axis = glm::normalize(place.linear * bounds.axis);
    bounds.cosCone = std::max(bounds.cosCone - kConeSlack, -1.0f);
    bounds.intensity *= placed.areaScale;
    if (placed.own->radiance.isEven()) bounds.intensity *= luminance(placed.radiance);
    return boundsEmitter(bounds, placed.light);
}

} // namespace osgRayTrace::engine
