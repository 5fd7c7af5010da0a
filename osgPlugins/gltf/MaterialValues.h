// MaterialValues.h - what a glTF material says, extension by extension. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/TextureReader.h"

#include <osg/Vec3>
#include <osg/Vec4>

#include <optional>
#include <string>

namespace osgRayTrace::gltf
{

enum class AlphaMode
{
    Opaque,
    Mask,
    Blend
};

/// The parameters of a material with glTF's defaults; colours are linear.
struct MaterialValues
{
    std::string name;
    osg::Vec4 baseColor{1.0f, 1.0f, 1.0f, 1.0f};
    std::optional<TextureUse> baseColorTexture;
    float metallic = 1.0f, roughness = 1.0f;
    std::optional<TextureUse> metallicRoughnessTexture;
    std::optional<TextureUse> normalTexture;
    float normalScale = 1.0f;
    osg::Vec3 emission; ///< times KHR_materials_emissive_strength [cd/m^2]
    std::optional<TextureUse> emissionTexture;
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;
    bool doubleSided = false;
    bool unlit = false;
    float ior = 1.5f;
    float transmission = 0.0f;
    std::optional<TextureUse> transmissionTexture;
    bool thinWalled = true; ///< light passes faces unbent: no KHR_materials_volume with a thickness
    osg::Vec3 attenuationColor{1.0f, 1.0f, 1.0f};
    float attenuationDistance = 0.0f; ///< 0: infinite
    float specular = 1.0f;
    osg::Vec3 specularColor{1.0f, 1.0f, 1.0f};
    std::optional<TextureUse> specularTexture, specularColorTexture;
    float clearcoat = 0.0f, clearcoatRoughness = 0.0f;
    std::optional<TextureUse> clearcoatTexture, clearcoatRoughnessTexture, clearcoatNormalTexture;
    float clearcoatNormalScale = 1.0f;
    osg::Vec3 sheenColor;
    float sheenRoughness = 0.0f;
    std::optional<TextureUse> sheenColorTexture, sheenRoughnessTexture;
    float anisotropy = 0.0f, anisotropyRotation = 0.0f; ///< [radians]
    std::optional<TextureUse> anisotropyTexture;
    float diffuseTransmission = 0.0f;
    osg::Vec3 diffuseTransmissionColor{1.0f, 1.0f, 1.0f};
    std::optional<TextureUse> diffuseTransmissionTexture, diffuseTransmissionColorTexture;
    float iridescence = 0.0f, iridescenceIor = 1.3f;
    float iridescenceThicknessMinimum = 100.0f, iridescenceThicknessMaximum = 400.0f; ///< [nm]
    std::optional<TextureUse> iridescenceTexture, iridescenceThicknessTexture;
};

/// Returns the UV sets that textures of a material use: bit n for set n.
unsigned int usedSets(const MaterialValues& values);

/// Reads a material. Throws GltfError.
MaterialValues materialValues(const JsonPlace& material, TextureReader& textures,
                              Document& document);

} // namespace osgRayTrace::gltf
