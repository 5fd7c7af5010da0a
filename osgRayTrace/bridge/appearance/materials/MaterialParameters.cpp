// MaterialParameters.cpp - the table of parameters of material files. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialParameters.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr double kMost = 1e30;

osg::Vec3 colorOf(const std::vector<double>& v)
{
    return osg::Vec3(osg::Vec3d(v[0], v[1], v[2]));
}

float numberOf(const std::vector<double>& v)
{
    return static_cast<float>(v[0]);
}

const Parameter kParameters[] = {
    {"baseColor", 3, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setBaseColor(colorOf(v)); }},
    {"metallic", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setMetallic(numberOf(v)); }},
    {"roughness", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setRoughness(numberOf(v)); }},
    {"transmission", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setTransmission(numberOf(v)); }},
    {"ior", 1, 1.0, 4.0, [](PhysicalMaterial& m, const Values& v) { m.setIor(numberOf(v)); }},
    {"emission", 3, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setEmission(colorOf(v)); }},
    {"alpha", 1, 0.0, 1.0, [](PhysicalMaterial& m, const Values& v) { m.setAlpha(numberOf(v)); }},
    {"normalScale", 1, -16.0, 16.0,
     [](PhysicalMaterial& m, const Values& v) { m.setNormalScale(numberOf(v)); }},
    {"thinWalled", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setThinWalled(v[0] != 0.0); }},
    {"attenuationColor", 3, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setAttenuationColor(colorOf(v)); }},
    {"attenuationDistance", 1, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setAttenuationDistance(numberOf(v)); }},
    {"specular", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setSpecular(numberOf(v)); }},
    {"specularColor", 3, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setSpecularColor(colorOf(v)); }},
    {"clearcoat", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setClearcoat(numberOf(v)); }},
    {"clearcoatRoughness", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setClearcoatRoughness(numberOf(v)); }},
    {"sheenColor", 3, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setSheenColor(colorOf(v)); }},
    {"sheenRoughness", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setSheenRoughness(numberOf(v)); }},
    {"anisotropy", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setAnisotropy(numberOf(v)); }},
    {"anisotropyRotation", 1, -kMost, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setAnisotropyRotation(numberOf(v)); }},
    {"diffuseTransmission", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setDiffuseTransmission(numberOf(v)); }},
    {"diffuseTransmissionColor", 3, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setDiffuseTransmissionColor(colorOf(v)); }},
    {"iridescence", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setIridescence(numberOf(v)); }},
    {"iridescenceIor", 1, 1.0, 4.0,
     [](PhysicalMaterial& m, const Values& v) { m.setIridescenceIor(numberOf(v)); }},
    {"iridescenceThicknessMinimum", 1, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setIridescenceThicknessMinimum(numberOf(v)); }},
    {"iridescenceThicknessMaximum", 1, 0.0, kMost,
     [](PhysicalMaterial& m, const Values& v) { m.setIridescenceThicknessMaximum(numberOf(v)); }},
    {"vertexColors", 1, 0.0, 1.0,
     [](PhysicalMaterial& m, const Values& v) { m.setVertexColors(v[0] != 0.0); }},
};

} // namespace

const Parameter* findParameter(const std::string& name)
{
    for (const Parameter& parameter : kParameters)
        if (name == parameter.name) return &parameter;
    return nullptr;
}

std::string parameterNames()
{
    std::string names;
    for (const Parameter& parameter : kParameters)
        names += (names.empty() ? "" : ", ") + std::string(parameter.name);
    return names;
}

} // namespace osgRayTrace::engine
