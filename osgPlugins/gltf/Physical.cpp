// Physical.cpp - maps glTF's parameters to those of PhysicalMaterial. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/Physical.h"

#include <algorithm>

namespace osgRayTrace::gltf
{

namespace
{

float unit(float value)
{
    return std::clamp(value, 0.0f, 1.0f);
}

osg::Vec3 unit(const osg::Vec3& v)
{
    return {unit(v.x()), unit(v.y()), unit(v.z())};
}

osg::Vec3 notNegative(const osg::Vec3& v)
{
    return {std::max(v.x(), 0.0f), std::max(v.y(), 0.0f), std::max(v.z(), 0.0f)};
}

void setTexture(const std::optional<TextureUse>& use, PhysicalMaterial::TextureUse as,
                PhysicalMaterial& material)
{
    if (!use) return;
    material.setTexture(as, use->texture.get());
    PhysicalMaterial::TexturePlace place;
    place.unit = use->set;
    if (use->transform)
    {
        place.offset = use->transform->offset;
        place.rotation = use->transform->rotation;
        place.scale = use->transform->scale;
    }
    material.setTexturePlace(as, place);
}

void setTextures(const MaterialValues& values, PhysicalMaterial& material)
{
    using Material = PhysicalMaterial;
    const auto set = [&](const std::optional<TextureUse>& use, Material::TextureUse as)
    { setTexture(use, as, material); };
    set(values.baseColorTexture, Material::BASE_COLOR_TEXTURE);
    set(values.metallicRoughnessTexture, Material::METALLIC_ROUGHNESS_TEXTURE);
    set(values.transmissionTexture, Material::TRANSMISSION_TEXTURE);
    set(values.emissionTexture, Material::EMISSION_TEXTURE);
    set(values.normalTexture, Material::NORMAL_TEXTURE);
    set(values.specularTexture, Material::SPECULAR_TEXTURE);
    set(values.specularColorTexture, Material::SPECULAR_COLOR_TEXTURE);
    set(values.clearcoatTexture, Material::CLEARCOAT_TEXTURE);
    set(values.clearcoatRoughnessTexture, Material::CLEARCOAT_ROUGHNESS_TEXTURE);
    set(values.clearcoatNormalTexture, Material::CLEARCOAT_NORMAL_TEXTURE);
    set(values.sheenColorTexture, Material::SHEEN_COLOR_TEXTURE);
    set(values.sheenRoughnessTexture, Material::SHEEN_ROUGHNESS_TEXTURE);
    set(values.anisotropyTexture, Material::ANISOTROPY_TEXTURE);
    set(values.diffuseTransmissionTexture, Material::DIFFUSE_TRANSMISSION_TEXTURE);
    set(values.diffuseTransmissionColorTexture, Material::DIFFUSE_TRANSMISSION_COLOR_TEXTURE);
    set(values.iridescenceTexture, Material::IRIDESCENCE_TEXTURE);
    set(values.iridescenceThicknessTexture, Material::IRIDESCENCE_THICKNESS_TEXTURE);
}

} // namespace

osg::ref_ptr<PhysicalMaterial> physicalMaterial(const MaterialValues& values, bool vertexColors)
{
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    material->setName(values.name);
    const osg::Vec4& base = values.baseColor;
    material->setBaseColor(unit(osg::Vec3(base.r(), base.g(), base.b())));
    if (values.alphaMode != AlphaMode::Opaque) material->setAlpha(unit(base.a()));
    material->setVertexColors(vertexColors);
    material->setMetallic(unit(values.metallic));
    material->setRoughness(unit(values.roughness));
    material->setNormalScale(std::clamp(values.normalScale, -16.0f, 16.0f));
    material->setEmission(notNegative(values.emission));
    // The number 0 stands for a surface that reflects everything.
    material->setIor(values.ior == 0.0f ? 4.0f : std::clamp(values.ior, 1.0f, 4.0f));
    material->setTransmission(unit(values.transmission));
    material->setThinWalled(values.transmission > 0.0f && values.thinWalled);
    material->setAttenuationColor(unit(values.attenuationColor));
    material->setAttenuationDistance(std::max(values.attenuationDistance, 0.0f));
    material->setSpecular(unit(values.specular));
    material->setSpecularColor(notNegative(values.specularColor));
    material->setClearcoat(unit(values.clearcoat));
    material->setClearcoatRoughness(unit(values.clearcoatRoughness));
    material->setClearcoatNormalScale(std::clamp(values.clearcoatNormalScale, -16.0f, 16.0f));
    material->setSheenColor(unit(values.sheenColor));
    material->setSheenRoughness(unit(values.sheenRoughness));
    material->setAnisotropy(unit(values.anisotropy));
    material->setAnisotropyRotation(values.anisotropyRotation);
    material->setDiffuseTransmission(unit(values.diffuseTransmission));
    material->setDiffuseTransmissionColor(unit(values.diffuseTransmissionColor));
    material->setIridescence(unit(values.iridescence));
    material->setIridescenceIor(std::clamp(values.iridescenceIor, 1.0f, 4.0f));
    material->setIridescenceThicknessMinimum(std::max(values.iridescenceThicknessMinimum, 0.0f));
    material->setIridescenceThicknessMaximum(std::max(values.iridescenceThicknessMaximum, 0.0f));
    setTextures(values, *material);
    return material;
}

} // namespace osgRayTrace::gltf
