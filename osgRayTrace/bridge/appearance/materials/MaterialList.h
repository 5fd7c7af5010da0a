// MaterialList.h - the materials of a scene, equal ones merged. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <map>
#include <vector>

namespace osgRayTrace::engine
{

/// Counts the uses of each. What has no use any more leaves a gap, a material that does nothing,
/// which the next new one fills: so indices stay what they are.
class MaterialList
{
public:
    /// One more use of an equal material, or of a new one.
    uint32_t add(const Material& material);

    /// One use less.
    void release(uint32_t index);

    const Material& operator[](uint32_t index) const { return _materials[index]; }
    const std::vector<Material>& all() const { return _materials; }

    /// Those that add() and release() have exchanged since the last call; indices may repeat.
    std::vector<uint32_t> takeChanged() { return std::move(_changed); }

    /// Textures that are in use are told apart from others: by index.
    std::vector<bool> usedTextures(std::size_t count) const;

private:
    std::vector<Material> _materials;
    std::vector<uint32_t> _uses; ///< by material
    std::vector<uint32_t> _gaps, _changed;
    std::map<std::vector<uint32_t>, uint32_t> _known; ///< by materialValues
};

} // namespace osgRayTrace::engine
