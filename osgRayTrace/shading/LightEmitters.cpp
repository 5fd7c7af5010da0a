// LightEmitters.cpp - takes lights apart into emitters, with the light that they send. Layer:
// shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightEmitters.h"

#include "osgRayTrace/shading/LightNodes.h"
#include "osgRayTrace/shading/LightTable.h"
#include "osgRayTrace/shading/MaterialTable.h"
#include "osgRayTrace/shading/MeshCorners.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace osgRayTrace::engine
{

namespace
{

/// From here on squares of distances overflow, and a point light is sampled by itself.
constexpr float kFarAway = 1e15f;

/// A triangle keeps this share of the mean that its mesh would have with a white texture: texels
/// between the points that are looked up may shine.
constexpr float kLeastTextureShare = 0.02f;

/// The look-ups along an edge of a textured triangle.
constexpr int kLeastLookups = 3, kMostLookups = 24;

void set(float (&words)[3], Vec3 value)
{
    for (int k = 0; k < 3; ++k)
        words[k] = value[k];
}

Vec3 vectorOf(const float (&words)[3])
{
    return Vec3(words[0], words[1], words[2]);
}

bool emitsUnevenly(const Material& material)
{
    return material.model == MaterialModel::FixedFunction ||
           textureOf(material, kEmissionRole) != kInvalid;
}

/// Returns the mean of a triangle's radiance over a grid of points.
Vec3 meanRadiance(const MaterialTable& materials, uint32_t material, uint32_t uvSet,
                  const EmissiveMesh::Triangle& triangle, float texelsAcross)
{
    const int n = std::clamp(static_cast<int>(texelsAcross), kLeastLookups, kMostLookups);
    Vec3 sum(0.0f);
    int count = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j, ++count)
        {
            const float u = (static_cast<float>(i) + 1.0f / 3.0f) / static_cast<float>(n);
            const float v = (static_cast<float>(j) + 1.0f / 3.0f) / static_cast<float>(n);
            MaterialPoint point;
            point.setUv(uvSet, triangle.ua + u * triangle.uab + v * triangle.uac);
            sum += materials.emission(material, point);
        }
    return sum / static_cast<float>(count);
}

/// Returns how many texels of its emission texture a triangle covers along its longest edge.
float texelsAcross(const Scene& scene, const Material& material,
                   const EmissiveMesh::Triangle& triangle)
{
    const uint32_t texture = textureOf(material, kEmissionRole);
    if (texture >= scene.textures.size()) return static_cast<float>(kMostLookups);
    const Texture& image = *scene.textures[texture];
    const Vec2 size(static_cast<float>(image.width), static_cast<float>(image.height));
    const float longest =
        std::max(glm::length(triangle.uab * size), glm::length(triangle.uac * size));
    return std::max(longest, glm::length((triangle.uac - triangle.uab) * size));
}

/// A part of this many triangles is one piece of work.
constexpr std::size_t kTrianglesAtOnce = 4096;

LightEmitter parallelogram(const Light& light, uint32_t index, float area)
{
    LightEmitter emitter{};
    set(emitter.corner, light.corner);
    set(emitter.edgeU, light.edgeU);
    set(emitter.edgeV, light.edgeV);
    set(emitter.radiance, light.radiance);
    emitter.area = area;
    emitter.light = index;
    emitter.primitive = kInvalid;
    emitter.flags =
        (light.twoSided ? kTwoSided : 0) | (isRectangle(light.edgeU, light.edgeV) ? kRectangle : 0);
    return emitter;
}

float sumAbs(Vec3 v)
{
    return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z);
}

LightEmitter point(const Light& light, uint32_t index)
{
    LightEmitter emitter{};
    set(emitter.corner, light.position);
    set(emitter.edgeU, light.direction);
    set(emitter.edgeV, Vec3(light.spotCosCutoff, light.spotExponent, light.radius));
    set(emitter.radiance,
        Vec3(light.attenuationConstant, light.attenuationLinear, light.attenuationQuadratic));
    // Colours that only OpenGL's equations use count, too: ambient and specular.
    emitter.area =
        kPi * (sumAbs(light.ambient) + sumAbs(light.diffuse) + sumAbs(light.specular)) / 3.0f;
    emitter.light = index;
    std::memcpy(&emitter.primitive, &light.range, sizeof emitter.primitive);
    emitter.flags = kPoint;
    return emitter;
}

/// A spot with an exponent is brightest along its axis; other spots are even up to the cut-off.
LightBounds pointBounds(const LightEmitter& emitter)
{
    constexpr float kEdge = 0.99995f; // cosine of half a degree around the cone of an even spot
    const Vec3 position = vectorOf(emitter.corner);
    const float cutoff = emitter.edgeV[0], exponent = emitter.edgeV[1], radius = emitter.edgeV[2];
    LightBounds bounds;
    bounds.low = position - Vec3(radius);
    bounds.high = position + Vec3(radius);
    bounds.intensity = emitter.area;
    bounds.falloff = glm::abs(vectorOf(emitter.radiance));
    bounds.axis = vectorOf(emitter.edgeU);
    const bool spot = cutoff > -1.0f;
    const float cosCutoff = std::max(cutoff, -1.0f);
    const bool peaked = spot && exponent > 1.0f;
    bounds.cosCone = peaked ? 1.0f : cosCutoff;
    bounds.cosEmission = peaked ? std::max(cosCutoff, 0.0f) : kEdge;
    float range;
    std::memcpy(&range, &emitter.primitive, sizeof range);
    if (range > 0.0f) bounds.range = range;
    return bounds;
}

/// Sets all but the triangle's number.
OSGRAYTRACE_INLINE void setTriangle(LightEmitter& emitter, const MeshCorners& t, Vec3 radiance,
                                    uint32_t light)
{
    set(emitter.corner, t.a);
    set(emitter.edgeU, t.ab);
    set(emitter.edgeV, t.ac);
    emitter.area = static_cast<float>(triangleArea(t.ab, t.ac));
    set(emitter.radiance, radiance);
    emitter.light = light;
    emitter.flags = kTriangle | kTwoSided;
}

/// Returns the emitter of a mesh's triangle.
LightEmitter triangleEmitter(const Scene& scene, const EmissiveMesh& mesh,
                             const MeshRadiance& radiance, std::size_t index, uint32_t light)
{
    const EmissiveMesh::Triangle t = mesh.triangle(index);
    Vec3 shines = radiance.light;
    if (!radiance.isEven())
    {
        const Material& material = scene.materials[radiance.material];
        shines = meanRadiance(*radiance.materials, radiance.material, radiance.uvSet, t,
                              texelsAcross(scene, material, t));
        shines = glm::max(shines, radiance.light * kLeastTextureShare);
    }
    LightEmitter emitter;
    setTriangle(emitter, {t.a, t.ab, t.ac}, shines, light);
    emitter.primitive = t.primitive;
    emitter.flags |= radiance.isEven() ? 0 : kTextured;
    return emitter;
}

/// Returns what boundsEmitter has stored.
LightBounds meshBounds(const LightEmitter& emitter)
{
    LightBounds bounds;
    bounds.low = vectorOf(emitter.corner);
    bounds.high = bounds.low + vectorOf(emitter.edgeU);
    bounds.axis = vectorOf(emitter.edgeV);
    bounds.cosCone = emitter.radiance[0];
    bounds.intensity = emitter.area;
    bounds.twoSided = true;
    return bounds;
}

} // namespace

bool isInTree(const Light& light)
{
    switch (light.kind)
    {
    case LightKind::Parallelogram:
    case LightKind::Mesh:
        return true;
    case LightKind::Point:
        return !light.eyeSpace && glm::dot(glm::abs(light.position), Vec3(1.0f)) < kFarAway;
    case LightKind::Directional:
    case LightKind::Environment:
        return false;
    }
    return false;
}

MeshRadiance meshRadiance(const Scene& scene, const Light& light, const MaterialTable* materials)
{
    const uint32_t number = scene.instances[light.instance].material;
    const Material& material = scene.materials[number];
    if (!materials || !emitsUnevenly(material)) return {nullptr, 0, 0, light.radiance};
    return {materials, number, emissionUvSet(material), light.radiance};
}

void setTriangleEmitters(const Scene& scene, const EmissiveMesh& mesh, const MeshRadiance& radiance,
                         uint32_t light, const uint32_t* indices, std::size_t count,
                         std::size_t first, LightEmitter* emitters)
{
    if (!radiance.isEven())
    {
        for (std::size_t k = 0; k < count; ++k)
            emitters[k] = triangleEmitter(scene, mesh, radiance, indices[k] - first, light);
        return;
    }
    const EmissiveAreas& areas = *mesh.areas;
    const uint32_t* const primitives = areas.primitives.empty() ? nullptr : areas.primitives.data();
    for (std::size_t k = 0; k < count; ++k)
    {
        const auto index = static_cast<uint32_t>(indices[k] - first);
        const uint32_t primitive = primitives ? primitives[index] : index;
        setTriangle(emitters[k], cornersOf(*areas.mesh, mesh.place, primitive), radiance.light,
                    light);
        emitters[k].primitive = primitive;
    }
}

LightEmitters allEmitters(const EmitterSource& source, std::size_t count, const Workers* workers)
{
    LightEmitters emitters(count);
    forEachPart(workers, count, kTrianglesAtOnce,
                [&](std::size_t begin, std::size_t end)
                {
                    std::vector<uint32_t> indices(end - begin);
                    std::iota(indices.begin(), indices.end(), static_cast<uint32_t>(begin));
                    source(indices.data(), indices.size(), emitters.data() + begin);
                });
    return emitters;
}

LightEmitter boundsEmitter(const LightBounds& bounds, uint32_t light)
{
    LightEmitter emitter{};
    set(emitter.corner, bounds.low);
    set(emitter.edgeU, bounds.high - bounds.low);
    set(emitter.edgeV, bounds.axis);
    emitter.area = bounds.intensity;
    emitter.radiance[0] = bounds.cosCone;
    emitter.light = light;
    emitter.primitive = kInvalid;
    emitter.flags = kMesh | kTwoSided;
    return emitter;
}

bool SceneEmitters::operator==(const SceneEmitters& o) const
{
    return parts == o.parts && singles.size() == o.singles.size() &&
           std::equal(singles.begin(), singles.end(), o.singles.begin(),
                      [](const LightEmitter& a, const LightEmitter& b)
                      { return std::memcmp(&a, &b, sizeof a) == 0; });
}

SceneEmitters sceneEmitters(const Scene& scene, const LightTable& table,
                            const MaterialTable* materials)
{
    SceneEmitters all;
    const auto addSingle = [&](const LightEmitter& emitter)
    {
        if (all.parts.empty() || all.parts.back().areas)
            all.parts.push_back({all.size, nullptr, {}, 0, all.singles.size()});
        all.singles.push_back(emitter);
        if (emitter.isMesh()) all.meshes.push_back(all.size);
        ++all.size;
    };
    for (const uint32_t index : table.areaLights())
    {
        const Light& light = scene.lights[index];
        if (light.kind == LightKind::Parallelogram)
            addSingle(parallelogram(light, index, table.area(index)));
        else if (const PlacedLightTree* own = table.ownTree(index))
            addSingle(meshEmitter(*own));
        else
        {
            const EmissiveMesh& mesh = table.mesh(index);
            all.parts.push_back(
                {all.size, mesh.areas, meshRadiance(scene, light, materials), index, 0});
            all.size += mesh.size();
        }
    }
    for (const uint32_t index : table.deltaLights())
        if (isInTree(scene.lights[index])) addSingle(point(scene.lights[index], index));
    return all;
}

EmitterSource emitterSource(const SceneEmitters& from, const Scene& scene, const LightTable& table)
{
    return [&](const uint32_t* indices, std::size_t count, LightEmitter* emitters)
    {
        for (std::size_t k = 0; k < count;)
        {
            const std::size_t index = indices[k];
            const auto next = std::upper_bound(from.parts.begin(), from.parts.end(), index,
                                               [](std::size_t i, const SceneEmitters::Part& p)
                                               { return i < p.first; });
            const SceneEmitters::Part& part = *(next - 1);
            const std::size_t end = next == from.parts.end() ? from.size : next->first;
            const std::size_t begin = k;
            while (k < count && indices[k] >= part.first && indices[k] < end)
                ++k;
            if (part.areas)
                setTriangleEmitters(scene, table.mesh(part.light), part.radiance, part.light,
                                    indices + begin, k - begin, part.first, emitters + begin);
            else
                for (std::size_t i = begin; i < k; ++i)
                    emitters[i] = from.singles[part.single + (indices[i] - part.first)];
        }
    };
}

LightBounds boundsOf(const LightEmitter& emitter)
{
    if (emitter.isPoint()) return pointBounds(emitter);
    if (emitter.isMesh()) return meshBounds(emitter);
    return boundsOf(areaBounds(emitter));
}

} // namespace osgRayTrace::engine
