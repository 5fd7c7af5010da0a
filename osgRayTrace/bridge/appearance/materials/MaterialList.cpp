// MaterialList.cpp - compares materials by their values. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MaterialList.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialValues.h"

#include <utility>

namespace osgRayTrace::engine
{

namespace
{

/// Returns clear glass of the index of air, which no ray notices.
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

uint32_t MaterialList::add(const Material& material)
{
    const auto next = _gaps.empty() ? static_cast<uint32_t>(_materials.size()) : _gaps.back();
    const auto [known, isNew] = _known.try_emplace(materialValues(material), next);
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
    _known.erase(materialValues(_materials[index]));
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
    {
        use(m.second.texture);
        for (uint32_t role = 0; role < kTextureRoles; ++role)
            use(textureOf(m, static_cast<TextureRole>(role)));
    }
    return used;
}

} // namespace osgRayTrace::engine
