// LightTableMeshes.cpp - the emitting meshes of a table of lights, and trees over the large ones.
// Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LightTable.h"

namespace osgRayTrace::engine
{

namespace
{

/// Trees of meshes, which other lights may use.
class MeshLightTrees
{
public:
    void add(const std::vector<PlacedLightTree>& placed)
    {
        for (const PlacedLightTree& p : placed)
            add(p.own);
    }

    void add(const std::shared_ptr<const MeshLightTree>& tree)
    {
        _trees.emplace(tree->areas.get(), tree);
    }

    /// Returns null if there is none.
    std::shared_ptr<const MeshLightTree> find(const EmissiveAreas* areas,
                                              const MeshRadiance& radiance) const
    {
        const auto [begin, end] = _trees.equal_range(areas);
        for (auto at = begin; at != end; ++at)
            if (at->second->radiance == radiance) return at->second;
        return nullptr;
    }

private:
    std::unordered_multimap<const EmissiveAreas*, std::shared_ptr<const MeshLightTree>> _trees;
};

} // namespace

/// Returns a mesh with its areas, which are taken from the last snapshot if possible. shared: the
/// areas of meshes in their own space, to which those of this mesh are added.
EmissiveMesh LightTable::meshOf(uint32_t light, const LightTable* previous, LocalAreas& shared,
                                const Workers* workers) const
{
    const Instance& instance = _scene->instances[_scene->lights[light].instance];
    const std::shared_ptr<const Mesh>& mesh = _scene->meshes[instance.mesh];
    EmissiveMesh emissive;
    emissive.place = {instance.placed, instance.engineFromLocal};
    emissive.uvSet = emissionUvSet(_scene->materials[instance.material]);
    if (mayHaveOwnTree(*mesh, emissive.place))
    {
        std::shared_ptr<const EmissiveAreas>& areas = shared[mesh.get()];
        if (!areas) areas = emissiveAreas(mesh, {}, workers);
        emissive.areas = areas;
        // Most of the triangles may be lines.
        if (emissive.size() >= kLeastLargeMesh) return emissive;
    }
    const uint32_t before =
        previous && light < previous->_slots.size() ? previous->record(light).mesh : kInvalid;
    if (before != kInvalid) emissive.areas = previous->_meshes[before].areas;
    if (!emissive.areas || emissive.areas->mesh != mesh ||
        !(emissive.areas->place == emissive.place))
        emissive.areas = emissiveAreas(mesh, emissive.place, workers);
    emissive.keepTriangles();
    return emissive;
}

/// Makes the trees of meshes with areas of their own. Instances of a mesh that shine alike share
/// one.
void LightTable::plantMeshTrees(const LightTable* previous, const MaterialTable* materials,
                                const Workers* workers)
{
    MeshLightTrees resting, trees;
    if (previous) resting.add(previous->_placed);
    for (const uint32_t i : _areaLights)
    {
        Record& own = _records[_slots[i]];
        if (own.mesh == kInvalid || !_meshes[own.mesh].hasLocalAreas()) continue;
        const EmissiveMesh& mesh = _meshes[own.mesh];
        const Light& light = _scene->lights[i];
        MeshRadiance radiance = meshRadiance(*_scene, light, materials);
        if (radiance.isEven()) radiance.light = Vec3(1.0f);
        std::shared_ptr<const MeshLightTree> tree = trees.find(mesh.areas.get(), radiance);
        if (!tree)
        {
            tree = resting.find(mesh.areas.get(), radiance);
            if (tree) tree->tree->clearSpare(); // it does not change now
        }
        if (!tree)
        {
            const PlacedLightTree* before =
                previous && i < previous->_slots.size() ? previous->ownTree(i) : nullptr;
            tree = meshLightTree(mesh.areas, radiance, *_scene,
                                 before ? before->own.get() : nullptr, workers);
            trees.add(tree);
        }
        own.placed = static_cast<uint32_t>(_placed.size());
        _placed.push_back(placedLightTree(tree, mesh, i, light.radiance));
    }
}

} // namespace osgRayTrace::engine
