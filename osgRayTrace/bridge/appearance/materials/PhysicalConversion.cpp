// PhysicalConversion.cpp - parameters, textures and their places. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/PhysicalConversion.h"

#include "osgRayTrace/bridge/appearance/materials/MediumConversion.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

static_assert(int(PhysicalMaterial::NUMBER_OF_TEXTURES) == int(kTextureRoles) &&
                  int(PhysicalMaterial::NORMAL_TEXTURE) == int(kNormalRole) &&
                  int(PhysicalMaterial::CLEARCOAT_TEXTURE) == int(kClearcoatRole) &&
                  int(PhysicalMaterial::SHEEN_ROUGHNESS_TEXTURE) == int(kSheenRoughnessRole) &&
                  int(PhysicalMaterial::IRIDESCENCE_THICKNESS_TEXTURE) ==
                      int(kIridescenceThicknessRole) &&
                  int(PhysicalMaterial::CLEARCOAT_NORMAL_TEXTURE) == int(kClearcoatNormalRole) &&
                  int(PhysicalMaterial::SUBSURFACE_RADIUS_TEXTURE) == int(kSubsurfaceRadiusRole),
              "the orders are the same");

Vec3 rgb(const osg::Vec3& color)
{
    return {color.x(), color.y(), color.z()};
}

PhysicalMaterial::TextureUse useOf(uint32_t role)
{
    return static_cast<PhysicalMaterial::TextureUse>(role);
}

TextureContent contentOf(uint32_t role)
{
    if (isNormalRole(role)) return TextureContent::Normals;
    const bool isColor = role == kBaseColorRole || role == kEmissionRole ||
                         role == kSpecularColorRole || role == kSheenColorRole ||
                         role == kDiffuseTransmissionColorRole;
    return isColor ? TextureContent::Color : TextureContent::Data;
}

TexturePlace placeOf(const PhysicalMaterial::TexturePlace& source)
{
    const float cosine = std::cos(source.rotation), sine = std::sin(source.rotation);
    TexturePlace place;
    place.set = source.unit;
    place.u = Vec2(cosine, sine) * source.scale.x();
    place.v = Vec2(-sine, cosine) * source.scale.y();
    place.offset = Vec2(source.offset.x(), source.offset.y());
    return place;
}

/// Returns whether the material has a value that Material itself has no member for.
bool needsDetail(const PhysicalMaterial& source)
{
    const PhysicalMaterial::TexturePlace plain;
    for (uint32_t role = 0; role < kTextureRoles; ++role)
        if (source.getTexture(useOf(role)) &&
            (role >= kNormalRole || !(source.getTexturePlace(useOf(role)) == plain)))
            return true;
    return source.getVertexColors() || source.getThinWalled() ||
           source.getAttenuationDistance() > 0.0f || source.getInterior() ||
           source.getSpecular() != 1.0f ||
           source.getSpecularColor() != osg::Vec3(1.0f, 1.0f, 1.0f) ||
           source.getClearcoat() > 0.0f || source.getSheenColor() != osg::Vec3() ||
           source.getAnisotropy() > 0.0f || source.getDiffuseTransmission() > 0.0f ||
           source.getIridescence() > 0.0f || source.getSubsurface() > 0.0f;
}

MaterialDetail detailOf(const PhysicalMaterial& source, const SurfaceInputs& inputs)
{
    MaterialDetail detail;
    detail.vertexColors = source.getVertexColors() && inputs.hasVertexColors;
    detail.thinWalled = source.getThinWalled();
    if (source.getInterior())
        detail.interior = mediumOf(*source.getInterior());
    else
        detail.interior.sigmaA =
            absorptionOf(rgb(source.getAttenuationColor()), source.getAttenuationDistance());
    detail.specular = source.getSpecular();
    detail.specularColor = rgb(source.getSpecularColor());
    detail.clearcoat = source.getClearcoat();
    detail.clearcoatRoughness = source.getClearcoatRoughness();
    detail.clearcoatNormalScale = source.getClearcoatNormalScale();
    detail.sheenColor = rgb(source.getSheenColor());
    detail.sheenRoughness = source.getSheenRoughness();
    detail.normalScale = source.getNormalScale();
    detail.anisotropy = source.getAnisotropy();
    detail.anisotropyRotation = source.getAnisotropyRotation();
    detail.diffuseTransmission = source.getDiffuseTransmission();
    detail.diffuseTransmissionColor = rgb(source.getDiffuseTransmissionColor());
    detail.subsurface = source.getSubsurface();
    detail.subsurfaceRadius = rgb(source.getSubsurfaceRadius());
    detail.iridescence = source.getIridescence();
    detail.iridescenceIor = source.getIridescenceIor();
    detail.iridescenceThickness =
        Vec2(source.getIridescenceThicknessMinimum(), source.getIridescenceThicknessMaximum());
    return detail;
}

void setParameters(const PhysicalMaterial& source, const SurfaceInputs& inputs, Material& material)
{
    material.name = source.getName();
    material.model = MaterialModel::Physical;
    material.baseColor = rgb(source.getBaseColor());
    material.alpha = source.getAlpha();
    material.metallic = source.getMetallic();
    material.roughness = source.getRoughness();
    material.transmission = source.getTransmission();
    material.ior = source.getIor();
    material.emission = rgb(source.getEmission());
    if (!source.getVertexColors() || !inputs.hasOverallColor) return;
    material.baseColor = glm::clamp(material.baseColor * Vec3(inputs.overallColor), 0.0f, 1.0f);
    material.alpha *= inputs.overallColor.w;
}

} // namespace

unsigned int moreUvSetsOf(const GraphState& state)
{
    const auto* source = state.attribute<PhysicalMaterial>(kPhysicalMaterialSlot);
    if (!source) return 0;
    unsigned int sets = 0;
    for (uint32_t role = 0; role < kTextureRoles; ++role)
        // The axes of anisotropy are those of its place, with a texture or without.
        if (source->getTexture(useOf(role)) ||
            (role == kAnisotropyRole && source->getAnisotropy() > 0.0f))
            sets |= 1u << source->getTexturePlace(useOf(role)).unit;
    return sets >> kFirstMoreUvs << kFirstMoreUvs;
}

Material physicalMaterial(const PhysicalMaterial& source, const SurfaceInputs& inputs,
                          TextureConverter& textures, ConversionReport& report)
{
    Material material;
    setParameters(source, inputs, material);
    MaterialDetail detail = detailOf(source, inputs);
    bool lacksCoordinates = false;
    const auto convert = [&](uint32_t role) -> uint32_t
    {
        const osg::Texture2D* texture = source.getTexture(useOf(role));
        detail.places[role] = placeOf(source.getTexturePlace(useOf(role)));
        if (inputs.uvSets >> detail.places[role].set & 1u)
            return textures.index(texture, contentOf(role), report);
        lacksCoordinates |= texture != nullptr;
        return kInvalid;
    };
    // The order decides on the indices of the textures.
    material.baseColorTexture = convert(kBaseColorRole);
    material.emissionTexture = convert(kEmissionRole);
    material.transmissionTexture = convert(kTransmissionRole);
    material.metallicRoughnessTexture = convert(kMetallicRoughnessRole);
    for (uint32_t role = kNormalRole; role < kTextureRoles; ++role)
        detail.textures[role] = convert(role);
    if (detail.anisotropy > 0.0f && !inputs.hasTangents &&
        !(inputs.uvSets >> detail.places[kAnisotropyRole].set & 1u))
    {
        detail.anisotropy = 0.0f; // there is no direction
        lacksCoordinates = true;
    }
    if (lacksCoordinates) report.count("approximated.no-texture-coordinates");
    if (!needsDetail(source)) return material;
    material.detail = std::make_shared<MaterialDetail>(detail);
    if (detail.clearcoat > 0.0f && detail.thinWalled && material.transmission > 0.0f &&
        (hasNormalMap(material) || detail.textures[kClearcoatNormalRole] != kInvalid))
        report.count("approximated.coat-normal");
    return material;
}

} // namespace osgRayTrace::engine
