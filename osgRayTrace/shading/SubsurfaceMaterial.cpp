// SubsurfaceMaterial.cpp - what textures say of bodies below diffuse boundaries. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/MaterialTable.h"
#include "osgRayTrace/shading/TextureSample.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// The largest extinction below a surface [1/engine unit]. Light does not get anywhere with it, and
/// optical depths of 1e30 leave floats finite.
constexpr float kLargestExtinction = 1e24f;

Vec3 extinctionOf(Vec3 radius, double unit)
{
    Vec3 sigma;
    for (int c = 0; c < 3; ++c)
        sigma[c] =
            std::min(static_cast<float>(unit) / std::max(radius[c], 1e-30f), kLargestExtinction);
    return sigma;
}

/// Returns what is left of 1 by a factor in [0, 1].
float without(float factor)
{
    return 1.0f - std::clamp(factor, 0.0f, 1.0f);
}

bool isTextured(const Material& m, TextureRole role, float factor)
{
    return factor > 0.0f && textureOf(m, role) != kInvalid;
}

} // namespace

/// Sets the members of a record that light below diffuse boundaries asks for.
void MaterialTable::setSubsurface(const Material& m, MaterialRecord& record) const
{
    const MaterialDetail& d = *m.detail;
    record.subsurfaceSigma = extinctionOf(d.subsurfaceRadius, _scene->unit);
    record.largestSubsurface = std::clamp(d.subsurface, 0.0f, 1.0f);
    record.largestBodyColor = glm::clamp(m.baseColor, 0.0f, 1.0f);
    record.radiusVaries = textureOf(m, kSubsurfaceRadiusRole) != kInvalid;
    record.baseShareVaries = isTextured(m, kMetallicRoughnessRole, m.metallic) ||
                             isTextured(m, kTransmissionRole, m.transmission) ||
                             isTextured(m, kDiffuseTransmissionRole, d.diffuseTransmission);
    record.subsurfaceVaries = record.radiusVaries || d.vertexColors || record.baseShareVaries ||
                              isTextured(m, kBaseColorRole, 1.0f) ||
                              isTextured(m, kSubsurfaceRole, 1.0f);
    const auto least = [&](TextureRole role, int channel)
    {
        const uint32_t texture = textureOf(m, role);
        return texture != kInvalid ? leastTexel(*_scene->textures[texture], channel) : 1.0f;
    };
    record.largestBaseShare = without(m.metallic * least(kMetallicRoughnessRole, 2)) *
                              without(m.transmission * least(kTransmissionRole, 0)) *
                              without(d.diffuseTransmission * least(kDiffuseTransmissionRole, 3));
    if (const uint32_t texture = textureOf(m, kSubsurfaceRole); texture != kInvalid)
        record.largestSubsurface =
            std::clamp(d.subsurface * largestTexel(*_scene->textures[texture]).x, 0.0f, 1.0f);
    if (const uint32_t texture = m.baseColorTexture; texture != kInvalid)
        record.largestBodyColor =
            glm::clamp(m.baseColor * largestTexel(*_scene->textures[texture]), 0.0f, 1.0f);
}

Vec3 MaterialTable::subsurfaceSigma(uint32_t material, const MaterialPoint& point) const
{
    const MaterialRecord& record = _records[material];
    if (!record.radiusVaries) return record.subsurfaceSigma;
    const Material& m = *record.material;
    const Vec3 factor = glm::max(Vec3(textureOr(m, kSubsurfaceRadiusRole, point)), 0.0f);
    return extinctionOf(m.detail->subsurfaceRadius * factor, _scene->unit);
}

/// Returns what metal, clear parts and diffuse transmission leave to the base.
float MaterialTable::baseShare(const Material& m, const MaterialPoint& point) const
{
    return without(m.metallic * textureOr(m, kMetallicRoughnessRole, point).z) *
           without(m.transmission * textureOr(m, kTransmissionRole, point).x) *
           without(m.detail->diffuseTransmission * textureOr(m, kDiffuseTransmissionRole, point).w);
}

float MaterialTable::leavingShare(uint32_t material, const MaterialPoint& point) const
{
    const MaterialRecord& record = _records[material];
    if (!record.baseShareVaries) return 1.0f;
    return baseShare(*record.material, point) / std::max(record.largestBaseShare, 1e-30f);
}

/// Lets light enter the body. The base stays whole for those who do not follow such light.
void MaterialTable::addSubsurface(const Material& m, const MaterialPoint& point, Bsdf& bsdf) const
{
    bsdf.baseShare = baseShare(m, point);
    if (!(bsdf.baseShare > 0.0f)) return;
    bsdf.subsurface =
        std::clamp(m.detail->subsurface * textureOr(m, kSubsurfaceRole, point).x, 0.0f, 1.0f);
    bsdf.layered = true;
}

} // namespace osgRayTrace::engine
