// SphereScenes.cpp - builds the planes under spheres. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/SphereScenes.h"

#include "data/generator/Surfaces.h"

#include <osg/LightSource>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr double kAlbedo = 0.5;
constexpr double kRadius = 0.5;
const Vec3d kRadiance(4.0, 3.0, 2.0);

/// Returns the irradiance of a sphere of radiance 1, by its sine and the angle of its centre; the
/// part below the horizon gives nothing [Snyder96].
double sphereIrradiance(double sine, double theta)
{
    const double edge = std::asin(sine);
    if (theta >= 0.5 * M_PI + edge) return 0.0;
    const double cosine = std::cos(theta), sinTheta = std::sin(theta);
    if (theta <= 0.5 * M_PI - edge) return M_PI * sine * sine * cosine;
    const double x = std::sqrt(1.0 / (sine * sine) - 1.0);
    const double y = std::clamp(-x * cosine / sinTheta, -1.0, 1.0);
    const double root = std::sqrt(1.0 - y * y);
    return (cosine * std::acos(y) - x * sinTheta * root) * sine * sine +
           std::atan(sinTheta * root / x);
}

/// Returns a light that fades as a sphere of this radiance does.
osg::ref_ptr<osg::LightSource> sphereLight(double height)
{
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setName("lamp");
    osg::Light& light = *source->getLight();
    light.setLightNum(0);
    light.setPosition(osg::Vec4(0.0f, 0.0f, static_cast<float>(height), 1.0f));
    light.setAmbient(osg::Vec4(0, 0, 0, 1));
    light.setDiffuse(osg::Vec4(Vec3(kRadiance * (kRadius * kRadius)), 1.0f));
    light.setConstantAttenuation(0.0f);
    light.setQuadraticAttenuation(1.0f);
    return source;
}

ReportScene scene(const std::string& name, const std::string& title, double height)
{
    ReportScene scene;
    scene.name = name;
    scene.title = title;
    const osg::ref_ptr<osg::Group> graph = data::newGraph("plane");
    const data::Quad plane{Vec3(-20, -20, 0), Vec3(20, -20, 0), Vec3(20, 20, 0), Vec3(-20, 20, 0)};
    const osg::ref_ptr<PhysicalMaterial> grey = data::lambert(Vec3(kAlbedo, kAlbedo, kAlbedo));
    graph->addChild(data::surface("plane", {plane}, grey.get()).get());
    graph->addChild(sphereLight(height).get());
    graph->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    graph->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    scene.graph = graph;
    scene.lightSizes.byName["lamp"] = static_cast<float>(kRadius);
    // The plane fills the picture; no point of the plane is inside of the sphere.
    scene.view = osg::Matrixd::lookAt(Vec3d(1.6, -1.2, 0.9), Vec3d(1.3, 0.1, 0.0), Vec3d(0, 0, 1));
    scene.projection = osg::Matrixd::perspective(35.0, 1.0, 0.01, 100.0);
    scene.methods = directMethods();
    scene.placements = {atOrigin(), displaced()};
    scene.formula = [height](const Vec3d& origin, const Vec3d& direction)
    {
        const Vec3d point = origin - direction * (origin.z() / direction.z());
        const Vec3d towards = Vec3d(0.0, 0.0, height) - point;
        const double distance = towards.length();
        return kRadiance *
               (kAlbedo / M_PI *
                sphereIrradiance(kRadius / distance, std::acos(towards.z() / distance)));
    };
    return scene;
}

} // namespace

ReportScene sphereLightScene()
{
    return scene("s3-sphere", "S3: a point light with a radius over a plane", 1.0);
}

ReportScene sunkenSphereScene()
{
    return scene("s3-sunken-sphere", "S3, partly below the horizon", 0.1);
}

} // namespace osgRayTrace::bench
