// PhysicalMaterial.cpp - keeps parameters in range, compares and copies them. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/PhysicalMaterial>

#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
      _baseColorTexture(copied(copyop, other._baseColorTexture)),
      _metallicRoughnessTexture(copied(copyop, other._metallicRoughnessTexture)),
      _transmissionTexture(copied(copyop, other._transmissionTexture)),
      _emissionTexture(copied(copyop, other._emissionTexture))
{
}

PhysicalMaterial::~PhysicalMaterial() = default;

int PhysicalMaterial::compare(const osg::StateAttribute& other) const
{
    COMPARE_StateAttribute_Types(PhysicalMaterial, other) COMPARE_StateAttribute_Parameter(
        _baseColor) COMPARE_StateAttribute_Parameter(_metallic)
        COMPARE_StateAttribute_Parameter(_roughness) COMPARE_StateAttribute_Parameter(_transmission)
            COMPARE_StateAttribute_Parameter(_ior) COMPARE_StateAttribute_Parameter(_emission)

                const osg::ref_ptr<osg::Texture2D>
                    PhysicalMaterial::*textures[] = {&PhysicalMaterial::_baseColorTexture,
                                                     &PhysicalMaterial::_metallicRoughnessTexture,
                                                     &PhysicalMaterial::_transmissionTexture,
                                                     &PhysicalMaterial::_emissionTexture};
    for (const auto texture : textures)
    {
        const int order = compareTextures((this->*texture).get(), (rhs.*texture).get());
        if (order != 0) return order;
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

void PhysicalMaterial::setBaseColorTexture(osg::Texture2D* texture)
{
    _baseColorTexture = texture;
}

void PhysicalMaterial::setMetallicRoughnessTexture(osg::Texture2D* texture)
{
    _metallicRoughnessTexture = texture;
}

void PhysicalMaterial::setTransmissionTexture(osg::Texture2D* texture)
{
    _transmissionTexture = texture;
}

void PhysicalMaterial::setEmissionTexture(osg::Texture2D* texture)
{
    _emissionTexture = texture;
}

} // namespace osgRayTrace
