// Enclosures.cpp - finds proxies around everything that light does not get through. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/Enclosures.h"

#include "osgRayTrace/bridge/geometry/GeometryConverter.h"
#include "osgRayTrace/shading/EmissiveMesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgRayTrace::engine
{

namespace
{

/// At most so many places of the rest of the graph are looked at.
constexpr std::size_t kMostPlaces = 16;

struct Box
{
    Vec3d low{std::numeric_limits<double>::infinity()};
    Vec3d high{-std::numeric_limits<double>::infinity()};

    Vec3d centre() const { return 0.5 * (low + high); }
    double diagonal() const { return glm::length(high - low); }
    bool contains(const Box& other) const
    {
        const Vec3d margin = kEnclosureMargin * (high - low);
        return glm::all(glm::lessThanEqual(low - margin, other.low)) &&
               glm::all(glm::lessThanEqual(other.high, high + margin));
    }
};

Vec3d toVec3d(const osg::Vec3d& v)
{
    return {v.x(), v.y(), v.z()};
}

/// Returns the box of a geometry's use, in engine space.
Box boxOf(const VertexBounds& bounds, const osg::Matrixd& engineFromLocal)
{
    Box box;
    for (int corner = 0; corner < 8; ++corner)
    {
        const osg::Vec3d p(corner & 1 ? bounds.high.x : bounds.low.x,
                           corner & 2 ? bounds.high.y : bounds.low.y,
                           corner & 4 ? bounds.high.z : bounds.low.z);
        const Vec3d q = toVec3d(p * engineFromLocal);
        box.low = glm::min(box.low, q);
        box.high = glm::max(box.high, q);
    }
    return box;
}

/// Returns the box of an instance: that around the placed box of its mesh.
Box boxOf(const Mesh& mesh, const Affine& engineFromLocal)
{
    Vec3 low(kInfinity), high(-kInfinity);
    for (const Vec3& p : mesh.positions)
    {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    placeBox(engineFromLocal, low, high);
    return {Vec3d(low), Vec3d(high)};
}

struct PlacedUse
{
    std::size_t geometry = 0, use = 0; ///< indices in the graph
    Box box;
};

/// Holds a light from outside of everything: a direction towards it, or a place.
struct FarLight
{
    Vec3d place{0.0};
    bool directional = false;
};

/// Returns the lights of the graph and of the viewer that cast shadows.
std::vector<FarLight> lightsOf(const CollectedGraph& graph, const ConversionInput& input)
{
    std::vector<FarLight> lights;
    const osg::Matrixd engineFromWorld = osg::Matrixd::translate(-input.origin);
    const osg::Matrixd engineFromEye =
        input.view ? osg::Matrixd::inverse(input.view->viewFromWorld) * engineFromWorld
                   : osg::Matrixd::translate(input.eye - input.origin);
    const auto add = [&lights](const osg::Light& light, const osg::Matrixd& engineFromLight)
    {
        const osg::Vec4d position = osg::Vec4d(light.getPosition()) * engineFromLight;
        const bool directional = light.getPosition().w() == 0.0f;
        const double w = directional ? 1.0 : position.w();
        lights.push_back({Vec3d(position.x(), position.y(), position.z()) / w, directional});
    };
    for (const CollectedLight& light : graph.lights.lights)
        add(*light.source->getLight(), light.eyeSpace ? engineFromEye : light.engineFromLocal);
    if (input.viewLight && (!input.viewLightInEyeSpace || input.headlightShadows))
        add(*input.viewLight, input.viewLightInEyeSpace ? engineFromEye : engineFromWorld);
    for (const CollectedAreaLight& light : graph.lights.areaLights)
        lights.push_back(
            {toVec3d(osg::Vec3d(light.light->getCorner()) * light.engineFromLocal), false});
    return lights;
}

/// Returns whether a mesh in engine space stops a ray before its end [MollerTrumbore97, eq. 6].
bool stops(const Mesh& mesh, const Vec3d& from, const Vec3d& along, double end)
{
    for (const UVec3& t : mesh.triangles)
    {
        const Vec3d a(mesh.positions[t.x]);
        const Vec3d ab = Vec3d(mesh.positions[t.y]) - a, ac = Vec3d(mesh.positions[t.z]) - a;
        const Vec3d p = glm::cross(along, ac), q = glm::cross(from - a, ab);
        const double determinant = glm::dot(p, ab);
        if (determinant == 0.0) continue;
        const double u = glm::dot(p, from - a) / determinant;
        const double v = glm::dot(q, along) / determinant;
        const double distance = glm::dot(q, ac) / determinant;
        if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance < end) return true;
    }
    return false;
}

/// Returns whether a mesh hides so much of the surroundings from a place as a dome does, which may
/// be open below.
bool hidesSurroundings(const Mesh& mesh, const Vec3d& from)
{
    int hidden = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0})
        {
            Vec3d along(0.0);
            along[axis] = sign;
            hidden += stops(mesh, from, along, std::numeric_limits<double>::infinity());
        }
    return hidden >= 5;
}

/// Returns whether a light outside of the box reaches none of the places through the mesh.
bool keepsLightOff(const Mesh& mesh, const Box& box, const std::vector<Vec3d>& places,
                   const std::vector<FarLight>& lights, bool environment)
{
    const auto isDark = [&](const FarLight& light)
    {
        if (!light.directional && box.contains({light.place, light.place})) return false;
        return std::all_of(places.begin(), places.end(),
                           [&](const Vec3d& place)
                           {
                               if (light.directional)
                                   return stops(mesh, place, light.place,
                                                std::numeric_limits<double>::infinity());
                               return stops(mesh, place, light.place - place, 1.0);
                           });
    };
    if (std::any_of(lights.begin(), lights.end(), isDark)) return true;
    return environment &&
           std::all_of(places.begin(), places.end(),
                       [&](const Vec3d& place) { return hidesSurroundings(mesh, place); });
}

/// Returns the uses that have bounds, the largest first.
std::vector<PlacedUse> usesBySize(const CollectedGraph& graph)
{
    std::vector<PlacedUse> uses;
    for (std::size_t g = 0; g < graph.geometries.size(); ++g)
    {
        const CollectedGeometry& geometry = graph.geometries[g];
        for (std::size_t u = 0; u < geometry.uses.size() && geometry.bounds->count > 0; ++u)
            uses.push_back({g, u, boxOf(*geometry.bounds, geometry.uses[u].engineFromLocal)});
    }
    std::stable_sort(uses.begin(), uses.end(),
                     [](const PlacedUse& a, const PlacedUse& b)
                     { return a.box.diagonal() > b.box.diagonal(); });
    return uses;
}

/// Returns the middles of some of the uses from begin on, evenly chosen.
std::vector<Vec3d> placesOf(const std::vector<PlacedUse>& uses, std::size_t begin)
{
    std::vector<Vec3d> places;
    const std::size_t count = uses.size() - begin;
    const std::size_t step = (count + kMostPlaces - 1) / kMostPlaces;
    for (std::size_t i = begin; i < uses.size(); i += step)
        places.push_back(uses[i].box.centre());
    return places;
}

void drop(const std::vector<PlacedUse>& uses, std::size_t count, CollectedGraph& graph)
{
    for (std::size_t i = 0; i < count; ++i)
    {
        CollectedGeometry& geometry = graph.geometries[uses[i].geometry];
        GeometryUse& use = geometry.uses[uses[i].use];
        use.state = kInvalid;
        graph.enclosures.push_back({geometry.geometry, use.engineFromLocal, *geometry.bounds});
    }
    for (CollectedGeometry& geometry : graph.geometries)
        geometry.uses.erase(std::remove_if(geometry.uses.begin(), geometry.uses.end(),
                                           [](const GeometryUse& use)
                                           { return use.state == kInvalid; }),
                            geometry.uses.end());
    graph.geometries.erase(std::remove_if(graph.geometries.begin(), graph.geometries.end(),
                                          [](const CollectedGeometry& geometry)
                                          { return geometry.uses.empty(); }),
                           graph.geometries.end());
}

} // namespace

void dropEnclosures(CollectedGraph& graph, const ConversionInput& input)
{
    const std::vector<PlacedUse> uses = usesBySize(graph);
    const std::vector<FarLight> lights = lightsOf(graph, input);
    const bool environment = !graph.lights.environments.empty();
    std::size_t dropped = 0;
    while (dropped + 1 < uses.size())
    {
        const PlacedUse& outer = uses[dropped];
        const CollectedGeometry& geometry = graph.geometries[outer.geometry];
        if (!geometry.uses[outer.use].proxy) break;
        const bool encloses =
            std::all_of(uses.begin() + static_cast<std::ptrdiff_t>(dropped) + 1, uses.end(),
                        [&outer](const PlacedUse& use) { return outer.box.contains(use.box); });
        if (!encloses)
        {
            graph.enclosures.push_back({geometry.geometry, geometry.uses[outer.use].engineFromLocal,
                                        *geometry.bounds, false});
            break;
        }
        MeshRequest request;
        request.restart = geometry.restart;
        request.transform = geometry.uses[outer.use].engineFromLocal;
        const ConvertedMesh converted = convertGeometry(*geometry.geometry, request, KeptArrays());
        if (!converted.mesh || !keepsLightOff(*converted.mesh, outer.box,
                                              placesOf(uses, dropped + 1), lights, environment))
            break;
        ++dropped;
    }
    if (dropped > 0) drop(uses, dropped, graph);
}

bool mayEnclose(const Scene& scene, const VertexBounds& bounds, const osg::Matrixd& engineFromLocal,
                Stamp since)
{
    const Box box = boxOf(bounds, engineFromLocal);
    const auto isAsked = [&](const Instance& instance)
    { return instance.changed >= since && !scene.meshes[instance.mesh]->positions.empty(); };
    const auto isFirstOutside = [&](const Instance& instance)
    {
        if (!isAsked(instance)) return false;
        const Vec3d p(
            transformPoint(instance.engineFromLocal, scene.meshes[instance.mesh]->positions[0]));
        return !box.contains({p, p});
    };
    const auto isOutside = [&](const Instance& instance)
    {
        return isAsked(instance) &&
               !box.contains(boxOf(*scene.meshes[instance.mesh], instance.engineFromLocal));
    };
    const auto& instances = scene.instances; // mostly a look at one vertex of each is enough
    return std::none_of(instances.begin(), instances.end(), isFirstOutside) &&
           std::none_of(instances.begin(), instances.end(), isOutside);
}

void dropDoubtful(std::vector<Enclosure>& enclosures, const Scene& scene)
{
    enclosures.erase(std::remove_if(enclosures.begin(), enclosures.end(),
                                    [&scene](const Enclosure& one) {
                                        return !one.encloses &&
                                               mayEnclose(scene, one.bounds, one.engineFromLocal);
                                    }),
                     enclosures.end());
}

} // namespace osgRayTrace::engine
