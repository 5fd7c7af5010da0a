// LampField.cpp - any number of lamps over a plane. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Surfaces.h"
#include "Transport.h"

#include <osgRayTrace/AreaLight>

#include <cmath>
#include <random>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr double kSide = 10.0, kHeight = 1.0;
constexpr double kPower = 200.0; ///< of all lamps, over pi

} // namespace

std::vector<FieldLamp> fieldLamps(int count)
{
    std::mt19937 engine(3);
    const auto number = [&](double low, double high)
    { return low + (high - low) * (static_cast<double>(engine() >> 8) * 0x1p-24); };
    const int cells = static_cast<int>(std::ceil(std::sqrt(double(count))));
    const double cell = kSide / cells;
    std::vector<FieldLamp> lamps;
    double sum = 0.0;
    for (int i = 0; i < count; ++i)
    {
        const Vec3d middle(-0.5 * kSide + cell * (i % cells + 0.5),
                           -0.5 * kSide + cell * (i / cells + 0.5), kHeight);
        const double angle = number(0.0, 2.0 * osg::PI), lean = number(0.8, 2.2);
        const double u = cell * number(0.05, 0.3), v = cell * number(0.05, 0.3);
        FieldLamp lamp;
        lamp.edgeU = Vec3d(std::cos(angle), std::sin(angle), 0.0) * u;
        // edgeU, edgeV in this order: the front looks down.
        lamp.edgeV = Vec3d(std::cos(angle - lean), std::sin(angle - lean), 0.0) * v;
        lamp.corner = middle - (lamp.edgeU + lamp.edgeV) * 0.5;
        const double power = std::pow(10.0, number(-1.0, 1.0));
        lamp.radiance = power / (u * v * std::sin(lean));
        sum += power;
        lamps.push_back(lamp);
    }
    for (FieldLamp& lamp : lamps)
        lamp.radiance *= kPower / sum;
    return lamps;
}

osg::ref_ptr<osg::Group> lampField(int count)
{
    const SceneView view{Vec3d(0.4, -1.2, 0.9), Vec3d(0.6, -0.4, 0.0), Vec3d(0, 0, 1), 55.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("lamps over a plane", view, view);
    const auto albedo = static_cast<float>(kFieldAlbedo);
    scene->addChild(
        surface("plane", {{Vec3(-40, -40, 0), Vec3(40, -40, 0), Vec3(40, 40, 0), Vec3(-40, 40, 0)}},
                lambert(Vec3(albedo, albedo, albedo)).get()));
    for (const FieldLamp& lamp : fieldLamps(count))
    {
        const auto radiance = static_cast<float>(lamp.radiance);
        scene->addChild(new AreaLight(Vec3(lamp.corner), Vec3(lamp.edgeU), Vec3(lamp.edgeV),
                                      Vec3(radiance, radiance, radiance)));
    }
    return scene;
}

} // namespace osgRayTrace::data
