// MaterialTable.cpp - surface models from material descriptions. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/MaterialTable.h"

#include "osgRayTrace/scene/SceneTraits.h"
#include "osgRayTrace/shading/Fresnel.h"
#include "osgRayTrace/shading/LayeredBsdf.h"
#include "osgRayTrace/shading/TextureSample.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

bool passes(AlphaTest test, float value, float reference)
{
    switch (test)
    {
    case AlphaTest::Never:
        return false;
    case AlphaTest::Less:
        return value < reference;
    case AlphaTest::Equal:
        return value == reference;
    case AlphaTest::LessOrEqual:
        return value <= reference;
    case AlphaTest::Greater:
        return value > reference;
    case AlphaTest::NotEqual:
        return value != reference;
    case AlphaTest::GreaterOrEqual:
        return value >= reference;
    case AlphaTest::Always:
        return true;
    }
    return true;
}

float maxComponent(Vec3 v)
{
    return std::max(v.x, std::max(v.y, v.z));
}

Vec3 clampUnit(Vec3 v)
{
    return glm::clamp(v, 0.0f, 1.0f);
}

/// Any surface keeps at least this highlight, which an interface of index 1.5 reflects at normal
/// incidence.
constexpr float kLeastHighlight = 0.04f;

/// Returns the GGX reflectance that sends back as much light as a highlight of OpenGL's of colour 1
/// [OpenGL21, eq. 2.1], from a sphere that is lit and seen from the same far point. OpenGL's
/// highlight is then cos^s, with a mean of 2/(s+2) over the sphere's disc. GGX is then D G2 / (4
/// cos) [Walter07, eq. 20] of alpha^2 = 2/(s+2), with the mean that is integrated here. The result
/// is about 8/(s+2) for large s and 4 for s = 0.
double highlightReflectance(double shininess)
{
    const double s = std::max(shininess, 0.01); // the limit, without cancellation
    const double alpha2 = 2.0 / (s + 2.0), alpha = std::sqrt(alpha2);
    const double k2 = 1.0 + alpha2, k = std::sqrt(k2);
    const double logarithm = std::log((k + 1.0) * (k - alpha) / ((k - 1.0) * (k + alpha)));
    const double integral = (1.0 / alpha2 - alpha) / (2.0 * k2) + logarithm / (4.0 * k2 * k);
    const double mean = alpha2 / (2.0 * (1.0 - alpha2)) * integral;
    return alpha2 / mean;
}

/// Adds a highlight of OpenGL's to a Lambert base. With light at the eye a highlight of exponent s
/// is cos^s, so a Lambert lobe is the very highlight for s = 1, and GGX the better likeness the
/// narrower it is: a share of 1/s^2 is Lambert's, of albedo 3/(s+2), which has the same mean. If
/// more light would be reflected than arrives, the GGX lobe gives way, down to kLeastHighlight, and
/// then what is diffuse.
void addHighlight(Bsdf& bsdf, Vec3 color, float shininess)
{
    const float brightest = maxComponent(color);
    if (!(brightest > 0.0f)) return;
    const float broad = 1.0f / std::max(shininess, 1.0f), diffuseShare = broad * broad;
    bsdf.diffuse += color * (diffuseShare * 3.0f / (shininess + 2.0f));
    const float base = maxComponent(bsdf.diffuse);
    const float wanted =
        brightest * (1.0f - diffuseShare) * static_cast<float>(highlightReflectance(shininess));
    if (wanted > 0.0f)
    {
        bsdf.grazing = std::min(wanted, std::max(1.0f - base, kLeastHighlight));
        bsdf.reflectance = color * (bsdf.grazing / brightest);
    }
    if (base > 1.0f - bsdf.grazing) bsdf.diffuse *= (1.0f - bsdf.grazing) / base;
}

/// Returns the factor by which texture environments change the light of a fixed-function surface:
/// they are linear in it.
Vec3 textureTint(const TextureTerms& textures)
{
    if (textures.count == 0) return Vec3(1.0f);
    return Vec3(applyTextures(textures, Vec4(1.0f))) -
           Vec3(applyTextures(textures, Vec4(Vec3(0.0f), 1.0f)));
}

} // namespace

MaterialTable::MaterialTable(const Scene& scene) : _scene(&scene)
{
    for (const Material& material : scene.materials)
    {
        const bool glass =
            material.model == MaterialModel::Physical && material.transmission > 0.0f;
        const float ior = usableIor(material.ior);
        const Coat outside = coatOf(material, ior);
        _coats.push_back({outside, glass ? coatOf(material, 1.0f / ior) : outside});
        if (material.detail && material.detail->clearcoat > 0.0f) prepareClearcoat(material);
    }
    for (uint32_t i = 0; i < scene.materials.size(); ++i)
    {
        const Material& material = scene.materials[i];
        MaterialRecord record;
        record.material = &material;
        record.fixedFunction = material.model == MaterialModel::FixedFunction;
        record.constant =
            !isTextured(material) && !material.hasBack &&
            (!record.fixedFunction || material.vertexColorUse == VertexColorUse::None) &&
            !(material.detail && material.detail->vertexColors);
        const bool texelsDecide = record.fixedFunction || material.transmission > 0.0f;
        record.sameLobes = textureOf(material, kMetallicRoughnessRole) == kInvalid &&
                           textureOf(material, kClearcoatRole) == kInvalid &&
                           textureOf(material, kClearcoatRoughnessRole) == kInvalid &&
                           textureOf(material, kAnisotropyRole) == kInvalid &&
                           material.vertexColorUse != VertexColorUse::Specular &&
                           !(texelsDecide && isTextured(material)); // a texel may be black
        if (!isInvisible(material)) // invisible: not traced, so that no photons are guided to it
        {
            MaterialPoint point;
            point.moreUvs.fill(Vec2(0.0f));
            point.moreWidths.fill(0.0f);
            record.front = bsdf(i, point);
            point.front = false;
            record.back = bsdf(i, point);
        }
        record.plainDiffuse =
            record.constant && record.front.isDiffuse() && !(record.fixedFunction && !material.lit);
        record.emits = material.emission != Vec3(0.0f) || (record.fixedFunction && !material.lit) ||
                       material.vertexColorUse == VertexColorUse::Emission ||
                       (material.hasBack && material.back.emission != Vec3(0.0f));
        record.generated = isGenerated(material.mapping) || isGenerated(material.second.mapping);
        record.partial = isPartial(material);
        record.mipmapped = isMipmapped(material, scene);
        if (material.detail) setDetail(material, record);
        _records.push_back(record);
    }
}

Bsdf MaterialTable::bsdf(uint32_t material, const MaterialPoint& point) const
{
    const Material& m = _scene->materials[material];
    Bsdf bsdf = m.model == MaterialModel::Physical ? physical(m, point) : fixedFunction(m, point);
    // Light that leaves the body meets the layers over a base of any colour, black included.
    const bool base = bsdf.diffuse != Vec3(0.0f) || bsdf.diffuseTransmission != Vec3(0.0f) ||
                      (bsdf.layered && bsdf.baseShare > 0.0f && hasSubsurface(m));
    if (bsdf.coat > 0.0f)
    {
        const Coat& coat = _coats[material][point.front || !bsdf.transmits() || bsdf.thin ? 0 : 1];
        bsdf.coatAverage = coat.average;
        if (coat.rough && !bsdf.isSmooth() && base)
        {
            const CoatAlbedo::Place place = coat.rough->at(std::sqrt(bsdf.alpha));
            bsdf.coatRows = place.rows;
            bsdf.coatFraction = place.fraction;
        }
    }
    if (!bsdf.layered || !base) return bsdf;
    if (bsdf.film > 0.0f && bsdf.coatRows) bsdf.filmRise = filmRiseOf(bsdf);
    bsdf.baseAverage = baseAverageOf(bsdf);
    return bsdf;
}

MaterialTable::Coat MaterialTable::coatOf(const Material& m, float eta) const
{
    if (m.model != MaterialModel::Physical)
        return {0.0f, {}}; // fixed-function materials have no coat
    Coat coat{fresnelDielectricAverage(eta), {}};
    const bool colored =
        m.baseColor != Vec3(0.0f) || (m.detail && m.detail->diffuseTransmission > 0.0f);
    // A film over a body of the index of air reflects by itself.
    const float face =
        eta == 1.0f && m.detail && m.detail->iridescence > 0.0f ? m.detail->iridescenceIor : eta;
    const bool base = face != 1.0f && !isMetal(m) && colored &&
                      (m.transmission < 1.0f || m.transmissionTexture != kInvalid);
    const float roughness = std::clamp(m.roughness, 0.0f, 1.0f);
    const float anisotropy = m.detail ? m.detail->anisotropy : 0.0f;
    if (!base || (roughness * roughness < kSmoothAlpha && anisotropy == 0.0f)) return coat;
    const bool varies = anisotropy > 0.0f && textureOf(m, kAnisotropyRole) != kInvalid;
    coat.rough = CoatAlbedo::ofShape({face, anisotropy, varies});
    if (m.metallicRoughnessTexture == kInvalid)
        coat.rough->prepare(anisotropy > 0.0f ? std::max(roughness, std::sqrt(kSmoothAlpha))
                                              : roughness);
    else
        coat.rough->prepareAll();
    return coat;
}

Bsdf MaterialTable::fixedFunction(const Material& m, const MaterialPoint& point) const
{
    Bsdf bsdf;
    if (!m.lit) return bsdf;
    const FaceColors colors =
        fixedFunctionColors(m, point.vertexColor, isFrontFace(m, point.front));
    const TextureTerms terms = textures(m, point);
    const Vec3 diffuse = clampUnit(Vec3(applyTextures(terms, Vec4(colors.diffuse, 1.0f))));
    const float shininess = std::max(colors.shininess, 0.0f);
    bsdf.alpha = std::sqrt(2.0f / (shininess + 2.0f));
    bsdf.diffuse = diffuse;
    const Vec3 specular = clampUnit(colors.specular);
    if (specular == Vec3(0.0f)) return bsdf;
    const Vec3 tint = m.separateSpecular ? Vec3(1.0f) : glm::max(textureTint(terms), 0.0f);
    addHighlight(bsdf, specular * tint, shininess);
    return bsdf;
}

Vec3 MaterialTable::emission(uint32_t material, const MaterialPoint& point) const
{
    const MaterialRecord& record = _records[material];
    if (!record.emits) return Vec3(0.0f);
    const Material& m = *record.material;
    if (!record.fixedFunction) return m.emission * Vec3(textureOr(m, kEmissionRole, point));
    const FaceColors colors =
        fixedFunctionColors(m, point.vertexColor, isFrontFace(m, point.front));
    const Vec3 own = m.lit ? colors.emission : colors.diffuse;
    return Vec3(applyTextures(textures(m, point), Vec4(own, 1.0f)));
}

TextureTerms MaterialTable::textures(const Material& m, const MaterialPoint& point) const
{
    TextureTerms terms;
    const auto add = [&](uint32_t index, TextureEnvironment environment, Vec4 color,
                         const TextureMapping& mapping)
    {
        if (index == kInvalid) return;
        const Texture& texture = *_scene->textures[index];
        terms.units[terms.count++] = {environment, texture.hasColor, texture.hasAlpha,
                                      sampleTexture(texture, textureCoordinates(mapping, point),
                                                    textureWidth(mapping, point)),
                                      color};
    };
    add(m.baseColorTexture, m.textureEnvironment, m.environmentColor, m.mapping);
    add(m.second.texture, m.second.environment, m.second.environmentColor, m.second.mapping);
    return terms;
}

float MaterialTable::fixedFunctionAlpha(const Material& m, const MaterialPoint& point) const
{
    const FaceColors colors =
        fixedFunctionColors(m, point.vertexColor, isFrontFace(m, point.front));
    return applyTextures(textures(m, point), Vec4(Vec3(0.0f), colors.alpha)).w;
}

float MaterialTable::opacity(uint32_t material, const MaterialPoint& point) const
{
    const Material& m = _scene->materials[material];
    const float alpha =
        std::clamp(m.model == MaterialModel::Physical ? m.alpha * baseTexture(m, point).w
                                                      : fixedFunctionAlpha(m, point),
                   0.0f, 1.0f);
    if (!passes(m.alphaTest, alpha, m.alphaReference)) return 0.0f;
    return m.blended ? alpha : 1.0f;
}

/// Returns false if every ray that meets the surface hits it, for all that is known without looking
/// at points.
bool MaterialTable::isPartial(const Material& m) const
{
    if (m.culling != FaceCulling::None) return true;
    if (!m.blended && m.alphaTest == AlphaTest::Always) return false;
    const auto isOpaque = [this](uint32_t texture)
    { return texture == kInvalid || _scene->textures[texture]->opaque; };
    const bool constant = isOpaque(m.baseColorTexture) && isOpaque(m.second.texture) &&
                          m.vertexColorUse == VertexColorUse::None && !m.hasBack &&
                          !(m.detail && m.detail->vertexColors);
    return !constant || !(m.alpha >= 1.0f) || !passes(m.alphaTest, 1.0f, m.alphaReference);
}

FaceColors fixedFunctionColors(const Material& material, const Vec4& vertexColor, bool front)
{
    FaceColors colors{material.ambient,  material.diffuse,   material.specular,
                      material.emission, material.shininess, material.alpha};
    if (!front && material.hasBack) colors = material.back;
    const Vec3 rgb(vertexColor);
    if (!material.lit)
    {
        // Without lighting OpenGL shows the primary colour; the converter puts a constant primary
        // colour into diffuse.
        if (material.vertexColorUse != VertexColorUse::None)
        {
            colors.diffuse = rgb;
            colors.alpha = vertexColor.w;
        }
        return colors;
    }
    switch (material.vertexColorUse)
    {
    case VertexColorUse::None:
        break;
    case VertexColorUse::Ambient:
        colors.ambient = rgb;
        break;
    case VertexColorUse::Diffuse:
        colors.diffuse = rgb;
        colors.alpha = vertexColor.w;
        break;
    case VertexColorUse::Specular:
        colors.specular = rgb;
        break;
    case VertexColorUse::Emission:
        colors.emission = rgb;
        break;
    case VertexColorUse::AmbientAndDiffuse:
        colors.ambient = colors.diffuse = rgb;
        colors.alpha = vertexColor.w;
        break;
    }
    return colors;
}

Vec4 applyTextureEnvironment(const TextureTerms::Term& texture, Vec4 lit)
{
    const Vec3 from(lit), color(texture.value);
    const Vec3 kept = texture.hasColor ? color : from;
    const float alpha = texture.hasAlpha ? texture.value.w : 1.0f;
    switch (texture.environment)
    {
    case TextureEnvironment::Modulate:
        return Vec4(texture.hasColor ? from * color : from, lit.w * alpha);
    case TextureEnvironment::Replace:
        return Vec4(kept, texture.hasAlpha ? alpha : lit.w);
    case TextureEnvironment::Decal:
        return Vec4(glm::mix(from, kept, alpha), lit.w);
    case TextureEnvironment::Blend:
        return Vec4(texture.hasColor ? glm::mix(from, Vec3(texture.environmentColor), color) : from,
                    lit.w * alpha);
    case TextureEnvironment::Add:
        return Vec4(texture.hasColor ? from + color : from, lit.w * alpha);
    }
    return lit;
}

Vec4 applyTextures(const TextureTerms& textures, Vec4 lit)
{
    for (int i = 0; i < textures.count; ++i)
        lit = applyTextureEnvironment(textures.units[i], lit);
    return lit;
}

bool isCulled(const Material& material, bool front)
{
    switch (material.culling)
    {
    case FaceCulling::None:
        return false;
    case FaceCulling::Back:
        return !front;
    case FaceCulling::Front:
        return front;
    case FaceCulling::FrontAndBack:
        return true;
    }
    return false;
}

} // namespace osgRayTrace::engine
