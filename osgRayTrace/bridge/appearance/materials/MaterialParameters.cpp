// MaterialParameters.cpp - the table of parameters of material files. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialParameters.h"

#include "osgRayTrace/base/NeverDestroyed.h"

#include <cmath>
#include <limits>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kMost = std::numeric_limits<float>::max(); ///< as PhysicalMaterial has it

osg::Vec3 colorOf(const std::vector<double>& v)
{
    return osg::Vec3(osg::Vec3d(v[0], v[1], v[2]));
}

float numberOf(const std::vector<double>& v)
{
    return static_cast<float>(v[0]);
}

Values valuesOf(const osg::Vec3& color)
{
    return {color.x(), color.y(), color.z()};
}

Values valuesOf(float number)
{
    return {number};
}

Values valuesOf(bool flag)
{
    return {flag ? 1.0 : 0.0};
}

/// Returns the medium within the material's bodies, which is made if there is none.
osgRayTrace::Medium& interiorOf(PhysicalMaterial& material)
{
    if (!material.getInterior()) material.setInterior(new osgRayTrace::Medium);
    return *material.getInterior();
}

/// Returns the same medium, or one of default values.
const osgRayTrace::Medium& interiorOr(const PhysicalMaterial& material)
{
    static const NeverDestroyed<osg::ref_ptr<const osgRayTrace::Medium>> none(
        new osgRayTrace::Medium);
    return material.getInterior() ? *material.getInterior() : **none;
}

/// Returns the size of droplets; 0: the medium has none.
float dropletsOf(const osgRayTrace::Medium& medium)
{
    return medium.getPhase() == osgRayTrace::Medium::DROPLETS ? medium.getDropletSize() : 0.0f;
}

void setDroplets(osgRayTrace::Medium& medium, float size)
{
    medium.setPhase(size > 0.0f ? osgRayTrace::Medium::DROPLETS
                                : osgRayTrace::Medium::HENYEY_GREENSTEIN);
    if (size > 0.0f) medium.setDropletSize(size);
}

const Parameter kParameters[] = {
    {"baseColor", 3, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setBaseColor(colorOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getBaseColor()); }},
    {"metallic", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setMetallic(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getMetallic()); }},
    {"roughness", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setRoughness(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getRoughness()); }},
    {"transmission", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setTransmission(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getTransmission()); }},
    {"ior", 1, 1.0, 4.0, [](PhysicalMaterial& m, const Values& v) { m.setIor(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getIor()); }},
    {"emission", 3, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setEmission(colorOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getEmission()); }},
    {"alpha", 1, 0.0, 1.0, [](PhysicalMaterial& m, const Values& v) { m.setAlpha(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getAlpha()); }},
    {"normalScale", 1, -16.0, 16.0,
     [](PhysicalMaterial& m, const Values& v) { m.setNormalScale(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getNormalScale()); }},
    {"thinWalled", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setThinWalled(v[0] != 0.0); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getThinWalled()); }, true},
    {"attenuationColor", 3, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setAttenuationColor(colorOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getAttenuationColor()); }},
    {"attenuationDistance", 1, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setAttenuationDistance(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getAttenuationDistance()); }},
    {"interiorAbsorption", 3, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { interiorOf(m).setAbsorption(colorOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(interiorOr(m).getAbsorption()); }},
    {"interiorScattering", 3, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { interiorOf(m).setScattering(colorOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(interiorOr(m).getScattering()); }},
    {"interiorEmission", 3, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { interiorOf(m).setEmission(colorOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(interiorOr(m).getEmission()); }},
    {"interiorAnisotropy", 1, -0.999, 0.999,
     [](PhysicalMaterial& m, const Values& v) { interiorOf(m).setAnisotropy(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(interiorOr(m).getAnisotropy()); }},
    {"interiorDropletSize", 1, 0.0, 50.0,
     [](PhysicalMaterial& m, const Values& v) { setDroplets(interiorOf(m), numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(dropletsOf(interiorOr(m))); }},
    {"interiorPriority", 1, -1e6, 1e6,
     [](PhysicalMaterial& m, const Values& v)
     { interiorOf(m).setPriority(static_cast<int>(std::lround(v[0]))); },
     [](const PhysicalMaterial& m)
     { return valuesOf(static_cast<float>(interiorOr(m).getPriority())); },
     true},
    {"specular", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setSpecular(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getSpecular()); }},
    {"specularColor", 3, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setSpecularColor(colorOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getSpecularColor()); }},
    {"clearcoat", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setClearcoat(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getClearcoat()); }},
    {"clearcoatRoughness", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setClearcoatRoughness(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getClearcoatRoughness()); }},
    {"clearcoatNormalScale", 1, -16.0, 16.0,
     [](PhysicalMaterial& m, const Values& v) { m.setClearcoatNormalScale(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getClearcoatNormalScale()); }},
    {"sheenColor", 3, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setSheenColor(colorOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getSheenColor()); }},
    {"sheenRoughness", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setSheenRoughness(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getSheenRoughness()); }},
    {"anisotropy", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setAnisotropy(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getAnisotropy()); }},
    {"anisotropyRotation", 1, -kMost, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setAnisotropyRotation(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getAnisotropyRotation()); }},
    {"diffuseTransmission", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setDiffuseTransmission(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getDiffuseTransmission()); }},
    {"diffuseTransmissionColor", 3, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setDiffuseTransmissionColor(colorOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getDiffuseTransmissionColor()); }},
    {"subsurface", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setSubsurface(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getSubsurface()); }},
    {"subsurfaceRadius", 3, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setSubsurfaceRadius(colorOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getSubsurfaceRadius()); }},
    {"iridescence", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setIridescence(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getIridescence()); }},
    {"iridescenceIor", 1, 1.0, 4.0,
     [](PhysicalMaterial& m, const Values& v) { m.setIridescenceIor(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getIridescenceIor()); }},
    {"iridescenceThicknessMinimum", 1, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setIridescenceThicknessMinimum(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getIridescenceThicknessMinimum()); }},
    {"iridescenceThicknessMaximum", 1, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setIridescenceThicknessMaximum(numberOf(v)); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getIridescenceThicknessMaximum()); }},
    {"vertexColors", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setVertexColors(v[0] != 0.0); },
     [](const PhysicalMaterial& m) { return valuesOf(m.getVertexColors()); }, true},
};

} // namespace

const Parameter* findParameter(const std::string& name)
{
    for (const Parameter& parameter : kParameters)
        if (name == parameter.name) return &parameter;
    return nullptr;
}

const std::vector<const Parameter*>& allParameters()
{
    static const NeverDestroyed<std::vector<const Parameter*>> all(
        []
        {
            std::vector<const Parameter*> pointers;
            for (const Parameter& parameter : kParameters)
                pointers.push_back(&parameter);
            return pointers;
        }());
    return *all;
}

std::string parameterNames()
{
    std::string names;
    for (const Parameter& parameter : kParameters)
        names += (names.empty() ? "" : ", ") + std::string(parameter.name);
    return names;
}

} // namespace osgRayTrace::engine
