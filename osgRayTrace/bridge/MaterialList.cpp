// MaterialList.cpp - compares materials by their values. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/MaterialList.h"

#include <cstring>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// The values that decide on the picture, for comparison.
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
                        uint32_t(m.clockwise), m.second.texture, uint32_t(m.hasBack)});
        if (m.baseColorTexture != kInvalid)
            add(m.textureEnvironment, m.environmentColor, m.mapping);
        if (m.second.texture != kInvalid)
            add(m.second.environment, m.second.environmentColor, m.second.mapping);
        if (m.hasBack) add(m.back);
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
    void add(TextureEnvironment environment, const Vec4& color, const TextureMapping& mapping)
    {
        _values.push_back(static_cast<uint32_t>(environment));
        for (int c = 0; c < 4; ++c)
            add(color[c]);
        _values.push_back(static_cast<uint32_t>(mapping.coordinates));
        for (int column = 0; column < 4 && mapping.transformed; ++column)
            for (int row = 0; row < 4; ++row)
                add(mapping.matrix[column][row]);
    }

    std::vector<uint32_t> _values;
};

std::vector<uint32_t> valuesOf(const Material& m)
{
    return MaterialValues(m).take();
}

/// Clear glass of the index of air is not there for any ray.
Material gap()
{
    Material material;
    material.model = MaterialModel::Physical;
    material.transmission = 1.0f;
    material.ior = 1.0f;
    material.lit = false;
    return material;
}

} // namespace

bool sameMaterial(const Material& a, const Material& b)
{
    return valuesOf(a) == valuesOf(b);
}

FaceColors frontOf(const Material& m)
{
    return {m.ambient, m.diffuse, m.specular, m.emission, m.shininess, m.alpha};
}

uint32_t MaterialList::add(const Material& material)
{
    const auto next =
        _gaps.empty() ? static_cast<uint32_t>(_materials.size()) : _gaps.back();
    const auto [known, isNew] = _known.try_emplace(valuesOf(material), next);
    const uint32_t index = known->second;
    if (!isNew)
    {
        ++_uses[index];
        return index;
    }
    if (_gaps.empty())
    {
        _materials.push_back(material);
        _uses.push_back(0);
    }
    else
    {
        _materials[index] = material;
        _gaps.pop_back();
    }
    _changed.push_back(index);
    ++_uses[index];
    return index;
}

void MaterialList::release(uint32_t index)
{
    if (--_uses[index] > 0) return;
    _known.erase(valuesOf(_materials[index]));
    _materials[index] = gap();
    _gaps.push_back(index);
    _changed.push_back(index);
}

std::vector<bool> MaterialList::usedTextures(std::size_t count) const
{
    std::vector<bool> used(count);
    const auto use = [&used](uint32_t texture)
    {
        if (texture < used.size()) used[texture] = true;
    };
    for (const Material& m : _materials)
        for (const uint32_t texture :
             {m.baseColorTexture, m.metallicRoughnessTexture, m.transmissionTexture,
              m.emissionTexture, m.second.texture})
            use(texture);
    return used;
}

} // namespace osgRayTrace::engine
