// TangentTable.h - the tangents that materials need and meshes lack. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/VertexTangents.h"
#include "osgRayTrace/scene/Scene.h"

#include <array>
#include <memory>
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

    /// Returns the tangents of a mesh by its coordinates of unit 0 or 1; null if there are none.
    const VertexTangents* find(uint32_t mesh, bool second) const
    {
        return mesh < _tangents.size() ? _tangents[mesh][second].get() : nullptr;
    }

private:
    using BothUnits = std::array<std::shared_ptr<const VertexTangents>, 2>;

    const Scene* _scene = nullptr;
    std::vector<BothUnits> _tangents; ///< by mesh; empty if no material needs any
};

} // namespace osgRayTrace::engine
