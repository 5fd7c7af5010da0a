// MaterialValues.cpp - writes the values of a material as bits. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialValues.h"

#include <cstring>

namespace osgRayTrace::engine
{

namespace
{

class MaterialValues
{
public:
    explicit MaterialValues(const Material& m)
    {
        _values.reserve(64);
        add(frontOf(m));
        add(m.baseColor);
        for (const float value : {m.metallic, m.roughness, m.transmission, m.ior, m.alphaReference})
            add(value);
        _values.insert(_values.end(),
                       {static_cast<uint32_t>(m.model), uint32_t(m.lit),
                        uint32_t(m.twoSidedLighting), m.lightMask,
                        static_cast<uint32_t>(m.vertexColorUse), m.baseColorTexture,
                        m.metallicRoughnessTexture, m.transmissionTexture, m.emissionTexture,
                        uint32_t(m.separateSpecular), uint32_t(m.localViewer), uint32_t(m.blended),
                        static_cast<uint32_t>(m.alphaTest), static_cast<uint32_t>(m.culling),
                        uint32_t(m.cullsAllRays), uint32_t(m.clockwise), m.second.texture,
                        uint32_t(m.hasBack), static_cast<uint32_t>(m.moreLights.size())});
        _values.insert(_values.end(), m.moreLights.begin(), m.moreLights.end());
        if (m.baseColorTexture != kInvalid)
            add(m.textureEnvironment, m.environmentColor, m.mapping);
        if (m.second.texture != kInvalid)
            add(m.second.environment, m.second.environmentColor, m.second.mapping);
        if (m.hasBack) add(m.back);
        if (m.fog.mode != FogMode::None) add(m.fog);
        if (m.detail) add(*m.detail);
    }

    std::vector<uint32_t> take() { return std::move(_values); }

private:
    void add(float value)
    {
        uint32_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        _values.push_back(bits);
    }
    void add(const Vec3& v)
    {
        for (int c = 0; c < 3; ++c)
            add(v[c]);
    }
    void add(const FaceColors& face)
    {
        for (const Vec3& color : {face.ambient, face.diffuse, face.specular, face.emission})
            add(color);
        add(face.shininess);
        add(face.alpha);
    }
    void add(const Fog& fog)
    {
        _values.push_back(0xf0600000u + 2u * static_cast<uint32_t>(fog.mode) +
                          uint32_t(fog.radial));
        add(fog.color);
        for (const float value : {fog.density, fog.start, fog.end})
            add(value);
    }
    void add(const MaterialDetail& d)
    {
        _values.push_back(1u + uint32_t(d.vertexColors) + 2u * uint32_t(d.thinWalled));
        for (const Vec3& color :
             {d.interior.sigmaA, d.interior.sigmaS, d.interior.emission, d.specularColor,
              d.sheenColor, d.diffuseTransmissionColor, d.subsurfaceRadius})
            add(color);
        for (const float value :
             {d.interior.anisotropy, d.interior.dropletSize, d.specular, d.clearcoat,
              d.clearcoatRoughness, d.clearcoatNormalScale, d.sheenRoughness, d.normalScale,
              d.anisotropy, d.anisotropyRotation, d.diffuseTransmission, d.iridescence,
              d.iridescenceIor, d.iridescenceThickness.x, d.iridescenceThickness.y, d.subsurface})
            add(value);
        _values.push_back(static_cast<uint32_t>(d.interior.priority));
        _values.insert(_values.end(), d.textures.begin(), d.textures.end());
        for (const TexturePlace& place : d.places)
        {
            _values.push_back(place.set);
            for (const Vec2& v : {place.u, place.v, place.offset})
            {
                add(v.x);
                add(v.y);
            }
        }
    }
    void add(TextureEnvironment environment, const Vec4& color, const TextureMapping& mapping)
    {
        _values.push_back(static_cast<uint32_t>(environment));
        for (int c = 0; c < 4; ++c)
            add(color[c]);
        _values.push_back(static_cast<uint32_t>(mapping.coordinates));
        for (int column = 0; column < 4 && mapping.transformed; ++column)
            for (int row = 0; row < 4; ++row)
                add(mapping.matrix[column][row]);
        _values.push_back(mapping.partly ? 1u + static_cast<uint32_t>(mapping.own) : 0u);
        for (int column = 0; column < 4 && mapping.partly; ++column)
            for (int row = 0; row < 4; ++row)
                add(mapping.ownMatrix[column][row]);
    }

    std::vector<uint32_t> _values;
};

} // namespace

std::vector<uint32_t> materialValues(const Material& material)
{
    return MaterialValues(material).take();
}

} // namespace osgRayTrace::engine
