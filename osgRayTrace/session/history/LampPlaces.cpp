// LampPlaces.cpp - finds the middles of lamps. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/LampPlaces.h"

#include "osgRayTrace/session/history/SceneChange.h"

namespace osgRayTrace::engine
{

std::vector<Vec3> LampPlaces::of(const std::vector<Light>& lights, const Scene& scene)
{
    std::vector<Vec3> places;
    for (const Light& light : lights)
        switch (light.kind)
        {
        case LightKind::Directional:
        case LightKind::Environment:
            break;
        case LightKind::Point:
            places.push_back(light.position);
            break;
        case LightKind::Parallelogram:
            places.push_back(light.corner + 0.5f * (light.edgeU + light.edgeV));
            break;
        case LightKind::Mesh:
            if (light.instance < scene.instances.size()) places.push_back(ofMesh(light, scene));
            break;
        }
    return places;
}

Vec3 LampPlaces::ofMesh(const Light& light, const Scene& scene)
{
    const Instance& instance = scene.instances[light.instance];
    const std::shared_ptr<const Mesh>& mesh = scene.meshes[instance.mesh];
    Known& known = _known[light.instance];
    if (known.changed != light.changed || known.mesh.lock() != mesh)
    {
        const ChangedBox lamp = instanceBounds(scene, instance);
        known = {light.changed, mesh, 0.5f * (lamp.low + lamp.high)};
    }
    return known.place;
}

} // namespace osgRayTrace::engine
