// SnapshotStamps.cpp - compares two snapshots part by part. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/SnapshotStamps.h"

#include "osgRayTrace/bridge/appearance/materials/MaterialValues.h"

#include <tuple>

namespace osgRayTrace::engine
{

namespace
{

bool same(const Material& a, const Material& b)
{
    return sameMaterial(a, b);
}

bool same(const Light& a, const Light& b)
{
    const auto fixedFunction = [](const Light& l)
    {
        return std::tie(l.kind, l.number, l.eyeSpace, l.castsShadows, l.ambient, l.diffuse,
                        l.specular, l.position, l.direction, l.attenuationConstant,
                        l.attenuationLinear, l.attenuationQuadratic, l.range, l.spotExponent,
                        l.spotCosCutoff, l.radius, l.sine);
    };
    const auto area = [](const Light& l)
    { return std::tie(l.corner, l.edgeU, l.edgeV, l.radiance, l.twoSided, l.instance); };
    const auto environment = [](const Environment& e)
    { return std::tie(e.image, e.mapFromEngine, e.visible); };
    return fixedFunction(a) == fixedFunction(b) && area(a) == area(b) &&
           environment(a.environment) == environment(b.environment);
}

/// Returns whether instances of two snapshots are equal. Indices mean the same only if the parts
/// that they point to are equal.
bool same(const Instance& a, const Instance& b)
{
    const auto values = [](const Instance& i)
    {
        return std::tie(i.material, i.light, i.placed, i.engineFromLocal.linear,
                        i.engineFromLocal.translation, i.mirrored);
    };
    return values(a) == values(b);
}

/// Returns whether all parts are equal; the equal ones take over their old stamps.
template <class Part, class Same>
bool stampParts(std::vector<Part>& parts, const std::vector<Part>& previous, Stamp now,
                const Same& isSame)
{
    bool all = parts.size() == previous.size();
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
        const bool kept = i < previous.size() && isSame(parts[i], previous[i]);
        parts[i].changed = kept ? previous[i].changed : now;
        all = all && kept;
    }
    return all;
}

} // namespace

bool sameAtmosphere(const Scene& a, const Scene& b)
{
    if (!a.atmosphere || !b.atmosphere) return a.atmosphere == b.atmosphere;
    return *a.atmosphere == *b.atmosphere;
}

bool stampLights(std::vector<Light>& lights, const std::vector<Light>& previous, Stamp now)
{
    return !stampParts(lights, previous, now,
                       [](const Light& a, const Light& b) { return same(a, b); });
}

bool stampVolumes(std::vector<Volume>& volumes, const std::vector<Volume>& previous, Stamp now)
{
    return !stampParts(volumes, previous, now, sameVolume);
}

std::shared_ptr<const Scene> stampChanges(std::shared_ptr<Scene> scene,
                                          const std::shared_ptr<const Scene>& previous, Stamp now)
{
    const Scene empty;
    const Scene& old = previous ? *previous : empty;
    const auto sameValue = [](const auto& a, const auto& b) { return same(a, b); };
    const auto sameInstance = [&](const Instance& a, const Instance& b)
    { return same(a, b) && scene->meshes[a.mesh] == old.meshes[b.mesh]; };

    bool unchanged = previous != nullptr;
    unchanged &= stampParts(scene->materials, old.materials, now, sameValue);
    unchanged &= stampParts(scene->lights, old.lights, now, sameValue);
    unchanged &= stampParts(scene->instances, old.instances, now, sameInstance);
    unchanged &= stampParts(scene->volumes, old.volumes, now, sameVolume);
    unchanged &= scene->meshes == old.meshes && scene->textures == old.textures;
    unchanged &= scene->origin == old.origin && scene->unit == old.unit &&
                 scene->ambient == old.ambient && scene->background == old.background &&
                 scene->displayReferred == old.displayReferred;
    unchanged &=
        sameAtmosphere(*scene, old) && scene->fogUse == old.fogUse && scene->ground == old.ground;
    scene->changed = now;
    return unchanged ? previous : scene;
}

} // namespace osgRayTrace::engine
