// TangentTable.h - the tangents that materials need and meshes lack. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/VertexTangents.h"
#include "osgRayTrace/scene/Scene.h"

#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// Holds the tangents of meshes with normals and texture coordinates, but without tangents, that
/// have a material with a normal map or anisotropy. Tangents of meshes that stay are kept. The
/// scene must outlive the table.
class TangentTable
{
public:
    TangentTable() = default;
    TangentTable(const Scene& scene, const TangentTable* previous, const Workers& workers);

    /// Returns the tangents of a mesh by its coordinates of a set; null if there are none.
    const VertexTangents* find(uint32_t mesh, uint32_t set) const
    {
        const Tangents* found = slot(mesh, set);
        return found ? found->get() : nullptr;
    }

private:
    using Tangents = std::shared_ptr<const VertexTangents>;

    const Tangents* slot(uint32_t mesh, uint32_t set) const
    {
        if (set < kFirstMoreUvs) return mesh < _tangents.size() ? &_tangents[mesh][set] : nullptr;
        const auto found = _more.find({mesh, set});
        return found != _more.end() ? &found->second : nullptr;
    }

    using FirstSets = std::array<Tangents, kFirstMoreUvs>;

    const Scene* _scene = nullptr;
    std::vector<FirstSets> _tangents; ///< by mesh; empty if no material needs any
    std::map<std::pair<uint32_t, uint32_t>, Tangents> _more; ///< by mesh and set, for other sets
};

} // namespace osgRayTrace::engine
