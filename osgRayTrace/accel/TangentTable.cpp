// TangentTable.cpp - finds which meshes need tangents, and makes them. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/TangentTable.h"

#include "osgRayTrace/base/Parallel.h"

#include <vector>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the sets of texture coordinates by which a material needs axes: bit n for set n.
unsigned int neededSets(const Material& material)
{
    if (!material.detail) return 0;
    const MaterialDetail& detail = *material.detail;
    const auto bit = [&detail](TextureRole role) { return 1u << detail.places[role].set; };
    unsigned int sets = 0;
    if (hasNormalMap(material)) sets |= bit(kNormalRole);
    if (hasCoatNormals(material) && detail.textures[kClearcoatNormalRole] != kInvalid)
        sets |= bit(kClearcoatNormalRole);
    if (detail.anisotropy > 0.0f) sets |= bit(kAnisotropyRole);
    return sets;
}

bool lacksTangents(const Mesh& mesh, uint32_t set)
{
    return mesh.tangents.empty() && !mesh.triangles.empty() && !mesh.normals.empty() &&
           !uvsOfSet(mesh, set).empty();
}

/// The tangents of a mesh that are to be made, and where they belong.
struct Task
{
    uint32_t mesh, set;
    std::shared_ptr<const VertexTangents>* made;
};

} // namespace

TangentTable::TangentTable(const Scene& scene, const TangentTable* previous, const Workers& workers)
    : _scene(&scene)
{
    std::vector<unsigned int> byMaterial;
    bool any = false;
    for (const Material& material : scene.materials)
    {
        byMaterial.push_back(neededSets(material));
        any |= byMaterial.back() != 0;
    }
    if (!any) return;
    std::vector<unsigned int> needed(scene.meshes.size());
    for (const Instance& instance : scene.instances)
        needed[instance.mesh] |= byMaterial[instance.material];
    _tangents.resize(needed.size());
    std::vector<Task> tasks;
    for (uint32_t mesh = 0; mesh < needed.size(); ++mesh)
        for (uint32_t set = 0; needed[mesh] >> set != 0; ++set)
        {
            if (!(needed[mesh] >> set & 1u) || !lacksTangents(*scene.meshes[mesh], set)) continue;
            auto& made = set < kFirstMoreUvs ? _tangents[mesh][set] : _more[{mesh, set}];
            tasks.push_back({mesh, set, &made});
        }
    const auto kept = [&](const Task& task) -> const Tangents*
    {
        const bool stays = previous && task.mesh < previous->_tangents.size() &&
                           previous->_scene->meshes[task.mesh] == scene.meshes[task.mesh];
        return stays ? previous->slot(task.mesh, task.set) : nullptr;
    };
    workers.forEach(tasks.size(),
                    [&](std::size_t i)
                    {
                        const Task& task = tasks[i];
                        if (const Tangents* before = kept(task)) *task.made = *before;
                        if (*task.made) return;
                        const Mesh& mesh = *scene.meshes[task.mesh];
                        *task.made = std::make_shared<const VertexTangents>(
                            vertexTangents(mesh, uvsOfSet(mesh, task.set)));
                    });
}

} // namespace osgRayTrace::engine
