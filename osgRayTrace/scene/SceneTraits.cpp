// SceneTraits.cpp - finds what a scene needs in one look through it. Layer: scene.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/scene/SceneTraits.h"

#include "osgRayTrace/scene/FogMedium.h"

namespace osgRayTrace::engine
{

namespace
{

/// Below this perceptual roughness a surface reflects like a mirror: alpha = 0.03^2 < 1e-3.
constexpr float kMirrorRoughness = 0.0316f;

/// Below this perceptual roughness metal is glossy: alpha = 0.5^2 is kRoughAlpha.
constexpr float kRoughRoughness = 0.5f;

/// Bodies that only absorb need no more than Beer's law between the two sides of their surface,
/// unless light passes that surface unbent and so shines into them.
void addMedium(const Material& material, const MaterialDetail& detail, SceneTraits& traits)
{
    const bool opens = material.transmission > 0.0f || detail.diffuseTransmission > 0.0f;
    if (!opens || detail.thinWalled) return;
    traits.scattering |= detail.interior.scatters();
    traits.glowing |= detail.interior.emits();
    traits.veils |= isInterface(material);
    traits.media |= detail.interior.scatters() || detail.interior.emits() ||
                    detail.interior.priority != 0 || isInterface(material);
}

void addMaterial(const Material& material, SceneTraits& traits)
{
    if (isInvisible(material)) return;
    traits.textures |= isTextured(material);
    traits.blended |= material.blended;
    traits.fog |= material.fog.mode != FogMode::None;
    traits.vertexColors |= material.vertexColorUse != VertexColorUse::None;
    if (material.model == MaterialModel::FixedFunction)
    {
        traits.fixedFunction = true;
        return;
    }
    bool reflects = material.metallic > 0.0f || material.ior != 1.0f;
    bool transmits = material.transmission > 0.0f;
    if (const MaterialDetail* detail = material.detail.get())
    {
        reflects |= detail->iridescence > 0.0f;
        transmits |= detail->diffuseTransmission > 0.0f;
        traits.vertexColors |= detail->vertexColors;
        traits.normalMaps |= hasNormalMap(material) || hasCoatNormals(material);
        traits.panes |= detail->thinWalled && material.transmission > 0.0f;
        traits.attenuation |= detail->absorbs();
        addMedium(material, *detail, traits);
        traits.subsurface |= hasSubsurface(material);
        traits.specular |=
            detail->clearcoat > 0.0f && detail->clearcoatRoughness < kMirrorRoughness;
    }
    const bool isSeen = material.culling != FaceCulling::FrontAndBack; // by camera rays
    traits.physical |= isSeen && (reflects || transmits || material.baseColor != Vec3(0.0f));
    traits.specular |= reflects && material.roughness < kMirrorRoughness;
    traits.glossy |= material.metallic >= 1.0f && material.roughness < kRoughRoughness;
    traits.transmission |=
        material.transmission > 0.0f && !isMetal(material) && !isInterface(material);
}

} // namespace

bool isMipmapped(const Material& material, const Scene& scene)
{
    const auto hasMips = [&scene](uint32_t texture)
    { return texture < scene.textures.size() && !scene.textures[texture]->mips.empty(); };
    bool mipmapped = hasMips(material.second.texture);
    for (uint32_t role = 0; role < kTextureRoles; ++role)
        mipmapped |= !isNormalRole(role) && hasMips(textureOf(material, TextureRole(role)));
    return mipmapped;
}

SceneTraits sceneTraits(const Scene& scene, const SceneTraits* alike)
{
    SceneTraits traits;
    if (alike)
    {
        traits.instances = alike->instances;
        traits.smoothNormals = alike->smoothNormals;
        traits.triangles = alike->triangles;
    }
    else
        for (const Instance& instance : scene.instances)
        {
            const Mesh& mesh = *scene.meshes[instance.mesh];
            traits.instances |= instance.placed;
            traits.smoothNormals |= !mesh.normals.empty();
            traits.triangles += mesh.triangles.size();
        }
    for (const Material& material : scene.materials)
    {
        addMaterial(material, traits);
        traits.mipmaps |= isMipmapped(material, scene) && !isInvisible(material);
    }
    traits.fog &= scene.fogUse == FogUse::Depth;
    const std::optional<Atmosphere> around = atmosphereOf(scene);
    if (around && !around->medium.isClear())
    {
        traits.media = traits.veils = true;
        traits.scattering |= around->medium.scatters();
        traits.glowing |= around->medium.emits();
    }
    traits.ground = hasGround(scene.ground);
    for (const Volume& volume : scene.volumes)
    {
        traits.volumes = traits.media = traits.veils = true;
        const bool density = volume.law == VolumeLaw::Density; // others glow in their colours
        traits.scattering |= density && volume.medium.scatters();
        traits.glowing |= !density || volume.medium.emits();
    }
    for (const Light& light : scene.lights)
    {
        if (light.kind == LightKind::Environment)
        {
            traits.environment |= light.environment.image != nullptr;
            continue;
        }
        const bool area = light.kind == LightKind::Parallelogram || light.kind == LightKind::Mesh;
        (area ? traits.areaLights : traits.deltaLights) = true;
    }
    return traits;
}

} // namespace osgRayTrace::engine
