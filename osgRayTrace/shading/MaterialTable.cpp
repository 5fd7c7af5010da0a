// MaterialTable.cpp - surface models from material descriptions. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/MaterialTable.h"

#include "osgRayTrace/shading/Fresnel.h"
#include "osgRayTrace/shading/TextureSample.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

bool isTextured(const Material& material)
{
    return material.baseColorTexture != kInvalid || material.metallicRoughnessTexture != kInvalid ||
           material.transmissionTexture != kInvalid || material.emissionTexture != kInvalid;
}

float maxComponent(Vec3 v) { return std::max(v.x, std::max(v.y, v.z)); }

Vec3 clampUnit(Vec3 v) { return glm::clamp(v, 0.0f, 1.0f); }

} // namespace

MaterialTable::MaterialTable(const Scene& scene) : _scene(&scene)
{
    for (const Material& material : scene.materials)
    {
        const bool glass = material.model == MaterialModel::Physical && material.transmission > 0.0f;
        const float ior = usableIor(material.ior);
        const Coat outside = coatOf(material, ior);
        _coats.push_back({outside, glass ? coatOf(material, 1.0f / ior) : outside});
    }
    for (uint32_t i = 0; i < scene.materials.size(); ++i)
    {
        const Material& material = scene.materials[i];
        MaterialRecord record;
        record.material = &material;
        record.fixedFunction = material.model == MaterialModel::FixedFunction;
        record.constant = !isTextured(material) &&
                          (!record.fixedFunction || material.vertexColorUse == VertexColorUse::None);
        if (!isInvisible(material)) // else it is not traced: no photons are aimed at it
        {
            MaterialPoint point;
            record.front = bsdf(i, point);
            point.front = false;
            record.back = bsdf(i, point);
        }
        record.plainDiffuse = record.constant && record.front.isDiffuse() &&
                              !(record.fixedFunction && !material.lit);
        record.emits = material.emission != Vec3(0.0f) || (record.fixedFunction && !material.lit) ||
                       material.vertexColorUse == VertexColorUse::Emission;
        _records.push_back(record);
    }
}

Bsdf MaterialTable::bsdf(uint32_t material, const MaterialPoint& point) const
{
    const Material& m = _scene->materials[material];
    Bsdf bsdf = m.model == MaterialModel::Physical ? physical(m, point) : fixedFunction(m, point);
    if (bsdf.coat > 0.0f)
    {
        const Coat& coat = _coats[material][point.front || !bsdf.transmits() ? 0 : 1];
        bsdf.coatAverage = coat.average;
        if (coat.rough && !bsdf.isSmooth() && bsdf.diffuse != Vec3(0.0f))
        {
            const CoatAlbedo::Place place = coat.rough->at(std::sqrt(bsdf.alpha));
            bsdf.coatRows = place.rows;
            bsdf.coatFraction = place.fraction;
        }
    }
    return bsdf;
}

MaterialTable::Coat MaterialTable::coatOf(const Material& m, float eta) const
{
    Coat coat{fresnelDielectricAverage(eta), {}};
    const bool base = m.model == MaterialModel::Physical && eta != 1.0f && m.metallic < 1.0f &&
                      m.baseColor != Vec3(0.0f) &&
                      (m.transmission < 1.0f || m.transmissionTexture != kInvalid);
    const float roughness = std::clamp(m.roughness, 0.0f, 1.0f);
    if (!base || roughness * roughness < kSmoothAlpha) return coat;
    coat.rough = CoatAlbedo::ofIndex(eta);
    if (m.metallicRoughnessTexture == kInvalid)
        coat.rough->prepare(roughness);
    else
        coat.rough->prepareAll();
    return coat;
}

/// [glTF20, appendix B.2]: a mix of a dielectric and a metal by metallic.
Bsdf MaterialTable::physical(const Material& m, const MaterialPoint& point) const
{
    const Vec4 base = textureOr(m.baseColorTexture, point.uv, Vec4(1.0f));
    const Vec4 metallicRoughness = textureOr(m.metallicRoughnessTexture, point.uv, Vec4(1.0f));
    const Vec4 clear = textureOr(m.transmissionTexture, point.uv, Vec4(1.0f));
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
    // From inside only glass is seen as such; an opaque body shows its outside on both sides.
    bsdf.eta = point.front || !bsdf.transmits() ? ior : 1.0f / ior;
    return bsdf;
}

Bsdf MaterialTable::fixedFunction(const Material& m, const MaterialPoint& point) const
{
    Bsdf bsdf;
    if (!m.lit) return bsdf;
    const FixedFunctionColors colors = fixedFunctionColors(m, point.vertexColor);
    const Vec4 texture = baseTexture(m, point.uv);
    const Vec4 tinted =
        applyTextureEnvironment(m.textureEnvironment, Vec4(colors.diffuse, 1.0f), texture);
    const Vec3 specular = clampUnit(colors.specular) *
                          std::min(1.0f, 8.0f / (std::max(m.shininess, 0.0f) + 2.0f));
    bsdf.alpha = std::sqrt(2.0f / (std::max(m.shininess, 0.0f) + 2.0f));
    bsdf.reflectance = specular;
    bsdf.grazing = maxComponent(specular);
    bsdf.diffuse = clampUnit(Vec3(tinted)) * (1.0f - bsdf.grazing);
    return bsdf;
}

Vec3 MaterialTable::emission(uint32_t material, const MaterialPoint& point) const
{
    const MaterialRecord& record = _records[material];
    if (!record.emits) return Vec3(0.0f);
    const Material& m = *record.material;
    if (!record.fixedFunction)
        return m.emission * Vec3(textureOr(m.emissionTexture, point.uv, Vec4(1.0f)));
    const FixedFunctionColors colors = fixedFunctionColors(m, point.vertexColor);
    const Vec3 own = m.lit ? colors.emission : colors.diffuse;
    return Vec3(applyTextureEnvironment(m.textureEnvironment, Vec4(own, 1.0f), baseTexture(m, point.uv)));
}

Vec4 MaterialTable::baseTexture(const Material& material, Vec2 uv) const
{
    return textureOr(material.baseColorTexture, uv, Vec4(1.0f));
}

Vec4 MaterialTable::textureOr(uint32_t texture, Vec2 uv, Vec4 otherwise) const
{
    return texture == kInvalid ? otherwise : sampleTexture(*_scene->textures[texture], uv);
}

FixedFunctionColors fixedFunctionColors(const Material& material, const Vec4& vertexColor)
{
    FixedFunctionColors colors{material.ambient, material.diffuse, material.specular,
                               material.emission, material.alpha};
    const Vec3 rgb(vertexColor);
    if (!material.lit)
    {
        // Without lighting OpenGL shows the primary colour; the converter puts a constant one in diffuse.
        if (material.vertexColorUse != VertexColorUse::None)
        {
            colors.diffuse = rgb;
            colors.alpha = vertexColor.w;
        }
        return colors;
    }
    switch (material.vertexColorUse)
    {
    case VertexColorUse::None: break;
    case VertexColorUse::Ambient: colors.ambient = rgb; break;
    case VertexColorUse::Diffuse:
        colors.diffuse = rgb;
        colors.alpha = vertexColor.w;
        break;
    case VertexColorUse::Specular: colors.specular = rgb; break;
    case VertexColorUse::Emission: colors.emission = rgb; break;
    case VertexColorUse::AmbientAndDiffuse:
        colors.ambient = colors.diffuse = rgb;
        colors.alpha = vertexColor.w;
        break;
    }
    return colors;
}

Vec4 applyTextureEnvironment(TextureEnvironment environment, Vec4 lit, Vec4 texture)
{
    switch (environment)
    {
    case TextureEnvironment::Modulate: return lit * texture;
    case TextureEnvironment::Replace: return texture;
    case TextureEnvironment::Decal:
        return Vec4(glm::mix(Vec3(lit), Vec3(texture), texture.w), lit.w);
    }
    return lit;
}

} // namespace osgRayTrace::engine
