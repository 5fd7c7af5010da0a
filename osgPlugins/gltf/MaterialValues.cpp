// MaterialValues.cpp - reads materials with their extensions. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/MaterialValues.h"

#include "osgPlugins/gltf/Glossiness.h"

namespace osgRayTrace::gltf
{

namespace
{

using Rgb = std::array<float, 3>;

constexpr float kDielectric = 0.04f; ///< reflectance at normal incidence of ior 1.5

osg::Vec3 toVec3(const Rgb& v)
{
    return {v[0], v[1], v[2]};
}

/// Sets the values of the old workflow: a dielectric whose reflectance at normal incidence is the
/// specular colour, over a base that gets what is not reflected.
void setSpecularGlossiness(const JsonPlace& old, TextureReader& textures, Document& document,
                           MaterialValues& values)
{
    const auto diffuse = old.numbersOr<4>("diffuseFactor", {1.0f, 1.0f, 1.0f, 1.0f});
    values.baseColor.set(diffuse[0], diffuse[1], diffuse[2], diffuse[3]);
    values.baseColorTexture = textures.read(old, "diffuseTexture");
    values.metallic = 0.0f;
    values.roughness = 1.0f - old.numberOr("glossinessFactor", 1.0f);
    values.specularColor =
        toVec3(old.numbersOr<3>("specularFactor", {1.0f, 1.0f, 1.0f})) / kDielectric;
    values.specularColorTexture = textures.read(old, "specularGlossinessTexture");
    if (!values.specularColorTexture) return;
    const float glossiness = old.numberOr("glossinessFactor", 1.0f);
    values.metallicRoughnessTexture = values.specularColorTexture;
    auto& texture = values.metallicRoughnessTexture->texture;
    texture = roughnessOf(*texture, glossiness);
    if (texture)
        values.roughness = 1.0f;
    else
    {
        values.metallicRoughnessTexture.reset();
        document.note(old.path() + ".specularGlossinessTexture: has no alpha of bytes; the "
                                   "glossiness is the factor's alone");
    }
}

void setMetallicRoughness(const JsonPlace& pbr, TextureReader& textures, MaterialValues& values)
{
    const auto base = pbr.numbersOr<4>("baseColorFactor", {1.0f, 1.0f, 1.0f, 1.0f});
    values.baseColor.set(base[0], base[1], base[2], base[3]);
    values.baseColorTexture = textures.read(pbr, "baseColorTexture");
    values.metallic = pbr.numberOr("metallicFactor", 1.0f);
    values.roughness = pbr.numberOr("roughnessFactor", 1.0f);
    values.metallicRoughnessTexture = textures.read(pbr, "metallicRoughnessTexture");
}

void setTransmission(const JsonPlace& material, TextureReader& textures, MaterialValues& values)
{
    if (const auto transmission = material.extension("KHR_materials_transmission"))
    {
        values.transmission = transmission->numberOr("transmissionFactor", 0.0f);
        values.transmissionTexture = textures.read(*transmission, "transmissionTexture");
    }
    const auto volume = material.extension("KHR_materials_volume");
    if (!volume) return;
    values.thinWalled = volume->numberOr("thicknessFactor", 0.0f) <= 0.0f;
    values.attenuationColor = toVec3(volume->numbersOr<3>("attenuationColor", {1.0f, 1.0f, 1.0f}));
    values.attenuationDistance = volume->numberOr("attenuationDistance", 0.0f);
}

/// Reads the extensions that lie over the base.
void setLayers(const JsonPlace& material, TextureReader& textures, MaterialValues& values)
{
    if (const auto specular = material.extension("KHR_materials_specular"))
    {
        values.specular = specular->numberOr("specularFactor", 1.0f);
        values.specularTexture = textures.read(*specular, "specularTexture");
        values.specularColor =
            toVec3(specular->numbersOr<3>("specularColorFactor", {1.0f, 1.0f, 1.0f}));
        values.specularColorTexture = textures.read(*specular, "specularColorTexture");
    }
    if (const auto coat = material.extension("KHR_materials_clearcoat"))
    {
        values.clearcoat = coat->numberOr("clearcoatFactor", 0.0f);
        values.clearcoatTexture = textures.read(*coat, "clearcoatTexture");
        values.clearcoatRoughness = coat->numberOr("clearcoatRoughnessFactor", 0.0f);
        values.clearcoatRoughnessTexture = textures.read(*coat, "clearcoatRoughnessTexture");
        values.clearcoatNormalTexture = textures.read(*coat, "clearcoatNormalTexture");
        if (values.clearcoatNormalTexture)
            values.clearcoatNormalScale =
                coat->at("clearcoatNormalTexture").numberOr("scale", 1.0f);
    }
    if (const auto sheen = material.extension("KHR_materials_sheen"))
    {
        values.sheenColor = toVec3(sheen->numbersOr<3>("sheenColorFactor", {0.0f, 0.0f, 0.0f}));
        values.sheenColorTexture = textures.read(*sheen, "sheenColorTexture");
        values.sheenRoughness = sheen->numberOr("sheenRoughnessFactor", 0.0f);
        values.sheenRoughnessTexture = textures.read(*sheen, "sheenRoughnessTexture");
    }
}

/// Reads the extensions that change reflection and transmission themselves.
void setLobes(const JsonPlace& material, TextureReader& textures, MaterialValues& values)
{
    if (const auto stretched = material.extension("KHR_materials_anisotropy"))
    {
        values.anisotropy = stretched->numberOr("anisotropyStrength", 0.0f);
        values.anisotropyRotation = stretched->numberOr("anisotropyRotation", 0.0f);
        values.anisotropyTexture = textures.read(*stretched, "anisotropyTexture");
    }
    if (const auto through = material.extension("KHR_materials_diffuse_transmission"))
    {
        values.diffuseTransmission = through->numberOr("diffuseTransmissionFactor", 0.0f);
        values.diffuseTransmissionTexture = textures.read(*through, "diffuseTransmissionTexture");
        values.diffuseTransmissionColor =
            toVec3(through->numbersOr<3>("diffuseTransmissionColorFactor", {1.0f, 1.0f, 1.0f}));
        values.diffuseTransmissionColorTexture =
            textures.read(*through, "diffuseTransmissionColorTexture");
    }
    if (const auto film = material.extension("KHR_materials_iridescence"))
    {
        values.iridescence = film->numberOr("iridescenceFactor", 0.0f);
        values.iridescenceTexture = textures.read(*film, "iridescenceTexture");
        values.iridescenceIor = film->numberOr("iridescenceIor", 1.3f);
        values.iridescenceThicknessMinimum = film->numberOr("iridescenceThicknessMinimum", 100.0f);
        values.iridescenceThicknessMaximum = film->numberOr("iridescenceThicknessMaximum", 400.0f);
        values.iridescenceThicknessTexture = textures.read(*film, "iridescenceThicknessTexture");
    }
}

AlphaMode alphaModeOf(const JsonPlace& material)
{
    const std::string mode = material.textOr("alphaMode", "OPAQUE");
    if (mode == "OPAQUE") return AlphaMode::Opaque;
    if (mode == "MASK") return AlphaMode::Mask;
    if (mode == "BLEND") return AlphaMode::Blend;
    material.at("alphaMode").refuse("is '" + mode + "'; OPAQUE, MASK and BLEND are known");
}

} // namespace

unsigned int usedSets(const MaterialValues& values)
{
    unsigned int sets = 0;
    for (const std::optional<TextureUse>* use :
         {&values.baseColorTexture, &values.metallicRoughnessTexture, &values.normalTexture,
          &values.emissionTexture, &values.transmissionTexture, &values.specularTexture,
          &values.specularColorTexture, &values.clearcoatTexture, &values.clearcoatRoughnessTexture,
          &values.clearcoatNormalTexture, &values.sheenColorTexture, &values.sheenRoughnessTexture,
          &values.anisotropyTexture, &values.diffuseTransmissionTexture,
          &values.diffuseTransmissionColorTexture, &values.iridescenceTexture,
          &values.iridescenceThicknessTexture})
        if (*use) sets |= 1u << (*use)->set;
    return sets;
}

MaterialValues materialValues(const JsonPlace& material, TextureReader& textures,
                              Document& document)
{
    MaterialValues values;
    values.name = material.textOr("name", "");
    const auto old = material.extension("KHR_materials_pbrSpecularGlossiness");
    const auto pbr = material.find("pbrMetallicRoughness");
    if (old)
        setSpecularGlossiness(*old, textures, document, values);
    else if (pbr)
        setMetallicRoughness(*pbr, textures, values);

    values.normalTexture = textures.read(material, "normalTexture");
    if (values.normalTexture)
        values.normalScale = material.at("normalTexture").numberOr("scale", 1.0f);
    values.emission = toVec3(material.numbersOr<3>("emissiveFactor", {0.0f, 0.0f, 0.0f}));
    if (const auto strength = material.extension("KHR_materials_emissive_strength"))
        values.emission *= strength->numberOr("emissiveStrength", 1.0f);
    values.emissionTexture = textures.read(material, "emissiveTexture");
    values.alphaMode = alphaModeOf(material);
    values.alphaCutoff = material.numberOr("alphaCutoff", 0.5f);
    values.doubleSided = material.flagOr("doubleSided", false);
    values.unlit = material.extension("KHR_materials_unlit").has_value();
    if (const auto ior = material.extension("KHR_materials_ior"))
        values.ior = ior->numberOr("ior", 1.5f);
    setTransmission(material, textures, values);
    setLayers(material, textures, values);
    setLobes(material, textures, values);
    return values;
}

} // namespace osgRayTrace::gltf
