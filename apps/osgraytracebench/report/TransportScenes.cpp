// TransportScenes.cpp - methods and references of the scenes that are hard. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/TransportScenes.h"

#include "apps/osgraytracebench/report/BoxScenes.h"
#include "apps/osgraytracebench/report/PolygonLight.h"
#include "data/generator/Scenes.h"
#include "data/generator/Transport.h"

#include <osg/MatrixTransform>

#include <cstdio>

namespace osgRayTrace::bench
{

namespace
{

using osg::Vec3d;

constexpr int kBounces = 64;
constexpr int kSphereBounces = 256; ///< longer paths carry less than 1e-24 of the light

std::string numberText(const char* format, double value)
{
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

/// Returns a scene with PATH and SPPM. caustics: with PHOTON_CAUSTICS, too, which is then the
/// reference; else PATH is.
ReportScene sceneOf(const std::string& name, const std::string& title,
                    const osg::ref_ptr<osg::Group>& graph, bool caustics)
{
    ReportScene scene;
    scene.name = name;
    scene.title = title;
    scene.graph = graph;
    useStoredView(scene);
    const std::vector<Method> photons = photonMethods(kBounces, true); // PPM, SPPM, PHOTON_CAUSTICS
    scene.methods = {pathMethod(kBounces), photons[1]};
    if (caustics) scene.methods.push_back(photons[2]);
    scene.reference = caustics ? photons[2] : pathMethod(kBounces);
    scene.placements = {atOrigin()};
    scene.quick = false;
    return scene;
}

ReportScene windowScene(data::WindowKind kind, const std::string& name, const std::string& title)
{
    return sceneOf("window-" + name, "Room with a window of 1 m2, " + title,
                   data::window(kind, 1.0), kind == data::WindowKind::Box);
}

} // namespace

ReportScene twoSpheresScene(double f)
{
    ReportScene scene = sceneOf("two-spheres-" + numberText("%.0e", f),
                                "Two spheres and a port of " + numberText("%g", f) + " of either",
                                data::twoSpheres(f), false);
    for (Method& method : scene.methods)
        method.options.maxBounces = kSphereBounces;
    const double radiance = data::portRadiance(f).dark;
    scene.formula = [radiance](const Vec3d&, const Vec3d&)
    { return Vec3d(radiance, radiance, radiance); };
    scene.formulaNodes = 1;
    return scene;
}

ReportScene lampFieldScene(int lamps)
{
    const std::string count = std::to_string(lamps);
    ReportScene scene = sceneOf("lamp-field-" + count, count + " lamps over a plane",
                                data::lampField(lamps), false);
    scene.methods = {pathMethod(1)};
    std::vector<std::pair<Polygon, double>> polygons;
    for (const data::FieldLamp& lamp : data::fieldLamps(lamps))
        polygons.push_back({{lamp.corner, lamp.corner + lamp.edgeU,
                             lamp.corner + lamp.edgeU + lamp.edgeV, lamp.corner + lamp.edgeV},
                            lamp.radiance * data::kFieldAlbedo / osg::PI});
    const osg::Matrixd localFromScene =
        static_cast<const osg::MatrixTransform&>(*scene.graph).getInverseMatrix();
    scene.formula = [=](const Vec3d& origin, const Vec3d& direction)
    {
        const Vec3d begin = origin * localFromScene;
        const Vec3d ray = (origin + direction) * localFromScene - begin;
        const Vec3d point = begin - ray * (begin.z() / ray.z());
        double sum = 0.0;
        for (const auto& [polygon, scale] : polygons)
            sum += scale * irradiance(polygon, point, Vec3d(0, 0, 1));
        return Vec3d(sum, sum, sum);
    };
    scene.formulaNodes = 2;
    return scene;
}

std::vector<ReportScene> transportScenes()
{
    std::vector<ReportScene> scenes;
    for (const double f : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5})
        scenes.push_back(twoSpheresScene(f));
    for (const int lamps : {10, 1000})
        scenes.push_back(lampFieldScene(lamps));
    for (const double slit : {0.01, 0.08, 0.32})
        scenes.push_back(sceneOf("ajar-" + numberText("%g", 100.0 * slit),
                                 "A door that is ajar by " + numberText("%g cm", 100.0 * slit),
                                 data::ajar(slit, false), false));
    scenes.push_back(sceneOf("ajar-8-glossy", "A door that is ajar by 8 cm, glossy floor",
                             data::ajar(0.08, true), false));
    scenes.push_back(windowScene(data::WindowKind::Open, "open", "open"));
    scenes.push_back(windowScene(data::WindowKind::Pane, "pane", "thin pane"));
    scenes.push_back(windowScene(data::WindowKind::Box, "box", "pane of 1 cm"));
    for (const int lamps : {10, 100, 1000})
        scenes.push_back(sceneOf("city-" + std::to_string(lamps),
                                 std::to_string(lamps) + " street lamps", data::city(lamps),
                                 false));
    scenes.push_back(sceneOf("pool", "The floor of a pool", data::pool(0.03), true));
    for (const double roughness : {0.0, 0.1, 0.25, 0.4})
        scenes.push_back(sceneOf("rings-" + numberText("%g", roughness),
                                 "Rings of roughness " + numberText("%g", roughness),
                                 data::rings(roughness), true));
    for (const double roughness : {0.1, 0.3})
        scenes.push_back(sceneOf("necklace-" + numberText("%g", roughness),
                                 "A chain of roughness " + numberText("%g", roughness),
                                 data::necklace(roughness), true));
    scenes.push_back(
        sceneOf("veach-plates", "Plates that mirror lamps", data::veachPlates(1.0), false));
    scenes.push_back(
        sceneOf("veach-room", "Room with a spot and an egg", data::veachRoom(0.3), true));
    return scenes;
}

} // namespace osgRayTrace::bench
