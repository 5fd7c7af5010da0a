// MaterialList.h - the materials of a scene, equal ones merged. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <map>
#include <vector>

namespace osgRayTrace::engine
{

/// Counts the uses of each material. A material without uses leaves a gap, a material that does
/// nothing, which the next new material fills: indices therefore stay valid.
class MaterialList
{
public:
    /// Adds a use of an equal material, or of a new one, and returns its index.
    uint32_t add(const Material& material);

    /// Removes one use.
    void release(uint32_t index);

    const Material& operator[](uint32_t index) const { return _materials[index]; }
    const std::vector<Material>& all() const { return _materials; }

    /// Returns the indices that add() and release() have changed since the last call; indices may
    /// repeat.
    std::vector<uint32_t> takeChanged() { return std::move(_changed); }

    /// Returns which textures are in use, by index.
    std::vector<bool> usedTextures(std::size_t count) const;

private:
    std::vector<Material> _materials;
    std::vector<uint32_t> _uses; ///< number of uses, by material
    std::vector<uint32_t> _gaps, _changed;
    std::map<std::vector<uint32_t>, uint32_t> _known; ///< index by materialValues
};

} // namespace osgRayTrace::engine
