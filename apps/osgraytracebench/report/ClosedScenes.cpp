// ClosedScenes.cpp - builds the closed rooms. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/ClosedScenes.h"

#include "data/generator/Surfaces.h"

#include <osg/Geometry>
#include <osg/LightSource>

#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kBounces =
    256; ///< longer paths carry less than 1e-11 of the light for albedos up to 0.9

constexpr double kSphereAlbedo = 0.5;
const Vec3d kSpot(0.35, 0.2, 0.15); ///< point light in the unit sphere

/// Returns the unit sphere with its normals, so fine that its facets leave the ideal one by 2e-5.
osg::ref_ptr<osg::Geometry> fineSphere()
{
    constexpr unsigned kRows = 250, kColumns = 500;
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUInt> triangles = new osg::DrawElementsUInt(GL_TRIANGLES);
    const auto add = [&triangles](unsigned a, unsigned b, unsigned c)
    {
        for (const unsigned index : {a, b, c})
            triangles->push_back(index);
    };
    for (unsigned row = 0; row <= kRows; ++row)
    {
        for (unsigned column = 0; column <= kColumns; ++column)
        {
            const double theta = osg::PI * row / kRows, phi = 2.0 * osg::PI * column / kColumns;
            const Vec3d outwards(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                 std::cos(theta));
            positions->push_back(outwards);
            normals->push_back(-outwards);
            if (row == kRows || column == kColumns) continue;
            const unsigned a = row * (kColumns + 1) + column, b = a + kColumns + 1;
            if (row > 0) add(a, a + 1, b); // at the poles one triangle of the two is a line
            if (row + 1 < kRows) add(a + 1, b + 1, b);
        }
    }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(positions.get());
    geometry->setNormalArray(normals.get(), osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(triangles.get());
    return geometry;
}

/// Returns a light of intensity pi in all directions: diffuse 1 means an irradiance of pi at
/// distance 1.
osg::ref_ptr<osg::LightSource> pointLight()
{
    osg::ref_ptr<osg::Light> light = new osg::Light(1);
    light->setPosition(osg::Vec4(Vec3(kSpot), 1.0f));
    light->setAmbient(osg::Vec4(0, 0, 0, 1));
    light->setDiffuse(osg::Vec4(1, 1, 1, 1));
    light->setSpecular(osg::Vec4(0, 0, 0, 1));
    light->setConstantAttenuation(0.0f);
    light->setQuadraticAttenuation(1.0f);
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setLight(light.get());
    return source;
}

/// Returns direct light, and indirect light that is equal everywhere: for a flux F that lands on
/// the wall of radius 1 the irradiance is albedo F / (4 pi (1 - albedo)), however the flux is
/// spread.
Vec3d sphereRadiance(const Vec3d& origin, const Vec3d& direction)
{
    const Vec3d ray = direction / direction.length();
    const double along = ray * origin;
    const Vec3d wall = origin + ray * (std::sqrt(along * along - origin.length2() + 1.0) - along);
    const Vec3d towards = kSpot - wall;
    const double cosine = -(towards * wall) / towards.length();
    const double radiance = kSphereAlbedo * cosine / towards.length2() +
                            kSphereAlbedo * kSphereAlbedo / (1.0 - kSphereAlbedo);
    return Vec3d(radiance, radiance, radiance);
}

} // namespace

ReportScene furnaceScene(double albedo)
{
    const float reflected = static_cast<float>(albedo);
    const osg::ref_ptr<PhysicalMaterial> wall =
        data::lambert(Vec3(reflected, reflected, reflected));
    wall->setEmission(Vec3(1, 1, 1));
    const osg::ref_ptr<osg::Group> graph = data::newGraph("furnace");
    graph->addChild(
        data::surface("room", data::boxQuads(Vec3(-1, -1, -1), Vec3(1, 1, 1)), wall.get()).get());

    ReportScene scene;
    const std::string percent = std::to_string(static_cast<int>(std::lround(100.0 * albedo)));
    scene.name = "furnace-" + percent;
    scene.title = "Closed room that emits 1 and reflects " + percent + " %";
    scene.graph = graph;
    scene.view = osg::Matrixd::lookAt(Vec3d(0, -0.8, 0), Vec3d(0, 0, 0), Vec3d(0, 0, 1));
    scene.projection = osg::Matrixd::perspective(60.0, 1.0, 0.01, 100.0);
    scene.methods = {pathMethod(kBounces)};
    scene.placements = {atOrigin(), displaced()};
    const double exact = static_cast<double>(reflected);
    const double radiance = (1.0 - std::pow(exact, kBounces + 1)) / (1.0 - exact);
    scene.formula = [radiance](const Vec3d&, const Vec3d&)
    { return Vec3d(radiance, radiance, radiance); };
    scene.formulaNodes = 1;
    return scene;
}

ReportScene integratingSphereScene()
{
    const float albedo = static_cast<float>(kSphereAlbedo);
    const osg::ref_ptr<osg::Group> graph = data::newGraph("integrating sphere");
    osg::ref_ptr<osg::Geode> wall = new osg::Geode;
    wall->getOrCreateStateSet()->setAttribute(data::lambert(Vec3(albedo, albedo, albedo)).get());
    wall->addDrawable(fineSphere().get());
    graph->addChild(wall.get());
    graph->addChild(pointLight().get());
    graph->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);

    ReportScene scene;
    scene.name = "integrating-sphere";
    scene.title = "White sphere with a point light away from its centre";
    scene.graph = graph;
    scene.view = osg::Matrixd::lookAt(Vec3d(-0.5, -0.6, -0.2), kSpot, Vec3d(0, 0, 1));
    scene.projection = osg::Matrixd::perspective(80.0, 1.0, 0.01, 100.0);
    scene.methods = {pathMethod(kBounces)};
    for (const Method& method : photonMethods(kBounces, false))
        scene.methods.push_back(method);
    scene.placements = {atOrigin(), displaced()};
    scene.formula = sphereRadiance;
    return scene;
}

} // namespace osgRayTrace::bench
