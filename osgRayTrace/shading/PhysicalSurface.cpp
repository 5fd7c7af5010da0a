// PhysicalSurface.cpp - surface models of physical materials, textures and layers included. Layer:
// shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LayeredBsdf.h"
#include "osgRayTrace/shading/MaterialTable.h"
#include "osgRayTrace/shading/Sheen.h"
#include "osgRayTrace/shading/TextureSample.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

static Vec3 clampUnit(Vec3 v)
{
    return glm::clamp(v, 0.0f, 1.0f);
}

/// Sets the members of a record that only few materials need.
void MaterialTable::setDetail(const Material& m, MaterialRecord& record) const
{
    const MaterialDetail& detail = *m.detail;
    record.normalMap = hasNormalMap(m);
    for (uint32_t role = 0; role < kTextureRoles; ++role)
        if (textureOf(m, static_cast<TextureRole>(role)) != kInvalid &&
            detail.places[role].set >= kFirstMoreUvs)
            record.uvSets |= static_cast<uint8_t>(1u << detail.places[role].set);
    record.pane =
        detail.thinWalled && m.transmission > 0.0f && !isMetal(m) &&
        (m.roughness * m.roughness < kSmoothAlpha || m.metallicRoughnessTexture != kInvalid);
    record.absorbs =
        detail.absorbs() && (m.transmission > 0.0f || detail.diffuseTransmission > 0.0f);
    record.interface = isInterface(m);
    record.subsurface = hasSubsurface(m);
    if (record.subsurface) setSubsurface(m, record);
    if (record.absorbs)
        record.absorption = detail.interior.sigmaA * static_cast<float>(_scene->unit);
}

/// Makes a mix of a dielectric and a metal by metallic [glTF20, appendix B.2].
Bsdf MaterialTable::physical(const Material& m, const MaterialPoint& point) const
{
    const Vec4 base = baseTexture(m, point);
    const Vec4 metallicRoughness = textureOr(m, kMetallicRoughnessRole, point);
    const Vec4 clear = textureOr(m, kTransmissionRole, point);
    const Vec3 color = clampUnit(m.baseColor * Vec3(base));
    const float metallic = std::clamp(m.metallic * metallicRoughness.z, 0.0f, 1.0f);
    const float roughness = std::clamp(m.roughness * metallicRoughness.y, 0.0f, 1.0f);
    const float transmission = std::clamp(m.transmission * clear.x, 0.0f, 1.0f);

    Bsdf bsdf;
    bsdf.alpha = roughness * roughness;
    bsdf.diffuse = color * ((1.0f - metallic) * (1.0f - transmission));
    bsdf.reflectance = color * metallic;
    bsdf.grazing = metallic;
    const float ior = usableIor(m.ior);
    bsdf.coat = ior != 1.0f ? 1.0f - metallic : 0.0f;
    bsdf.transmission = color * ((1.0f - metallic) * transmission);
    // Only glass is seen as such from inside; an opaque body shows its outside on both sides.
    bsdf.eta = point.front || !bsdf.transmits() ? ior : 1.0f / ior;
    if (m.detail) addLayers(m, point, bsdf);
    return bsdf;
}

/// Sets the members of a surface with layers: those of LayeredBsdf.h.
void MaterialTable::addLayers(const Material& m, const MaterialPoint& point, Bsdf& bsdf) const
{
    const MaterialDetail& d = *m.detail;
    bsdf.thin = d.thinWalled && bsdf.transmits();
    if (bsdf.thin) bsdf.eta = usableIor(m.ior);
    bsdf.inside = bsdf.transmits() && !point.front && !bsdf.thin;
    bsdf.specular = std::clamp(d.specular * textureOr(m, kSpecularRole, point).w, 0.0f, 1.0f);
    const Vec3 specularColor = d.specularColor * Vec3(textureOr(m, kSpecularColorRole, point));
    const float root = (bsdf.eta - 1.0f) / (bsdf.eta + 1.0f);
    bsdf.normalReflectance = clampUnit(specularColor * (root * root));
    bsdf.clearcoat = std::clamp(d.clearcoat * textureOr(m, kClearcoatRole, point).x, 0.0f, 1.0f);
    bsdf.sheen = clampUnit(d.sheenColor * Vec3(textureOr(m, kSheenColorRole, point)));
    bsdf.layered = bsdf.thin || bsdf.specular != 1.0f || specularColor != Vec3(1.0f) ||
                   bsdf.clearcoat > 0.0f || bsdf.sheen != Vec3(0.0f);
    if (d.anisotropy > 0.0f) addAnisotropy(m, point, bsdf);
    if (d.diffuseTransmission > 0.0f) addDiffuseTransmission(m, point, bsdf);
    if (d.iridescence > 0.0f) addFilm(m, point, bsdf);
    if (hasSubsurface(m)) addSubsurface(m, point, bsdf);
    if (bsdf.sheen != Vec3(0.0f))
    {
        const float roughness =
            std::clamp(d.sheenRoughness * textureOr(m, kSheenRoughnessRole, point).w,
                       kLeastSheenRoughness, 1.0f);
        bsdf.sheenAlpha = roughness * roughness;
    }
    if (bsdf.clearcoat == 0.0f) return;
    bsdf.coatTilted = hasCoatNormals(m);
    const float roughness = std::clamp(
        d.clearcoatRoughness * textureOr(m, kClearcoatRoughnessRole, point).y, 0.0f, 1.0f);
    bsdf.clearcoatAlpha = roughness * roughness;
    if (bsdf.clearcoatAlpha < kSmoothAlpha) return;
    const CoatAlbedo::Place place = _clearcoat->at(roughness);
    bsdf.clearcoatRows = place.rows;
    bsdf.clearcoatFraction = place.fraction;
}

/// Stretches reflections along one direction, which the tangent holds in the axes of texture
/// coordinates: see alignTangent [glTF20, KHR_materials_anisotropy].
void MaterialTable::addAnisotropy(const Material& m, const MaterialPoint& point, Bsdf& bsdf) const
{
    const MaterialDetail& d = *m.detail;
    Vec2 direction(1.0f, 0.0f);
    float strength = d.anisotropy;
    if (d.textures[kAnisotropyRole] != kInvalid)
    {
        const Vec4 texel = textureOr(m, kAnisotropyRole, point);
        const Vec2 turned = 2.0f * Vec2(texel) - Vec2(1.0f);
        const float length = glm::length(turned);
        if (length > 1e-4f) direction = turned / length;
        strength *= glm::clamp(texel.z, 0.0f, 1.0f);
    }
    if (!(strength > 0.0f)) return;
    const float cosine = std::cos(d.anisotropyRotation), sine = std::sin(d.anisotropyRotation);
    bsdf.tangent =
        Vec2(cosine * direction.x - sine * direction.y, sine * direction.x + cosine * direction.y);
    bsdf.alpha = std::max(bsdf.alpha, kSmoothAlpha);
    bsdf.alphaTangent = bsdf.alpha + (1.0f - bsdf.alpha) * strength * strength;
    bsdf.layered = true;
}

/// Diffuses a share of the light to the other side [glTF20, KHR_materials_diffuse_transmission].
void MaterialTable::addDiffuseTransmission(const Material& m, const MaterialPoint& point,
                                           Bsdf& bsdf) const
{
    const MaterialDetail& d = *m.detail;
    const float share = glm::clamp(
        d.diffuseTransmission * textureOr(m, kDiffuseTransmissionRole, point).w, 0.0f, 1.0f);
    if (!(share > 0.0f)) return;
    const Vec3 color = clampUnit(d.diffuseTransmissionColor *
                                 Vec3(textureOr(m, kDiffuseTransmissionColorRole, point)));
    const float metallic =
        std::clamp(m.metallic * textureOr(m, kMetallicRoughnessRole, point).z, 0.0f, 1.0f);
    const float transmission =
        std::clamp(m.transmission * textureOr(m, kTransmissionRole, point).x, 0.0f, 1.0f);
    bsdf.diffuseTransmission = color * ((1.0f - metallic) * (1.0f - transmission) * share);
    bsdf.diffuse *= 1.0f - share;
    bsdf.layered = true;
}

/// Lays a thin film over the surface [glTF20, KHR_materials_iridescence].
void MaterialTable::addFilm(const Material& m, const MaterialPoint& point, Bsdf& bsdf) const
{
    const MaterialDetail& d = *m.detail;
    bsdf.film = std::clamp(d.iridescence * textureOr(m, kIridescenceRole, point).x, 0.0f, 1.0f);
    const Vec2 thickness = d.iridescenceThickness;
    bsdf.filmThickness = thickness.x + (thickness.y - thickness.x) *
                                           textureOr(m, kIridescenceThicknessRole, point).y;
    bsdf.filmIor = d.iridescenceIor;
    if (!(bsdf.film > 0.0f) || !(bsdf.filmThickness > 0.0f) || bsdf.filmIor == 1.0f)
    {
        bsdf.film = 0.0f;
        return;
    }
    bsdf.coat = 1.0f - bsdf.grazing; // a film is seen also over a body of the index of air
    bsdf.layered = true;
}

/// Makes the albedos of a rough clear coat, whose index is 1.5 [glTF20, KHR_materials_clearcoat].
void MaterialTable::prepareClearcoat(const Material& m)
{
    const float roughness = std::clamp(m.detail->clearcoatRoughness, 0.0f, 1.0f);
    if (roughness * roughness < kSmoothAlpha) return;
    if (!_clearcoat) _clearcoat = CoatAlbedo::ofShape({1.5f});
    if (m.detail->textures[kClearcoatRoughnessRole] == kInvalid)
        _clearcoat->prepare(roughness);
    else
        _clearcoat->prepareAll();
}

Vec3 MaterialTable::pane(uint32_t material, const MaterialPoint& point, float cosTheta) const
{
    const MaterialRecord& record = _records[material];
    return straightTransmittance(record.constant ? record.front : bsdf(material, point), cosTheta);
}

Vec3 MaterialTable::mappedNormal(const Material& m, TextureRole role,
                                 const MaterialPoint& point) const
{
    const Vec3 texel(textureOr(m, role, point));
    const float scale =
        role == kNormalRole ? m.detail->normalScale : m.detail->clearcoatNormalScale;
    return (2.0f * texel - Vec3(1.0f)) * Vec3(scale, scale, 1.0f);
}

/// Returns the factor of base colour and alpha of a physical material.
Vec4 MaterialTable::baseTexture(const Material& material, const MaterialPoint& point) const
{
    const Vec4 texel = textureOr(material, kBaseColorRole, point);
    return material.detail && material.detail->vertexColors ? texel * point.vertexColor : texel;
}

/// Returns the texel of a physical texture, 1 if there is none.
Vec4 MaterialTable::textureOr(const Material& m, TextureRole role, const MaterialPoint& point) const
{
    const uint32_t texture = textureOf(m, role);
    if (texture == kInvalid) return Vec4(1.0f);
    if (!m.detail) return sampleTexture(*_scene->textures[texture], point.uv, point.uvWidth);
    const TexturePlace& place = m.detail->places[role];
    return sampleTexture(*_scene->textures[texture], placedUv(place, point),
                         placedWidth(place, point));
}

} // namespace osgRayTrace::engine
