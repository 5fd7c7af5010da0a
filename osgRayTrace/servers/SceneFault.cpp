// SceneFault.cpp - why a scene that came from elsewhere cannot be traced. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/SceneFault.h"

#include "osgRayTrace/scene/VolumeLimits.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

bool isFinitePosition(const Vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isFiniteColor(const Vec4& v)
{
    return isFinitePosition(Vec3(v)) && std::isfinite(v.w);
}

bool fits(std::size_t values, std::size_t positions)
{
    return values == 0 || values == positions;
}

/// Returns whether a medium is one that the library makes: finite, and not negative.
bool isUsable(const Medium& m)
{
    const auto isSum = [](const Vec3& v)
    { return isFinitePosition(v) && v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f; };
    return isSum(m.sigmaA) && isSum(m.sigmaS) && isSum(m.emission) && m.anisotropy > -1.0f &&
           m.anisotropy < 1.0f && std::isfinite(m.dropletSize) && m.dropletSize >= 0.0f;
}

/// Returns whether a volume is one that the library makes, but for its place.
bool isUsable(const Volume& v)
{
    return v.image && isUsable(v.medium) && v.transfer.size() <= kMostTransferEntries &&
           std::all_of(v.transfer.begin(), v.transfer.end(), isFiniteColor) &&
           std::isfinite(v.transferScale) && std::isfinite(v.transferOffset) &&
           std::isfinite(v.transparency) && v.transparency >= 0.0f && std::isfinite(v.cutoff) &&
           std::isfinite(v.sampleRatio) && v.sampleRatio > 0.0f && std::isfinite(v.sampleLength) &&
           v.sampleLength > 0.0f && isFinitePosition(v.tint);
}

/// Returns whether the texels are as many as the sizes say.
bool isWhole(const Texture& t)
{
    constexpr int kMostTexels = 1 << 20; // along a side, so that products fit
    if (t.width < 0 || t.height < 0 || t.depth < 0) return false;
    if (t.width > kMostTexels || t.height > kMostTexels || t.depth > kMostTexels) return false;
    if (t.bytes.empty() == t.floats.empty()) return false;
    const uint64_t texels = uint64_t(t.width) * static_cast<uint64_t>(t.height) *
                            static_cast<uint64_t>(std::max(t.depth, 1));
    return std::max(t.bytes.size(), t.floats.size()) == 4 * texels;
}

} // namespace

const char* meshFault(const Mesh& mesh)
{
    const std::size_t positions = mesh.positions.size();
    if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), isFinitePosition))
        return "a mesh has a position that is not finite";
    const bool inRange = std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                                     [&](const UVec3& t) {
                                         return std::max({t.x, t.y, t.z}) < positions;
                                     });
    if (!inRange) return "a mesh has a triangle of vertices that it lacks";
    const bool fitting =
        fits(mesh.normals.size(), positions) && fits(mesh.uvs.size(), positions) &&
        fits(mesh.uvs1.size(), positions) && fits(mesh.rs.size(), positions) &&
        fits(mesh.rs1.size(), positions) && fits(mesh.colors.size(), positions) &&
        fits(mesh.tangents.size(), positions) &&
        std::all_of(mesh.moreUvs.begin(), mesh.moreUvs.end(),
                    [&](const SharedArray<Vec2>& uvs) { return fits(uvs.size(), positions); });
    return fitting ? nullptr : "the arrays of a mesh are of different lengths";
}

const char* textureFault(const Texture& texture)
{
    const char* const fault = "a texture is not of the size that it says";
    if (!isWhole(texture)) return fault;
    if (texture.cube && (texture.depth != 0 || texture.height != int64_t(6) * texture.width))
        return fault;
    if (!texture.mips.empty() && (texture.cube || texture.depth != 0)) return fault;
    for (const Texture& mip : texture.mips)
        if (!isWhole(mip) || mip.cube || mip.depth != 0) return fault;
    return nullptr;
}

const char* environmentFault(const EnvironmentImage& image)
{
    constexpr int kMost = 1 << 20;
    constexpr float kBrightest = 1e30f;
    if (image.width < 1 || image.height < 1 || image.width > kMost || image.height > kMost ||
        image.radiance.size() !=
            static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
        return "an environment is not of the size that it says";
    const auto isRadiance = [](const Vec3& v)
    {
        return v.x >= 0.0f && v.y >= 0.0f && v.z >= 0.0f && v.x <= kBrightest &&
               v.y <= kBrightest && v.z <= kBrightest;
    };
    return std::all_of(image.radiance.begin(), image.radiance.end(), isRadiance)
               ? nullptr
               : "an environment has radiance out of range";
}

const char* volumeFault(const VolumeImage& image)
{
    const int most = std::max({image.width, image.height, image.depth});
    const bool sides = image.width > 0 && image.height > 0 && image.depth > 0 &&
                       most <= kMostVoxelSide && // so that products fit
                       (image.channels == 1 || image.channels == 4);
    if (!sides || image.bytes.empty() == image.floats.empty())
        return "a volume is not of the size that it says";
    const uint64_t values = uint64_t(image.width) * static_cast<uint64_t>(image.height) *
                            static_cast<uint64_t>(image.depth) *
                            static_cast<uint64_t>(image.channels);
    if (std::max(image.bytes.size(), image.floats.size()) != values)
        return "a volume is not of the size that it says";
    return std::all_of(image.floats.begin(), image.floats.end(),
                       [](float v) { return std::fabs(v) <= kLargestVoxel; })
               ? nullptr
               : "a volume has a value that is out of range";
}

const char* sceneFault(const Scene& scene)
{
    const auto isIndex = [](uint32_t index, std::size_t size)
    { return index == kInvalid || index < size; };
    const std::size_t textures = scene.textures.size();
    if (!(std::isfinite(scene.unit) && scene.unit > 0.0) || !std::isfinite(scene.origin.x) ||
        !std::isfinite(scene.origin.y) || !std::isfinite(scene.origin.z))
        return "a scene has no place";
    if (scene.materials.empty()) return "a scene has no materials";
    for (const Instance& instance : scene.instances)
        if (instance.mesh >= scene.meshes.size() || instance.material >= scene.materials.size() ||
            !isIndex(instance.light, scene.lights.size()))
            return "an instance names what the scene lacks";
    for (const Material& m : scene.materials)
    {
        bool known = isIndex(m.second.texture, textures);
        for (uint32_t role = 0; role < kTextureRoles; ++role)
        {
            known = known && isIndex(textureOf(m, static_cast<TextureRole>(role)), textures);
            known = known && (!m.detail || (isIndex(m.detail->textures[role], textures) &&
                                            m.detail->places[role].set < kUvSets));
        }
        if (!known) return "a material names a texture that the scene lacks";
    }
    for (const Material& m : scene.materials)
        if (m.detail && !isUsable(m.detail->interior))
            return "a material has a medium out of range";
    if (scene.atmosphere &&
        !(isUsable(scene.atmosphere->medium) && isFinitePosition(scene.atmosphere->centre) &&
          std::isfinite(scene.atmosphere->radius) && std::isfinite(scene.atmosphere->scaleHeight) &&
          isFinitePosition(scene.atmosphere->up)))
        return "the medium around the scene is out of range";
    if (scene.volumes.size() > kMostVolumes) return "a scene has too many volumes";
    for (const Volume& volume : scene.volumes)
        if (!isUsable(volume)) return "a volume is out of range";
    for (const Light& light : scene.lights)
    {
        const bool needsInstance = light.kind == LightKind::Mesh;
        if (light.kind == LightKind::Environment && !light.environment.image)
            return "an environment light has no image";
        if (!isIndex(light.instance, scene.instances.size()) ||
            (needsInstance && light.instance == kInvalid))
            return "a light names an instance that the scene lacks";
    }
    // Rays that meet an instance look its triangles up in the table of its light.
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
    {
        if (scene.instances[i].light == kInvalid) continue;
        const Light& light = scene.lights[scene.instances[i].light];
        const bool isArea = light.kind == LightKind::Mesh || light.kind == LightKind::Parallelogram;
        if (!isArea || light.instance != i) return "an instance names a light that is not its own";
    }
    return nullptr;
}

} // namespace osgRayTrace::engine
