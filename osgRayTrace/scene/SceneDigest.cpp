// SceneDigest.cpp - hashes the values of a scene, member by member. Layer: scene.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/scene/SceneDigest.h"

#include "osgRayTrace/base/MemoryHash.h"
#include "osgRayTrace/scene/Scene.h"

#include <type_traits>
#include <vector>

namespace osgRayTrace::engine
{

namespace
{

#if defined(__x86_64__) && defined(__linux__)
// Whoever adds a member to one of these adds it below, too, unless images do not depend on it.
static_assert(sizeof(Mesh) == 360 && sizeof(Instance) == 72);
static_assert(sizeof(MaterialDetail) == 764 && sizeof(Material) == 616 && sizeof(Fog) == 28 &&
              sizeof(Medium) == 48 && sizeof(Atmosphere) == 80 && sizeof(Volume) == 240);
static_assert(sizeof(Texture) == 160 && sizeof(TextureMapping) == 136);
static_assert(sizeof(Light) == 256 && sizeof(Environment) == 56);
#endif

/// Joins values to one number, in the order in which they come.
class Hasher
{
public:
    /// Adds numbers, vectors, matrices and enumerations, which have no padding.
    template <typename... Values> void add(const Values&... values) { (addOne(values), ...); }

    template <typename T> void addArray(const T* values, std::size_t count)
    {
        join(count);
        join(memoryHash(values, count * sizeof(T)));
    }
    template <typename T> void addArray(const std::vector<T>& values)
    {
        addArray(values.data(), values.size());
    }
    template <typename T> void addArray(const SharedArray<T>& values)
    {
        addArray(values.data(), values.size());
    }

    uint64_t value() const { return _value; }

private:
    template <typename T> void addOne(const T& value)
    {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
        join(memoryHash(&value, sizeof value));
    }
    void join(uint64_t value) { _value = fold(_value, value); }

    uint64_t _value = 1;
};

void addMesh(const Mesh& mesh, Hasher& hasher)
{
    hasher.addArray(mesh.positions);
    hasher.addArray(mesh.triangles);
    hasher.addArray(mesh.normals);
    hasher.addArray(mesh.uvs);
    hasher.addArray(mesh.uvs1);
    hasher.addArray(mesh.rs);
    hasher.addArray(mesh.rs1);
    hasher.addArray(mesh.colors);
    hasher.addArray(mesh.tangents);
    for (std::size_t i = 0; i < mesh.moreUvs.size(); ++i)
    {
        if (mesh.moreUvs[i].empty()) continue;
        hasher.add(static_cast<uint64_t>(i));
        hasher.addArray(mesh.moreUvs[i]);
    }
}

void addInstance(const Instance& instance, Hasher& hasher)
{
    hasher.add(instance.mesh, instance.material, instance.light, instance.placed,
               instance.mirrored);
    if (instance.placed) hasher.add(instance.engineFromLocal);
}

void addMapping(const TextureMapping& mapping, Hasher& hasher)
{
    hasher.add(mapping.coordinates, mapping.transformed, mapping.partly);
    if (mapping.transformed) hasher.add(mapping.matrix);
    if (mapping.partly) hasher.add(mapping.own, mapping.ownMatrix);
}

void addFace(const FaceColors& face, Hasher& hasher)
{
    hasher.add(face.ambient, face.diffuse, face.specular, face.emission, face.shininess,
               face.alpha);
}

void addMedium(const Medium& m, Hasher& hasher)
{
    hasher.add(m.sigmaA, m.sigmaS, m.emission, m.anisotropy, m.dropletSize, m.priority);
}

void addDetail(const MaterialDetail& d, Hasher& hasher)
{
    addMedium(d.interior, hasher);
    hasher.add(d.vertexColors, d.thinWalled, d.specular, d.specularColor, d.clearcoat,
               d.clearcoatRoughness, d.clearcoatNormalScale, d.sheenColor, d.sheenRoughness,
               d.anisotropy, d.anisotropyRotation, d.diffuseTransmission,
               d.diffuseTransmissionColor, d.iridescence, d.iridescenceIor, d.iridescenceThickness,
               d.normalScale, d.subsurface, d.subsurfaceRadius, d.textures);
    for (const TexturePlace& place : d.places)
        hasher.add(place.set, place.u, place.v, place.offset);
}

void addMaterial(const Material& m, Hasher& hasher)
{
    hasher.add(m.model, m.ambient, m.diffuse, m.specular, m.shininess, m.lit, m.twoSidedLighting,
               m.lightMask, m.vertexColorUse, m.textureEnvironment, m.environmentColor);
    hasher.addArray(m.moreLights);
    addMapping(m.mapping, hasher);
    hasher.add(m.second.texture, m.second.environment, m.second.environmentColor);
    addMapping(m.second.mapping, hasher);
    hasher.add(m.separateSpecular, m.localViewer, m.hasBack);
    if (m.hasBack) addFace(m.back, hasher);
    hasher.add(m.baseColor, m.metallic, m.roughness, m.transmission, m.ior, m.emission);
    hasher.add(m.detail != nullptr);
    if (m.detail) addDetail(*m.detail, hasher);
    hasher.add(m.alpha, m.blended, m.alphaTest, m.alphaReference, m.culling, m.cullsAllRays,
               m.clockwise);
    hasher.add(m.fog.mode, m.fog.radial, m.fog.color, m.fog.density, m.fog.start, m.fog.end);
    hasher.add(m.baseColorTexture, m.metallicRoughnessTexture, m.transmissionTexture,
               m.emissionTexture);
}

void addTexture(const Texture& t, Hasher& hasher)
{
    hasher.add(t.width, t.depth, t.height, t.cube, t.hasColor, t.hasAlpha, t.opaque, t.border,
               t.decodeSrgb, t.linearFilter, t.wrapS, t.wrapT, t.wrapR, t.blendsMips);
    hasher.addArray(t.bytes);
    hasher.addArray(t.floats);
    hasher.add(t.mips.size());
    for (const Texture& mip : t.mips)
        addTexture(mip, hasher);
}

void addLight(const Light& l, Hasher& hasher)
{
    hasher.add(l.kind, l.number, l.eyeSpace, l.castsShadows, l.ambient, l.diffuse, l.specular,
               l.position, l.direction, l.attenuationConstant, l.attenuationLinear,
               l.attenuationQuadratic, l.range, l.spotExponent, l.spotCosCutoff, l.radius, l.sine,
               l.corner, l.edgeU, l.edgeV, l.radiance, l.twoSided, l.instance);
    hasher.add(l.environment.image != nullptr, l.environment.mapFromEngine, l.environment.visible);
    if (!l.environment.image) return;
    hasher.add(l.environment.image->width, l.environment.image->height);
    hasher.addArray(l.environment.image->radiance);
}

void addVolume(const Volume& v, Hasher& hasher)
{
    hasher.add(v.image->width, v.image->height, v.image->depth, v.image->channels);
    hasher.addArray(v.image->bytes);
    hasher.addArray(v.image->floats);
    hasher.addArray(v.transfer);
    hasher.add(v.transferScale, v.transferOffset, v.imageFromEngine, v.tileFromEngine, v.law);
    addMedium(v.medium, hasher);
    hasher.add(v.transparency, v.cutoff, v.sampleRatio, v.sampleLength, v.lit, v.tint);
}

} // namespace

uint64_t sceneDigest(const Scene& scene)
{
    Hasher hasher;
    hasher.add(scene.origin, scene.unit, scene.ambient, scene.background, scene.displayReferred);
    hasher.add(scene.meshes.size(), scene.instances.size(), scene.materials.size(),
               scene.textures.size(), scene.lights.size());
    for (const auto& mesh : scene.meshes)
        addMesh(*mesh, hasher);
    for (const Instance& instance : scene.instances)
        addInstance(instance, hasher);
    for (const Material& material : scene.materials)
        addMaterial(material, hasher);
    for (const auto& texture : scene.textures)
        addTexture(*texture, hasher);
    for (const Light& light : scene.lights)
        addLight(light, hasher);
    hasher.add(scene.fogUse, scene.ground, scene.atmosphere != nullptr);
    if (scene.atmosphere)
    {
        addMedium(scene.atmosphere->medium, hasher);
        hasher.add(scene.atmosphere->centre, scene.atmosphere->radius,
                   scene.atmosphere->scaleHeight, scene.atmosphere->up);
    }
    hasher.add(scene.volumes.size());
    for (const Volume& volume : scene.volumes)
        addVolume(volume, hasher);
    return hasher.value();
}

} // namespace osgRayTrace::engine
