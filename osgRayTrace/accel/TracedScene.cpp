// TracedScene.cpp - a Scene's BVHs, those that did not change taken over. Layer: accel.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/TracedScene.h"

#include "osgRayTrace/accel/HitFilter.h"
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/SceneParts.h"
#include "osgRayTrace/accel/SurfaceTable.h"
#include "osgRayTrace/base/Parallel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <unordered_set>

namespace osgRayTrace::engine
{

namespace
{

/// Embree's coordinates must stay below 1.8e18, also those of rays in the local space of instances.
constexpr double kLargestCoordinate = 1e18;

/// How far from the engine's origin a ray may start so that Embree can take it to the instance's local
/// space; 0 if Embree, which does so in float, cannot use the transform.
double reachOf(const Affine& m)
{
    double largest = 0.0, columnProduct = 1.0;
    for (int column = 0; column < 3; ++column)
    {
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::fabs(double(m.linear[column][row])));
        columnProduct *= glm::length(glm::dvec3(m.linear[column]));
    }
    // A flatter parallelepiped of columns has a determinant of rounding errors. NaN fails, too.
    const double determinant = glm::determinant(glm::dmat3(m.linear));
    if (!(largest < 1e12) || !(std::fabs(determinant) > 1e-6 * columnProduct)) return 0.0;

    const glm::dmat3 localFromEngine = glm::inverse(glm::dmat3(m.linear));
    double enlargement = 1.0; // largest sum of a row
    for (int row = 0; row < 3; ++row)
        enlargement = std::max(enlargement, std::fabs(localFromEngine[0][row]) + std::fabs(localFromEngine[1][row]) +
                                                std::fabs(localFromEngine[2][row]));
    const double reach = kLargestCoordinate / enlargement;
    const double distance = std::max({std::fabs(double(m.translation.x)), std::fabs(double(m.translation.y)),
                                      std::fabs(double(m.translation.z))});
    if (!(enlargement < 2e9) || !isFinite(m.translation) || distance > 0.5 * reach) return 0.0;
    return reach - distance;
}

/// What an instance needs of Embree.
struct InstanceState
{
    float reach = 0.0f; ///< of reachOf(), if it is placed
    bool empty = false; ///< its mesh has no triangles
};

constexpr Affine kInPlace{};

/// Of a placement: two alike are hardly ever different ones. Not 0.
uint64_t printOf(uint64_t serial, const Affine& m)
{
    float values[12];
    std::memcpy(values, &m.linear, 9 * sizeof(float));
    std::memcpy(values + 9, &m.translation, 3 * sizeof(float));
    uint64_t print = serial * 0x9e3779b97f4a7c15u;
    for (int i = 0; i < 12; i += 2)
    {
        uint64_t bits;
        std::memcpy(&bits, values + i, sizeof bits);
        print = (print ^ bits) * 0xbf58476d1ce4e5b9u;
        print ^= print >> 29;
    }
    return print | 1u;
}

bool samePlace(const Instance& a, const Instance& b)
{
    return a.placed == b.placed &&
           (!a.placed || (a.engineFromLocal.linear == b.engineFromLocal.linear &&
                          a.engineFromLocal.translation == b.engineFromLocal.translation));
}

/// Both scenes have time stamps, and no part of the new one is younger than the old scene.
template <class Part>
bool sameParts(const std::vector<Part>& now, const std::vector<Part>& before, Stamp stamp)
{
    return stamp != 0 && now.size() == before.size() &&
           std::all_of(now.begin(), now.end(),
                       [stamp](const Part& part) { return part.changed <= stamp; });
}

/// With what it points to, and nothing else of the scene that it was made for.
struct MaterialPart
{
    explicit MaterialPart(const Scene& scene) : copy{partOf(scene)}, table(copy) {}
    static Scene partOf(const Scene& scene)
    {
        Scene part;
        part.materials = scene.materials;
        part.textures = scene.textures;
        part.displayReferred = scene.displayReferred;
        return part;
    }

    Scene copy;
    MaterialTable table;
};

/// Whether a flat part of these members does for the others, too: what asks the filter in vain does
/// no harm.
bool serves(const FlatPart::Members& has, const FlatPart::Members& wanted)
{
    return std::equal(has.begin(), has.end(), wanted.begin(), wanted.end(),
                      [](const FlatPart::Member& a, const FlatPart::Member& b)
                      {
                          return a.instance == b.instance && a.mesh == b.mesh &&
                                 (a.filtered || !b.filtered);
                      });
}

SurfaceRecord surfaceOf(const Mesh& mesh)
{
    SurfaceRecord record;
    record.triangles = mesh.triangles.data();
    record.positions = mesh.positions.data();
    record.normals = mesh.normals.empty() ? nullptr : mesh.normals.data();
    record.uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data();
    record.uvs1 = mesh.uvs1.empty() ? nullptr : mesh.uvs1.data();
    record.colors = mesh.colors.empty() ? nullptr : mesh.colors.data();
    return record;
}

} // namespace

struct TracedScene::Implementation
{
    std::shared_ptr<PartPool> pool;
    std::shared_ptr<const Scene> scene;
    using Prototypes = std::vector<std::shared_ptr<const Prototype>>;
    std::shared_ptr<const Prototypes> prototypes; ///< by mesh; null: not needed
    std::size_t prototypeCount = 0;
    std::shared_ptr<const FlatPart> flat;                     ///< null: there is none
    std::shared_ptr<const RootPart> root;                     ///< null: the flat part is all
    std::vector<InstanceState> states;                        ///< by instance
    std::unique_ptr<Intersector> intersector;
    SurfaceTable surfaces;
    std::shared_ptr<const MaterialPart> materials;
    std::unique_ptr<LightTable> lights;
    SceneTraits traits;
    std::unique_ptr<HitFilter> filter;
    std::vector<bool> filtered; ///< by mesh: a partial material is on it
    std::vector<bool> attached; ///< by instance: Embree gets it
    BuildStatistics statistics;

    bool sameMeshes = false; ///< as in the previous one, with the same instances of them
    bool samePlaces = false; ///< and these where they were
    bool anyGone = false;    ///< the previous one had prototypes that this one has not
    bool sameMaterials = false;

    void fillStates(const Implementation* old);
    void findAttached();
    bool takeStructures(const Implementation* old);
    void makePrototypes(const Implementation* old, const Workers& workers, BuildCounts& counts);
    void forgetGone();
    void makeFlat(const Implementation* old, BuildCounts& counts);
    void makeRoot(const Implementation* old, BuildCounts& counts);
    void makeTables(const Implementation* old);
    void findFiltered();
    float reach() const;
};

/// States and surfaces of the instances: those of the previous scene where mesh and place are the same.
void TracedScene::Implementation::fillStates(const Implementation* old)
{
    const std::vector<Instance>& instances = scene->instances;
    states.resize(instances.size());
    surfaces.resize(instances.size());
    sameMeshes = samePlaces = old && old->scene->instances.size() == instances.size();
    for (std::size_t i = 0; i < instances.size(); ++i)
    {
        const Instance& instance = instances[i];
        const std::shared_ptr<const Mesh>& mesh = scene->meshes[instance.mesh];
        const Instance* before =
            old && i < old->scene->instances.size() ? &old->scene->instances[i] : nullptr;
        const bool sameMesh = before && old->scene->meshes[before->mesh] == mesh;
        if (sameMesh)
        {
            states[i] = old->states[i];
            surfaces[i] = old->surfaces[i];
        }
        else
        {
            surfaces[i] = surfaceOf(*mesh);
            states[i].empty = mesh->triangles.empty();
        }
        sameMeshes = sameMeshes && sameMesh && before->placed == instance.placed;
        const bool stays = sameMesh && samePlace(instance, *before);
        samePlaces = samePlaces && stays && before->mesh == instance.mesh;
        if (instance.placed && !stays)
            states[i].reach = static_cast<float>(reachOf(instance.engineFromLocal));
        surfaces[i].placed = instance.placed ? &instance : nullptr;
        surfaces[i].material = instance.material;
        surfaces[i].light = instance.light;
    }
}

/// Which instances Embree gets.
void TracedScene::Implementation::findAttached()
{
    std::vector<bool> invisible(scene->materials.size());
    for (std::size_t i = 0; i < invisible.size(); ++i)
        invisible[i] = isInvisible(scene->materials[i]);
    attached.resize(scene->instances.size());
    for (std::size_t i = 0; i < attached.size(); ++i)
    {
        const Instance& instance = scene->instances[i];
        if (states[i].empty || invisible[instance.material]) continue;
        const bool invalid = instance.placed && states[i].reach == 0.0f;
        if (invalid) ++statistics.invalidInstances;
        attached[i] = !invalid;
    }
}

/// All BVHs of the previous scene, if they do as they are: edits of materials and lights get away with less
/// than a look at each instance. What asks the filter in vain does no harm.
bool TracedScene::Implementation::takeStructures(const Implementation* old)
{
    if (!samePlaces || attached != old->attached) return false;
    if (filtered.size() != old->filtered.size()) return false;
    for (std::size_t i = 0; i < filtered.size(); ++i)
        if (filtered[i] && !old->filtered[i]) return false;
    prototypes = old->prototypes;
    prototypeCount = old->prototypeCount;
    flat = old->flat;
    root = old->root;
    return true;
}

void TracedScene::Implementation::makePrototypes(const Implementation* old, const Workers& workers,
                                                 BuildCounts& counts)
{
    const auto& meshes = scene->meshes;
    std::vector<bool> needed(meshes.size());
    for (std::size_t i = 0; i < attached.size(); ++i)
        if (attached[i] && scene->instances[i].placed) needed[scene->instances[i].mesh] = true;

    // Most are where they were. What has only deformed is not looked for: it is refitted.
    std::unordered_map<const Mesh*, const std::shared_ptr<const Prototype>*> known;
    std::size_t kept = 0, deformed = 0;
    // One that asks the filter in vain does no harm.
    const auto fits = [&](const Prototype& prototype, std::size_t i)
    { return prototype.mesh == meshes[i] && (prototype.filtered || !filtered[i]); };
    const auto knownPrototype = [&](std::size_t i) -> std::shared_ptr<const Prototype>
    {
        if (!old) return nullptr;
        const Prototypes& before = *old->prototypes;
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
            for (const auto& prototype : before)
                if (prototype) known[prototype->mesh.get()] = &prototype;
        const auto found = known.find(meshes[i].get());
        return found == known.end() || !fits(**found->second, i) ? nullptr : *found->second;
    };
    const auto made = std::make_shared<Prototypes>(meshes.size());
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < meshes.size(); ++i)
    {
        if (!needed[i]) continue;
        (*made)[i] = knownPrototype(i);
        ++prototypeCount;
        if ((*made)[i])
            ++kept;
        else
            missing.push_back(i);
    }
    const auto make = [&](std::size_t i)
    { (*made)[missing[i]] = pool->prototype(meshes[missing[i]], filtered[missing[i]], counts); };
    if (missing.size() == 1)
        workers.run([&] { make(0); }); // Embree's own threads for a large one
    else
        workers.forEach(missing.size(), make);
    prototypes = made;
    anyGone = old && kept + deformed < old->prototypeCount;
    if (anyGone) forgetGone();
}

/// What the previous scene had and this one has not is not kept for later ones.
void TracedScene::Implementation::forgetGone()
{
    std::unordered_set<const UVec3*> refittable;
    for (const auto& mesh : scene->meshes)
        if (mesh->deforms) refittable.insert(mesh->triangles.data());
    pool->keepOnly(refittable);
}

void TracedScene::Implementation::makeFlat(const Implementation* old, BuildCounts& counts)
{
    FlatPart::Members members;
    for (std::size_t i = 0; i < attached.size(); ++i)
        if (attached[i] && !scene->instances[i].placed)
        {
            const uint32_t mesh = scene->instances[i].mesh;
            members.push_back(
                {static_cast<uint32_t>(i), scene->meshes[mesh].get(), bool(filtered[mesh])});
        }
    if (old && old->flat && serves(old->flat->members, members))
    {
        flat = old->flat;
        return;
    }
    if (members.empty()) return;
    std::vector<std::shared_ptr<const Mesh>> owners;
    for (const FlatPart::Member& member : members)
        owners.push_back(scene->meshes[scene->instances[member.instance].mesh]);
    flat = pool->flat(std::move(members), std::move(owners), counts);
}

void TracedScene::Implementation::makeRoot(const Implementation* old, BuildCounts& counts)
{
    const std::size_t count = scene->instances.size();
    std::vector<Placement> placements(count + 1);
    std::vector<uint64_t> prints(count + 1, 0);
    const auto place = [&](std::size_t i, RTCScene prototype, uint64_t serial, const Affine& m)
    {
        placements[i] = {prototype, serial, &m};
        prints[i] = printOf(serial, m);
    };
    bool any = false;
    for (std::size_t i = 0; i < count; ++i)
    {
        const Instance& instance = scene->instances[i];
        if (!attached[i] || !instance.placed) continue;
        const Prototype& prototype = *(*prototypes)[instance.mesh];
        place(i, prototype.scene.get(), prototype.serial, instance.engineFromLocal);
        any = true;
    }
    if (!any && flat) return;
    if (flat) place(count, flat->scene.get(), flat->serial, kInPlace);
    root = old && old->root && old->root->prints == prints ? old->root
                                                           : pool->root(placements, prints, counts);
}

/// Shared with the previous one where nothing that they are made of has changed.
void TracedScene::Implementation::makeTables(const Implementation* old)
{
    const Stamp stamp = old ? old->scene->changed : 0;
    sameMaterials = old && scene->changed > stamp && scene->textures == old->scene->textures &&
                    scene->displayReferred == old->scene->displayReferred &&
                    sameParts(scene->materials, old->scene->materials, stamp);
    const bool sameTraits = sameMaterials && sameMeshes &&
                            sameParts(scene->lights, old->scene->lights, stamp);
    materials = sameMaterials ? old->materials : std::make_shared<const MaterialPart>(*scene);
    lights = std::make_unique<LightTable>(*scene, old ? old->lights.get() : nullptr);
    traits = sameTraits ? old->traits : sceneTraits(*scene, sameMeshes ? &old->traits : nullptr);
}

float TracedScene::Implementation::reach() const
{
    float reach = static_cast<float>(kLargestCoordinate);
    for (std::size_t i = 0; i < attached.size(); ++i)
        if (attached[i] && scene->instances[i].placed) reach = std::min(reach, states[i].reach);
    return reach;
}

void TracedScene::Implementation::findFiltered()
{
    filtered.resize(scene->meshes.size());
    for (const Instance& instance : scene->instances)
        if (materials->table[instance.material].partial) filtered[instance.mesh] = true;
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
    built.pool = old ? old->pool : std::make_shared<PartPool>(std::make_shared<EmbreeDevice>());
    built.scene = std::move(scene);

    BuildCounts counts;
    built.fillStates(old);
    built.makeTables(old);
    built.findFiltered();
    built.findAttached();
    if (!built.takeStructures(old))
    {
        built.makePrototypes(old, *workers, counts);
        workers->run(
            [&]
            {
                built.makeFlat(old, counts);
                built.makeRoot(old, counts);
                if (built.anyGone) built.pool->keepPlacements(built.root);
            });
    }
    EmbreeDevice& device = *built.pool->device();
    RTCScene top = (built.root ? built.root->scene : built.flat->scene).get();
    const bool hasFlat = built.root && built.flat;
    const uint32_t flatInstance =
        hasFlat ? static_cast<uint32_t>(built.scene->instances.size()) : kInvalid;
    built.filter =
        std::make_unique<HitFilter>(built.surfaces, built.materials->table, flatInstance);
    built.intersector = std::make_unique<Intersector>(
        top, device.nativeWidth(), built.reach(), flatInstance, built.filter.get());

    BuildStatistics& statistics = built.statistics;
    statistics.builtMeshes = counts.built;
    statistics.refitMeshes = counts.refit;
    statistics.staticBuilds = counts.flat;
    statistics.commits = counts.commits;
    statistics.embreeBytes = device.bytes();
    statistics.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return traced;
}

const Scene& TracedScene::scene() const { return *_implementation->scene; }
const SceneTraits& TracedScene::traits() const { return _implementation->traits; }
const Intersector& TracedScene::intersector() const { return *_implementation->intersector; }
const SurfaceTable& TracedScene::surfaces() const { return _implementation->surfaces; }
const MaterialTable& TracedScene::materials() const { return _implementation->materials->table; }
const LightTable& TracedScene::lights() const { return *_implementation->lights; }
const BuildStatistics& TracedScene::statistics() const { return _implementation->statistics; }
uint64_t TracedScene::embreeBytes() const { return _implementation->pool->device()->bytes(); }

} // namespace osgRayTrace::engine
