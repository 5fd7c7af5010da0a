// TangentTable.cpp - finds which meshes need tangents, and makes them. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/TangentTable.h"

#include "osgRayTrace/base/Parallel.h"

#include <vector>

namespace osgRayTrace::engine
{

namespace
{

/// Tells by which texture coordinates a material needs axes.
struct NeededAxes
{
    bool first = false, second = false;

    void add(const MaterialDetail& detail, TextureRole role)
    {
        (detail.places[role].set == 1 ? second : first) = true;
    }
};

NeededAxes neededAxes(const Material& material)
{
    NeededAxes needed;
    if (!material.detail) return needed;
    const MaterialDetail& detail = *material.detail;
    if (hasNormalMap(material)) needed.add(detail, kNormalRole);
    if (hasCoatNormals(material) && detail.textures[kClearcoatNormalRole] != kInvalid)
        needed.add(detail, kClearcoatNormalRole);
    if (detail.anisotropy > 0.0f) needed.add(detail, kAnisotropyRole);
    return needed;
}

bool lacksTangents(const Mesh& mesh, bool second)
{
    const SharedArray<Vec2>& uvs = second ? mesh.uvs1 : mesh.uvs;
    return mesh.tangents.empty() && !mesh.triangles.empty() && !mesh.normals.empty() &&
           !uvs.empty();
}

} // namespace

TangentTable::TangentTable(const Scene& scene, const TangentTable* previous, const Workers& workers)
    : _scene(&scene)
{
    std::vector<NeededAxes> byMaterial;
    bool any = false;
    for (const Material& material : scene.materials)
    {
        byMaterial.push_back(neededAxes(material));
        any |= byMaterial.back().first || byMaterial.back().second;
    }
    if (!any) return;
    std::vector<std::array<bool, 2>> needed(scene.meshes.size());
    for (const Instance& instance : scene.instances)
    {
        const Mesh& mesh = *scene.meshes[instance.mesh];
        const NeededAxes& axes = byMaterial[instance.material];
        needed[instance.mesh][0] |= axes.first && lacksTangents(mesh, false);
        needed[instance.mesh][1] |= axes.second && lacksTangents(mesh, true);
    }
    _tangents.resize(needed.size());
    const auto stays = [&](std::size_t i)
    {
        return previous && i < previous->_tangents.size() &&
               previous->_scene->meshes[i] == scene.meshes[i];
    };
    workers.forEach(2 * needed.size(),
                    [&](std::size_t task)
                    {
                        const std::size_t i = task / 2, unit = task % 2;
                        if (!needed[i][unit]) return;
                        auto& made = _tangents[i][unit];
                        if (stays(i)) made = previous->_tangents[i][unit];
                        const Mesh& mesh = *scene.meshes[i];
                        if (!made)
                            made = std::make_shared<const VertexTangents>(
                                vertexTangents(mesh, unit == 1 ? mesh.uvs1 : mesh.uvs));
                    });
}

} // namespace osgRayTrace::engine
