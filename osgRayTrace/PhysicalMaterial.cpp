// PhysicalMaterial.cpp - keeps parameters in range, compares and copies them. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/PhysicalMaterial>

#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace osgRayTrace
{

namespace
{

constexpr float kLargest = std::numeric_limits<float>::max();

/// Sets member to the value nearest to it within the range; leaves member if the value is NaN or
/// infinite.
void assign(const char* name, float& member, float value, float minimum, float maximum)
{
    if (!std::isfinite(value))
    {
        engine::warnOnce(std::string("PhysicalMaterial: ") + name +
                         " is not finite; left as it was");
        return;
    }
    member = std::clamp(value, minimum, maximum);
    if (member != value)
        engine::warnOnce(std::string("PhysicalMaterial: ") + name + " out of range; clamped");
}

void assign(const char* name, osg::Vec3& member, const osg::Vec3& value, float minimum,
            float maximum)
{
    for (int i = 0; i < 3; ++i)
    {
        assign(name, member[i], value[i], minimum, maximum);
    }
}

/// Compares textures in the manner of StateAttribute::compare; null comes first.
int compareTextures(const osg::Texture2D* left, const osg::Texture2D* right)
{
    if (left == right) return 0;
    if (!left) return -1;
    if (!right) return 1;
    return left->compare(*right);
}

/// Compares media in the same manner.
int compareInteriors(const Medium* left, const Medium* right)
{
    if (left == right) return 0;
    if (!left) return -1;
    return right ? left->compare(*right) : 1;
}

int comparePlaces(const PhysicalMaterial::TexturePlace& left,
                  const PhysicalMaterial::TexturePlace& right)
{
    const auto values = [](const PhysicalMaterial::TexturePlace& place)
    { return std::tie(place.unit, place.offset, place.rotation, place.scale); };
    if (values(left) < values(right)) return -1;
    return values(right) < values(left) ? 1 : 0;
}

osg::Texture2D* copied(const osg::CopyOp& copyop, const osg::ref_ptr<osg::Texture2D>& texture)
{
    return dynamic_cast<osg::Texture2D*>(copyop(static_cast<const osg::Texture*>(texture.get())));
}

} // namespace

// StateAttribute::Type ends with CAPABILITY = 100; its representation, and so the range of numbers
// that may be cast to it, ends at 127.
const osg::StateAttribute::Type PhysicalMaterial::ATTRIBUTE_TYPE =
    static_cast<osg::StateAttribute::Type>(122);

PhysicalMaterial::PhysicalMaterial() = default;

PhysicalMaterial::PhysicalMaterial(const PhysicalMaterial& other, const osg::CopyOp& copyop)
    : osg::StateAttribute(other, copyop),
      _baseColor(other._baseColor),
      _metallic(other._metallic),
      _roughness(other._roughness),
      _transmission(other._transmission),
      _ior(other._ior),
      _emission(other._emission),
      _alpha(other._alpha),
      _vertexColors(other._vertexColors),
      _normalScale(other._normalScale),
      _thinWalled(other._thinWalled),
      _attenuationColor(other._attenuationColor),
      _attenuationDistance(other._attenuationDistance),
      _interior(
          static_cast<Medium*>(copyop(static_cast<const osg::Object*>(other._interior.get())))),
      _specular(other._specular),
      _specularColor(other._specularColor),
      _clearcoat(other._clearcoat),
      _clearcoatRoughness(other._clearcoatRoughness),
      _clearcoatNormalScale(other._clearcoatNormalScale),
      _sheenColor(other._sheenColor),
      _sheenRoughness(other._sheenRoughness),
      _anisotropy(other._anisotropy),
      _anisotropyRotation(other._anisotropyRotation),
      _diffuseTransmission(other._diffuseTransmission),
      _diffuseTransmissionColor(other._diffuseTransmissionColor),
      _subsurface(other._subsurface),
      _subsurfaceRadius(other._subsurfaceRadius),
      _iridescence(other._iridescence),
      _iridescenceIor(other._iridescenceIor),
      _iridescenceThicknessMinimum(other._iridescenceThicknessMinimum),
      _iridescenceThicknessMaximum(other._iridescenceThicknessMaximum)
{
    for (int use = 0; use < NUMBER_OF_TEXTURES; ++use)
    {
        _textures[use] = copied(copyop, other._textures[use]);
        _places[use] = other._places[use];
    }
}

PhysicalMaterial::~PhysicalMaterial() = default;

int PhysicalMaterial::compare(const osg::StateAttribute& other) const
{
    COMPARE_StateAttribute_Types(PhysicalMaterial, other);
    const auto values = [](const PhysicalMaterial& m)
    {
        return std::tie(m._baseColor, m._metallic, m._roughness, m._transmission, m._ior,
                        m._emission, m._alpha, m._vertexColors, m._normalScale, m._thinWalled,
                        m._attenuationColor, m._attenuationDistance, m._specular, m._specularColor,
                        m._clearcoat, m._clearcoatRoughness, m._clearcoatNormalScale, m._sheenColor,
                        m._sheenRoughness, m._anisotropy, m._anisotropyRotation,
                        m._diffuseTransmission, m._diffuseTransmissionColor, m._subsurface,
                        m._subsurfaceRadius, m._iridescence, m._iridescenceIor,
                        m._iridescenceThicknessMinimum, m._iridescenceThicknessMaximum);
    };
    if (values(*this) < values(rhs)) return -1;
    if (values(rhs) < values(*this)) return 1;
    const int interiors = compareInteriors(_interior.get(), rhs._interior.get());
    if (interiors != 0) return interiors;
    for (int use = 0; use < NUMBER_OF_TEXTURES; ++use)
    {
        const int order = compareTextures(_textures[use].get(), rhs._textures[use].get());
        if (order != 0) return order;
        const int places = comparePlaces(_places[use], rhs._places[use]);
        if (places != 0) return places;
    }
    return 0;
}

void PhysicalMaterial::setBaseColor(const osg::Vec3& value)
{
    assign("base color", _baseColor, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setMetallic(float value)
{
    assign("metallic", _metallic, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setRoughness(float value)
{
    assign("roughness", _roughness, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setTransmission(float value)
{
    assign("transmission", _transmission, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setIor(float value)
{
    assign("ior", _ior, value, 1.0f, 4.0f);
}

void PhysicalMaterial::setEmission(const osg::Vec3& value)
{
    assign("emission", _emission, value, 0.0f, kLargest);
}

void PhysicalMaterial::setAlpha(float value)
{
    assign("alpha", _alpha, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setNormalScale(float value)
{
    assign("normal scale", _normalScale, value, -16.0f, 16.0f);
}

void PhysicalMaterial::setAttenuationColor(const osg::Vec3& value)
{
    assign("attenuation color", _attenuationColor, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setAttenuationDistance(float value)
{
    assign("attenuation distance", _attenuationDistance, value, 0.0f, kLargest);
}

void PhysicalMaterial::setSpecular(float value)
{
    assign("specular", _specular, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setSpecularColor(const osg::Vec3& value)
{
    assign("specular color", _specularColor, value, 0.0f, kLargest);
}

void PhysicalMaterial::setClearcoat(float value)
{
    assign("clearcoat", _clearcoat, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setClearcoatRoughness(float value)
{
    assign("clearcoat roughness", _clearcoatRoughness, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setClearcoatNormalScale(float value)
{
    assign("clearcoat normal scale", _clearcoatNormalScale, value, -16.0f, 16.0f);
}

void PhysicalMaterial::setSheenColor(const osg::Vec3& value)
{
    assign("sheen color", _sheenColor, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setSheenRoughness(float value)
{
    assign("sheen roughness", _sheenRoughness, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setAnisotropy(float value)
{
    assign("anisotropy", _anisotropy, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setAnisotropyRotation(float value)
{
    assign("anisotropy rotation", _anisotropyRotation, value, -kLargest, kLargest);
}

void PhysicalMaterial::setDiffuseTransmission(float value)
{
    assign("diffuse transmission", _diffuseTransmission, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setDiffuseTransmissionColor(const osg::Vec3& value)
{
    assign("diffuse transmission color", _diffuseTransmissionColor, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setSubsurface(float value)
{
    assign("subsurface", _subsurface, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setSubsurfaceRadius(const osg::Vec3& value)
{
    assign("subsurface radius", _subsurfaceRadius, value, 0.0f, kLargest);
}

void PhysicalMaterial::setIridescence(float value)
{
    assign("iridescence", _iridescence, value, 0.0f, 1.0f);
}

void PhysicalMaterial::setIridescenceIor(float value)
{
    assign("iridescence ior", _iridescenceIor, value, 1.0f, 4.0f);
}

void PhysicalMaterial::setIridescenceThicknessMinimum(float value)
{
    assign("iridescence thickness", _iridescenceThicknessMinimum, value, 0.0f, kLargest);
}

void PhysicalMaterial::setIridescenceThicknessMaximum(float value)
{
    assign("iridescence thickness", _iridescenceThicknessMaximum, value, 0.0f, kLargest);
}

void PhysicalMaterial::setTexture(TextureUse use, osg::Texture2D* texture)
{
    _textures[use] = texture;
}

void PhysicalMaterial::setTexturePlace(TextureUse use, const TexturePlace& place)
{
    TexturePlace& member = _places[use];
    constexpr unsigned int kLastUnit = 7;
    if (place.unit > kLastUnit) engine::warnOnce("PhysicalMaterial: texture unit above 7; clamped");
    member.unit = std::min(place.unit, kLastUnit);
    for (int i = 0; i < 2; ++i)
    {
        assign("texture offset", member.offset[i], place.offset[i], -kLargest, kLargest);
        assign("texture scale", member.scale[i], place.scale[i], -kLargest, kLargest);
    }
    assign("texture rotation", member.rotation, place.rotation, -kLargest, kLargest);
}

} // namespace osgRayTrace
