// TwoSpheres.cpp - two spheres joined by a port, whose light has a formula. Part of the scene
// generator.
// SPDX-License-Identifier: MIT
//
// A point of a sphere sees each part of the sphere under a projected solid angle of pi times the
// part's share of the sphere, wherever the part is. The port looks like the cap that it replaces,
// with the radiance of the other sphere. So the radiance is even in each sphere:
//
//   L1 = E + rho ((1 - f) L1 + f L2),  L2 = rho ((1 - f) L2 + f L1)
#include "Surfaces.h"
#include "Transport.h"

#include <cmath>

namespace osgRayTrace::data
{

namespace
{

constexpr int kColumns = 256, kNearRows = 24, kRows = 64;
constexpr double kAlbedo = 0.8, kEmission = 1.0;

/// Returns the profile of a sphere without the cap of this height around +z, or around -z for
/// turned spheres. The normals point inwards. Rows are close to each other beside the port.
std::vector<ProfilePoint> profileOf(double cap, bool upwards)
{
    const double centre = upwards ? 1.0 - cap : cap - 1.0, side = upwards ? -1.0 : 1.0;
    const double first = std::acos(1.0 - cap), near = std::max(0.2, first);
    std::vector<ProfilePoint> profile;
    const auto add = [&](double angle)
    {
        const double across = angle < osg::PI ? std::sin(angle) : 0.0, along = std::cos(angle);
        profile.push_back({across, centre + side * along, -across, -side * along});
    };
    for (int row = 0; row < kNearRows && near > first; ++row)
        add(first * std::pow(near / first, double(row) / kNearRows));
    for (int row = 0; row <= kRows; ++row)
        add(row < kRows ? near + (osg::PI - near) * row / kRows : osg::PI);
    return profile;
}

} // namespace

PortRadiance portRadiance(double f)
{
    const double own = 1.0 - kAlbedo * (1.0 - f), other = kAlbedo * f;
    const double shining = kEmission / (own - other * other / own);
    return {shining, other / own * shining};
}

osg::ref_ptr<osg::Group> twoSpheres(double f)
{
    const auto albedo = static_cast<float>(kAlbedo), emission = static_cast<float>(kEmission);
    const double cap = 2.0 * f; // the cap's area is 2 pi times its height
    const osg::ref_ptr<PhysicalMaterial> dark = lambert(osg::Vec3(albedo, albedo, albedo));
    const osg::ref_ptr<PhysicalMaterial> shining = lambert(osg::Vec3(albedo, albedo, albedo));
    shining->setEmission(osg::Vec3(emission, emission, emission));
    const SceneView view{osg::Vec3d(0, 0, 1.0 - cap), osg::Vec3d(0.6, 0.3, 1.4 - cap),
                         osg::Vec3d(0, 0, 1), 60.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("two spheres", view, view);
    scene->addChild(
        turned("shining sphere", profileOf(cap, false), osg::Vec3d(), kColumns, shining.get()));
    scene->addChild(
        turned("dark sphere", profileOf(cap, true), osg::Vec3d(), kColumns, dark.get()));
    return scene;
}

} // namespace osgRayTrace::data
