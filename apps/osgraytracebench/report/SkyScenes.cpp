// SkyScenes.cpp - builds the planes under environments. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/report/SkyScenes.h"

#include "data/generator/Surfaces.h"

#include <osgRayTrace/EnvironmentLight>

#include <osg/Image>

#include <cmath>

namespace osgRayTrace::bench
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kWidth = 128, kHeight = 64;
constexpr int kSunColumn = 90, kSunRow = 44; ///< towards +x and +y, 36 degrees high
constexpr double kAlbedo = 0.5;
const Vec3d kSky(0.6, 0.8, 1.0);
const Vec3d kBall(0.0, 0.0, 0.7);
constexpr double kRadius = 0.5;

double borderZ(int row)
{
    return std::sin((double(row) / kHeight - 0.5) * osg::PI);
}

double sunSolidAngle()
{
    return 2.0 * osg::PI / kWidth * (borderZ(kSunRow + 1) - borderZ(kSunRow));
}

/// Returns the radiance with which the sun sends as much light as the rest of the sphere.
Vec3d sunRadiance()
{
    return kSky * ((4.0 * osg::PI - sunSolidAngle()) / sunSolidAngle());
}

/// Returns the integral of the cosine over the pixel of the sun, above a plane that looks to +z.
double sunProjectedAngle()
{
    const double low = borderZ(kSunRow), high = borderZ(kSunRow + 1);
    return osg::PI / kWidth * (high * high - low * low);
}

/// Returns the radiance from the sky, without the part that the ball hides [Snyder96], which is all
/// above the horizon, and from the sun.
Vec3d planeRadiance(const Vec3d& origin, const Vec3d& direction)
{
    const Vec3d point = origin - direction * (origin.z() / direction.z());
    const Vec3d towards = kBall - point;
    const double distance2 = towards.length2();
    const double hidden =
        osg::PI * kRadius * kRadius / distance2 * towards.z() / std::sqrt(distance2);
    return (kSky * (osg::PI - hidden) + (sunRadiance() - kSky) * sunProjectedAngle()) *
           (kAlbedo / osg::PI);
}

osg::ref_ptr<osg::Image> skyImage()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(kWidth, kHeight, 1, GL_RGB, GL_FLOAT);
    auto* pixels = reinterpret_cast<Vec3*>(image->data());
    std::fill(pixels, pixels + kWidth * kHeight, Vec3(kSky));
    pixels[kSunRow * kWidth + kSunColumn] = Vec3(sunRadiance());
    return image;
}

} // namespace

ReportScene sunnySkyScene()
{
    ReportScene scene;
    scene.name = "s9-sunny-sky";
    scene.title =
        "S9: a plane and a black ball under a sky, whose sun is one pixel with half of the light";
    const osg::ref_ptr<osg::Group> graph = data::newGraph("sunny sky");
    const data::Quad plane{Vec3(-20, -20, 0), Vec3(20, -20, 0), Vec3(20, 20, 0), Vec3(-20, 20, 0)};
    const auto albedo = static_cast<float>(kAlbedo);
    graph->addChild(
        data::surface("plane", {plane}, data::lambert(Vec3(albedo, albedo, albedo)).get()));
    graph->addChild(data::sphere("ball", Vec3(kBall), static_cast<float>(kRadius),
                                 data::lambert(Vec3(0, 0, 0)).get()));
    osg::ref_ptr<EnvironmentLight> sky = new EnvironmentLight(skyImage());
    sky->setName("sky");
    graph->addChild(sky.get());
    scene.graph = graph;
    // The view is straight down on the plane on the ball's sunny side.
    scene.view = osg::Matrixd::lookAt(Vec3d(1.0, 0.3, 0.6), Vec3d(1.0, 0.3, 0.0), Vec3d(0, 1, 0));
    scene.projection = osg::Matrixd::ortho(-0.45, 0.45, -0.45, 0.45, 0.01, 10.0);
    const Method path = pathMethod(1), whitted = whittedMethod(engine::LightSampling::Sobol, 16);
    // Uniform sampling is left out: it finds a sun of a pixel so seldom that no mean of the report
    // would be near the formula.
    scene.methods = {path, whitted};
    scene.placements = {atOrigin(), displaced()};
    scene.formula = planeRadiance;
    return scene;
}

} // namespace osgRayTrace::bench
