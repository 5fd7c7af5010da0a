// TracedScene.cpp - builds the BVHs of a Scene and reuses unchanged ones. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/TracedScene.h"

#include "osgRayTrace/accel/BvhPool.h"
#include "osgRayTrace/accel/HitFilter.h"
#include "osgRayTrace/accel/InstancePlaces.h"
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/MaterialPart.h"
#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/accel/TangentTable.h"
#include "osgRayTrace/base/Parallel.h"

#include <algorithm>
#include <chrono>
#include <unordered_map>
#include <unordered_set>

namespace osgRayTrace::engine
{

namespace
{

/// Returns true if the old scene has a stamp, both lists are equally long, and no part of the new
/// list is younger than the old scene.
template <class Part>
bool sameParts(const std::vector<Part>& now, const std::vector<Part>& before, Stamp stamp)
{
    return stamp != 0 && now.size() == before.size() &&
           std::all_of(now.begin(), now.end(),
                       [stamp](const Part& part) { return part.changed <= stamp; });
}

/// Returns true if a static BVH of the members `has` serves for the members `wanted`, too. A member
/// that calls the filter without need does no harm.
bool serves(const StaticBvh::Members& has, const StaticBvh::Members& wanted)
{
    return std::equal(has.begin(), has.end(), wanted.begin(), wanted.end(),
                      [](const StaticBvh::Member& a, const StaticBvh::Member& b)
                      {
                          return a.instance == b.instance && a.mesh == b.mesh && a.mask == b.mask &&
                                 (a.filtered || !b.filtered);
                      });
}

} // namespace

struct TracedScene::Implementation
{
    std::shared_ptr<BvhPool> pool;
    std::shared_ptr<const Scene> scene;
    using MeshBvhs = std::vector<std::shared_ptr<const MeshBvh>>;
    std::shared_ptr<const MeshBvhs> meshBvhs; ///< by mesh; null elements: not needed
    std::size_t meshBvhCount = 0;
    std::shared_ptr<const StaticBvh> staticBvh;  ///< null: the scene has none
    std::shared_ptr<const TopLevelBvh> topLevel; ///< null: the static BVH is all
    std::vector<float> reaches;                  ///< by instance: reachOf() if placed, else 0
    std::unique_ptr<Intersector> intersector;
    SurfaceTable surfaces;
    TangentTable tangents;
    std::shared_ptr<const MaterialPart> materials;
    std::unique_ptr<LightTable> lights;
    MediumTable media;
    float groundSky = 0.0f;
    GridTable grids;
    SceneTraits traits;
    std::unique_ptr<HitFilter> filter;
    std::vector<bool> filtered; ///< by mesh: some instance has a partial material
    std::vector<bool> attached; ///< by instance: part of Embree's scenes
    std::vector<uint8_t> masks; ///< by instance: of the rays that meet it
    BuildStatistics statistics;

    bool sameMeshes = false; ///< same instances of the same meshes as before
    bool samePlaces = false; ///< same instances at the same places as before
    bool sameMaterials = false;

    void compareInstances(const Implementation* old);
    void findAttached();
    bool takeStructures(const Implementation* old);
    void makeMeshBvhs(const Implementation* old, const Workers& workers, BuildCounts& counts);
    void forgetGone();
    void makeFlat(const Implementation* old, BuildCounts& counts);
    void makeTopLevel(const Implementation* old, BuildCounts& counts);
    void makeTables(const Implementation* old, const Workers& workers);
    void findFiltered();
    float reach() const;
};

/// Compares the instances with the previous scene's. Those at unchanged places keep their reaches.
void TracedScene::Implementation::compareInstances(const Implementation* old)
{
    surfaces =
        SurfaceTable(*scene, old ? &old->surfaces : nullptr, old ? old->scene.get() : nullptr);
    const std::vector<Instance>& instances = scene->instances;
    reaches.resize(instances.size(), 0.0f);
    sameMeshes = samePlaces = old && old->scene->instances.size() == instances.size();
    for (std::size_t i = 0; i < instances.size(); ++i)
    {
        const Instance& instance = instances[i];
        const Instance* before =
            old && i < old->scene->instances.size() ? &old->scene->instances[i] : nullptr;
        const bool sameMesh =
            before && old->scene->meshes[before->mesh] == scene->meshes[instance.mesh];
        const bool stays = sameMesh && samePlace(instance, *before);
        sameMeshes = sameMeshes && sameMesh && before->placed == instance.placed;
        samePlaces = samePlaces && stays && before->mesh == instance.mesh;
        if (!instance.placed) continue;
        reaches[i] = before && samePlace(instance, *before)
                         ? old->reaches[i]
                         : static_cast<float>(reachOf(instance.engineFromLocal));
    }
}

/// Finds the instances that Embree gets: with triangles, a visible material, a valid transform.
void TracedScene::Implementation::findAttached()
{
    std::vector<bool> invisible(scene->materials.size());
    for (std::size_t i = 0; i < invisible.size(); ++i)
        invisible[i] = isInvisible(scene->materials[i]);
    attached.resize(scene->instances.size());
    masks.resize(scene->instances.size());
    for (std::size_t i = 0; i < attached.size(); ++i)
    {
        const Instance& instance = scene->instances[i];
        if (surfaces.isEmpty(instance.mesh) || invisible[instance.material]) continue;
        const Material& material = scene->materials[instance.material];
        masks[i] =
            static_cast<uint8_t>(kOtherMask | (isHiddenFromCamera(material) ? 0 : kCameraMask) |
                                 (hasSubsurface(material) ? kSubsurfaceMask : 0));
        const bool invalid = instance.placed && reaches[i] == 0.0f;
        if (invalid) ++statistics.invalidInstances;
        attached[i] = !invalid;
    }
}

/// Takes all BVHs of the previous scene if they serve unchanged, as after edits of materials and
/// lights. Returns true if they do. A mesh that calls the filter without need does no harm.
bool TracedScene::Implementation::takeStructures(const Implementation* old)
{
    if (!samePlaces || attached != old->attached || masks != old->masks) return false;
    if (filtered.size() != old->filtered.size()) return false;
    for (std::size_t i = 0; i < filtered.size(); ++i)
        if (filtered[i] && !old->filtered[i]) return false;
    meshBvhs = old->meshBvhs;
    meshBvhCount = old->meshBvhCount;
    staticBvh = old->staticBvh;
    topLevel = old->topLevel;
    return true;
}

/// Makes or reuses the BVH of each mesh that a placed instance has.
void TracedScene::Implementation::makeMeshBvhs(const Implementation* old, const Workers& workers,
                                               BuildCounts& counts)
{
    const auto& meshes = scene->meshes;
    std::vector<bool> needed(meshes.size());
    for (std::size_t i = 0; i < attached.size(); ++i)
        if (attached[i] && scene->instances[i].placed) needed[scene->instances[i].mesh] = true;

    // Most meshes have the index that they had before. A mesh that has only deformed is not looked
    // up in the map, because its BVH is refitted.
    std::unordered_map<const Mesh*, const std::shared_ptr<const MeshBvh>*> known;
    std::size_t kept = 0, deformed = 0;
    // A BVH that calls the filter without need does no harm.
    const auto fits = [&](const MeshBvh& meshBvh, std::size_t i)
    { return meshBvh.mesh == meshes[i] && (meshBvh.filtered || !filtered[i]); };
    const auto knownMeshBvh = [&](std::size_t i) -> std::shared_ptr<const MeshBvh>
    {
        if (!old) return nullptr;
        const MeshBvhs& before = *old->meshBvhs;
        if (i < before.size() && before[i])
        {
            const Mesh& mesh = *before[i]->mesh;
            if (fits(*before[i], i)) return before[i];
            if (mesh.deforms && mesh.triangles.data() == meshes[i]->triangles.data())
            {
                ++deformed;
                return nullptr;
            }
        }
        if (known.empty())
            for (const auto& meshBvh : before)
                if (meshBvh) known[meshBvh->mesh.get()] = &meshBvh;
        const auto found = known.find(meshes[i].get());
        return found == known.end() || !fits(**found->second, i) ? nullptr : *found->second;
    };
    const auto result = std::make_shared<MeshBvhs>(meshes.size());
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < meshes.size(); ++i)
    {
        if (!needed[i]) continue;
        (*result)[i] = knownMeshBvh(i);
        ++meshBvhCount;
        if ((*result)[i])
            ++kept;
        else
            missing.push_back(i);
    }
    const auto make = [&](std::size_t i)
    { (*result)[missing[i]] = pool->meshBvh(meshes[missing[i]], filtered[missing[i]], counts); };
    if (missing.size() == 1)
        workers.run([&] { make(0); }); // Embree itself splits a large mesh among threads
    else
        workers.forEach(missing.size(), make);
    meshBvhs = result;
    if (old && kept + deformed < old->meshBvhCount) forgetGone();
}

/// Makes the pool forget the spare BVHs of meshes that are gone, and all top levels, which have
/// room for those meshes.
void TracedScene::Implementation::forgetGone()
{
    std::unordered_set<const UVec3*> refittable;
    for (const auto& mesh : scene->meshes)
        if (mesh->deforms) refittable.insert(mesh->triangles.data());
    pool->keepOnly(refittable);
}

/// Makes or reuses the static BVH over all instances without a transform.
void TracedScene::Implementation::makeFlat(const Implementation* old, BuildCounts& counts)
{
    StaticBvh::Members members;
    for (std::size_t i = 0; i < attached.size(); ++i)
        if (attached[i] && !scene->instances[i].placed)
        {
            const uint32_t mesh = scene->instances[i].mesh;
            members.push_back({static_cast<uint32_t>(i), scene->meshes[mesh].get(),
                               bool(filtered[mesh]), masks[i]});
        }
    if (old && old->staticBvh && serves(old->staticBvh->members, members))
    {
        staticBvh = old->staticBvh;
        return;
    }
    if (members.empty()) return;
    std::vector<std::shared_ptr<const Mesh>> owners;
    for (const StaticBvh::Member& member : members)
        owners.push_back(scene->meshes[scene->instances[member.instance].mesh]);
    staticBvh = pool->staticBvh(std::move(members), std::move(owners), counts);
}

/// Makes or reuses the top level, of which the static BVH is one instance.
void TracedScene::Implementation::makeTopLevel(const Implementation* old, BuildCounts& counts)
{
    std::vector<Placement> placements;
    for (std::size_t i = 0; i < attached.size(); ++i)
    {
        const Instance& instance = scene->instances[i];
        if (!attached[i] || !instance.placed) continue;
        const MeshBvh& meshBvh = *(*meshBvhs)[instance.mesh];
        Placement placement;
        placement.scene = meshBvh.scene.get();
        placement.outline = meshBvh.outline ? &*meshBvh.outline : nullptr;
        placement.engineFromLocal = &instance.engineFromLocal;
        placement.instance = static_cast<uint32_t>(i);
        placement.mask = masks[i];
        placement.hash = hashOf(meshBvh.serial, placement.instance, instance.engineFromLocal) +
                         uint64_t(placement.mask);
        placements.push_back(placement);
    }
    if (placements.empty() && staticBvh) return;
    if (staticBvh)
    {
        Placement placement;
        placement.scene = staticBvh->scene.get();
        placement.hash = hashOf(staticBvh->serial, kInvalid, Affine());
        placements.push_back(placement);
    }
    topLevel = old && old->topLevel && old->topLevel->placed->holds(placements)
                   ? old->topLevel
                   : pool->topLevel(placements, counts);
}

/// Makes the tables of materials and lights and the traits. Materials and traits are shared with
/// the previous scene if their sources have not changed.
void TracedScene::Implementation::makeTables(const Implementation* old, const Workers& workers)
{
    const Stamp stamp = old ? old->scene->changed : 0;
    sameMaterials = old && scene->changed > stamp && scene->textures == old->scene->textures &&
                    scene->displayReferred == old->scene->displayReferred &&
                    scene->unit == old->scene->unit &&
                    sameParts(scene->materials, old->scene->materials, stamp);
    const bool sameTraits =
        sameMaterials && sameMeshes && sameParts(scene->lights, old->scene->lights, stamp) &&
        scene->atmosphere == old->scene->atmosphere && scene->fogUse == old->scene->fogUse &&
        scene->ground == old->scene->ground &&
        sameParts(scene->volumes, old->scene->volumes, stamp);
    materials = sameMaterials ? old->materials : std::make_shared<const MaterialPart>(*scene);
    lights = std::make_unique<LightTable>(*scene, old ? old->lights.get() : nullptr,
                                          &materials->table, &workers);
    traits = sameTraits ? old->traits : sceneTraits(*scene, sameMeshes ? &old->traits : nullptr);
}

/// Returns the smallest reach of all attached placed instances.
float TracedScene::Implementation::reach() const
{
    float reach = static_cast<float>(kLargestCoordinate);
    for (std::size_t i = 0; i < attached.size(); ++i)
        if (attached[i] && scene->instances[i].placed) reach = std::min(reach, reaches[i]);
    return reach;
}

/// Finds the meshes whose hits Embree must pass to the filter.
void TracedScene::Implementation::findFiltered()
{
    filtered.resize(scene->meshes.size());
    const bool masked = pool->device()->masksRays();
    for (const Instance& instance : scene->instances)
        if (needsFilter(materials->table[instance.material], masked))
            filtered[instance.mesh] = true;
}

TracedScene::TracedScene() : _implementation(std::make_unique<Implementation>()) {}

TracedScene::~TracedScene() = default;

std::shared_ptr<const TracedScene> TracedScene::build(std::shared_ptr<const Scene> scene,
                                                      std::shared_ptr<Workers> workers,
                                                      std::shared_ptr<const TracedScene> previous)
{
    const auto begin = std::chrono::steady_clock::now();
    std::shared_ptr<TracedScene> traced(new TracedScene);
    Implementation& built = *traced->_implementation;
    const Implementation* old = previous ? previous->_implementation.get() : nullptr;
    built.pool = old ? old->pool : std::make_shared<BvhPool>(std::make_shared<EmbreeDevice>());
    built.scene = std::move(scene);

    BuildCounts counts;
    built.compareInstances(old);
    built.makeTables(old, *workers);
    built.tangents = TangentTable(*built.scene, old ? &old->tangents : nullptr, *workers);
    built.findFiltered();
    built.findAttached();
    if (!built.takeStructures(old))
    {
        built.makeMeshBvhs(old, *workers, counts);
        workers->run(
            [&]
            {
                built.makeFlat(old, counts);
                built.makeTopLevel(old, counts);
            });
    }
    EmbreeDevice& device = *built.pool->device();
    RTCScene top = (built.topLevel ? built.topLevel->scene : built.staticBvh->scene).get();
    built.filter = std::make_unique<HitFilter>(built.surfaces, built.materials->table);
    built.intersector =
        std::make_unique<Intersector>(top, device.nativeWidth(), built.reach(), built.filter.get());

    Box box = boundsOf(top);
    if (built.traits.ground && built.lights->shiningEnvironment())
        built.groundSky = irradianceOf(*built.lights->shiningEnvironment(), Vec3(0.0f, 0.0f, 1.0f));
    if (built.traits.volumes)
    {
        built.grids = GridTable(*built.scene, old ? &old->grids : nullptr,
                                old ? old->scene.get() : nullptr, workers.get());
        built.grids.widen(box.low, box.high);
        built.statistics.builtVolumes = built.grids.builtBlocks();
    }
    if (built.traits.media) built.media = MediumTable(*built.scene, box.low, box.high);

    BuildStatistics& statistics = built.statistics;
    statistics.builtMeshes = counts.built;
    statistics.refitMeshes = counts.refit;
    statistics.staticBuilds = counts.staticBuilds;
    statistics.commits = counts.commits;
    statistics.embreeBytes = device.bytes();
    statistics.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return traced;
}

const Scene& TracedScene::scene() const
{
    return *_implementation->scene;
}
const SceneTraits& TracedScene::traits() const
{
    return _implementation->traits;
}
const Intersector& TracedScene::intersector() const
{
    return *_implementation->intersector;
}
const SurfaceTable& TracedScene::surfaces() const
{
    return _implementation->surfaces;
}
const MaterialTable& TracedScene::materials() const
{
    return _implementation->materials->table;
}
const LightTable& TracedScene::lights() const
{
    return *_implementation->lights;
}
float TracedScene::groundSky() const
{
    return _implementation->groundSky;
}

const MediumTable& TracedScene::media() const
{
    return _implementation->media;
}
const GridTable& TracedScene::grids() const
{
    return _implementation->grids;
}
const VertexTangents* TracedScene::vertexTangents(uint32_t instance, uint32_t uvSet) const
{
    return _implementation->tangents.find(_implementation->scene->instances[instance].mesh, uvSet);
}
const BuildStatistics& TracedScene::statistics() const
{
    return _implementation->statistics;
}
uint64_t TracedScene::embreeBytes() const
{
    return _implementation->pool->device()->bytes();
}

} // namespace osgRayTrace::engine
