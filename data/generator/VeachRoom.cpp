// VeachRoom.cpp - a room with light by way of its ceiling and an egg of glass. Part of the scene
// generator.
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

/// Returns an egg that stands on its end: half an ellipsoid of the height below, and a slimmer one
/// above.
std::vector<ProfilePoint> eggProfile(double length)
{
    constexpr int kSteps = 24;
    const double radius = 0.37 * length, below = 0.42 * length, above = 0.58 * length;
    std::vector<ProfilePoint> profile;
    for (int i = 0; i <= kSteps; ++i)
    {
        const double angle = osg::PI * i / kSteps; // from the lower end
        const double half = angle < 0.5 * osg::PI ? below : above;
        const double across = i % kSteps ? std::sin(angle) : 0.0, along = -std::cos(angle);
        Vec3d normal(across / radius, 0.0, along / half);
        normal.normalize();
        profile.push_back({radius * across, below + half * along, normal.x(), normal.z()});
    }
    return profile;
}

} // namespace

osg::ref_ptr<osg::Group> veachRoom(double egg)
{
    const SceneView view{Vec3d(2.0, -3.6, 1.7), Vec3d(1.9, 1.0, 0.9), Vec3d(0, 0, 1), 45.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("Veach's room", view, view);
    const float w = 4.0f, d = 3.0f, h = 2.8f, front = -4.0f;
    const osg::ref_ptr<PhysicalMaterial> white = lambert(Vec3(0.7f, 0.68f, 0.64f));
    scene->addChild(surface("floor",
                            {{Vec3(0, front, 0), Vec3(w, front, 0), Vec3(w, d, 0), Vec3(0, d, 0)}},
                            lambert(Vec3(0.4f, 0.3f, 0.2f)).get()));
    scene->addChild(
        surface("walls",
                {{Vec3(0, front, h), Vec3(0, d, h), Vec3(w, d, h), Vec3(w, front, h)},
                 {Vec3(0, d, 0), Vec3(w, d, 0), Vec3(w, d, h), Vec3(0, d, h)},
                 {Vec3(0, front, 0), Vec3(0, d, 0), Vec3(0, d, h), Vec3(0, front, h)},
                 {Vec3(w, d, 0), Vec3(w, front, 0), Vec3(w, front, h), Vec3(w, d, h)},
                 {Vec3(w, front, 0), Vec3(0, front, 0), Vec3(0, front, h), Vec3(w, front, h)}},
                white.get()));
    scene->addChild(surface("table", boxQuads(Vec3(1.3f, 0.7f, 0.68f), Vec3(2.7f, 1.7f, 0.72f)),
                            lambert(Vec3(0.5f, 0.25f, 0.15f)).get()));
    scene->addChild(
        turned("egg", eggProfile(egg), Vec3d(2.05, 1.15, 0.7205), 48, glass(1.5f).get()));
    // A floor lamp: a shade that is open above and below, and a lamp in it that looks up.
    scene->addChild(turned("shade", {{0.12, 1.6, 0.0, -1.0}, {0.22, 1.9, 1.0, 0.0}},
                           Vec3d(0.6, 2.2, 0), 48, lambert(Vec3(0.1f, 0.1f, 0.1f)).get()));
    scene->addChild(new AreaLight(Vec3(0.55f, 2.15f, 1.65f), Vec3(0.1f, 0, 0), Vec3(0, 0.1f, 0),
                                  Vec3(500, 430, 330)));
    // A spot on the wall: a lamp deep in a tube, turned to the ceiling.
    const osg::ref_ptr<osg::MatrixTransform> spot = new osg::MatrixTransform(
        osg::Matrixd::rotate(osg::DegreesToRadians(-35.0), osg::Vec3d(0, 1, 0)) *
        osg::Matrixd::translate(3.85, 1.4, 1.7));
    spot->addChild(turned("tube", {{0.06, 0.0, 1.0, 0.0}, {0.06, 0.2, 1.0, 0.0}}, Vec3d(), 48,
                          lambert(Vec3(0.05f, 0.05f, 0.05f)).get()));
    spot->addChild(new AreaLight(Vec3(-0.03f, -0.03f, 0.02f), Vec3(0.06f, 0, 0), Vec3(0, 0.06f, 0),
                                 Vec3(1800, 1750, 1650)));
    scene->addChild(spot.get());
    return scene;
}

} // namespace osgRayTrace::data
