// VeachPlates.cpp - plates of four roughnesses that mirror four lamps. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Surfaces.h"
#include "Transport.h"

#include <osgRayTrace/AreaLight>

#include <cmath>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

const Vec3d kEye(0.0, -9.0, 4.0);
constexpr double kLampY = 5.0, kLampZ = 4.0; ///< where the lamps stand [m]

/// Returns a plate around a place in the plane x = 0, turned so that the eye sees the lamps in it.
Quad plateAt(const Vec3d& place)
{
    Vec3d toEye = kEye - place, toLamps = Vec3d(0, kLampY, kLampZ) - place;
    toEye.normalize();
    toLamps.normalize();
    Vec3d normal = toEye + toLamps;
    normal.normalize();
    const Vec3d along = (normal ^ Vec3d(1, 0, 0)) * 0.55, across(3.6, 0, 0);
    return {Vec3(place - across + along), Vec3(place - across - along),
            Vec3(place + across - along), Vec3(place + across + along)};
}

} // namespace

osg::ref_ptr<osg::Group> veachPlates(double scale)
{
    const SceneView view{kEye, Vec3d(0, 0.6, 1.4), Vec3d(0, 0, 1), 42.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("Veach's plates", view, view);
    scene->addChild(surface("room",
                            {{Vec3(-9, -4, 0), Vec3(9, -4, 0), Vec3(9, 7, 0), Vec3(-9, 7, 0)},
                             {Vec3(-9, 7, 0), Vec3(9, 7, 0), Vec3(9, 7, 9), Vec3(-9, 7, 9)}},
                            lambert(Vec3(0.3f, 0.3f, 0.3f)).get()));
    const double roughness[] = {0.005, 0.05, 0.12, 0.3};
    for (int i = 0; i < 4; ++i)
    {
        const osg::ref_ptr<PhysicalMaterial> plate = metal(Vec3(0.7f, 0.7f, 0.75f));
        plate->setRoughness(static_cast<float>(std::sqrt(std::min(1.0, roughness[i] * scale))));
        scene->addChild(
            surface("plate", {plateAt(Vec3d(0, 2.6 - 1.5 * i, 1.9 - 0.45 * i))}, plate.get()));
    }
    // All lamps have the same power, and look at the plates.
    const double sides[] = {0.066, 0.2, 0.6, 1.8};
    const Vec3 colors[] = {Vec3(1, 0.6f, 0.5f), Vec3(1, 1, 0.6f), Vec3(0.6f, 1, 0.7f),
                           Vec3(0.6f, 0.7f, 1)};
    for (int i = 0; i < 4; ++i)
    {
        const auto side = static_cast<float>(sides[i]), half = 0.5f * side;
        const auto x = -3.75f + 2.5f * float(i);
        const Vec3 u(side, 0, 0), v(0, -0.55f * side, 0.835f * side); // front: down and to the eye
        const Vec3 middle(x, static_cast<float>(kLampY), static_cast<float>(kLampZ));
        scene->addChild(new AreaLight(middle - u * 0.5f - v * 0.5f, u, v,
                                      colors[i] * (3.0f / (4.0f * half * half))));
    }
    return scene;
}

} // namespace osgRayTrace::data
