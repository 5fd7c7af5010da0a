// Prism.cpp - a glass prism in a narrow beam. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/AreaLight>

#include <osg/LightSource>

#include <cmath>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr double kSide = 8.0,
                 kHeight = 7.0;  ///< side and height of the prism: equilateral, upright [cm]
constexpr double kStands = 0.02; ///< gap between prism and table [cm]

constexpr float kRoom = 60.0f, kPlank = 3.0f; ///< half the room's side, width of a plank [cm]

/// Returns every other plank of the table: stripes show best what glass does to a view.
std::vector<Quad> planks(int first)
{
    std::vector<Quad> quads;
    for (int i = first; i < 40; i += 2)
    {
        const float x0 = -kRoom + kPlank * float(i), x1 = x0 + kPlank;
        quads.push_back(
            {Vec3(x0, -kRoom, 0), Vec3(x1, -kRoom, 0), Vec3(x1, kRoom, 0), Vec3(x0, kRoom, 0)});
    }
    return quads;
}

/// Returns three upright sides, bottom and top, with normals outwards.
std::vector<Quad> prismSides()
{
    const double radius = kSide / std::sqrt(3.0);
    std::array<Vec3d, 3> corner;
    for (int i = 0; i < 3; ++i)
    {
        const double angle = osg::DegreesToRadians(90.0 + 120.0 * i);
        corner[static_cast<std::size_t>(i)] =
            Vec3d(radius * std::cos(angle), radius * std::sin(angle), kStands);
    }
    const Vec3d up(0, 0, kHeight);
    std::vector<Quad> quads;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Vec3d &a = corner[i], &b = corner[(i + 1) % 3];
        quads.push_back({Vec3(a), Vec3(b), Vec3(b + up), Vec3(a + up)});
    }
    // The quad is a triangle with its first side halved.
    const Vec3d middle = (corner[0] + corner[1]) * 0.5;
    quads.push_back({Vec3(corner[0]), Vec3(corner[2]), Vec3(corner[1]), Vec3(middle)});
    quads.push_back(
        {Vec3(middle + up), Vec3(corner[1] + up), Vec3(corner[2] + up), Vec3(corner[0] + up)});
    return quads;
}

/// Returns a beam that enters the side with the corner at 210 degrees in its middle, as for the
/// least deviation: 48.59 degrees to its normal, 18.59 to the x axis [sin 48.59 = 1.5 sin 30]; a
/// little downwards.
osg::ref_ptr<osg::LightSource> beam()
{
    const double turn = std::asin(0.75) - osg::PI / 6.0, distance = 42.0, fall = 5.5;
    const Vec3d entry(-0.25 * kSide, kSide / std::sqrt(48.0), 1.5);
    const Vec3d from = entry - Vec3d(distance * std::cos(turn), distance * std::sin(turn), -fall);
    Vec3d along = entry - from;
    along.normalize();
    osg::ref_ptr<osg::Light> light = new osg::Light(1);
    light->setPosition(osg::Vec4(Vec3(from), 1.0f));
    light->setDirection(Vec3(along));
    light->setSpotCutoff(1.6f);
    light->setSpotExponent(0.0f);
    light->setAmbient(osg::Vec4(0, 0, 0, 1));
    light->setDiffuse(osg::Vec4(5e4f, 4.8e4f, 4.5e4f, 1));
    light->setSpecular(osg::Vec4(0, 0, 0, 1));
    light->setConstantAttenuation(0.0f);
    light->setQuadraticAttenuation(1.0f);
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setName("beam");
    source->setLight(light.get());
    return source;
}

} // namespace

osg::ref_ptr<osg::Group> prism()
{
    const SceneView view{Vec3d(5, -32, 19), Vec3d(3.0, 0.5, 2.0), Vec3d(0, 0, 1), 33.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("prism", view, view);
    const Vec3 light(0.6f, 0.56f, 0.5f), dark(0.3f, 0.27f, 0.24f);
    scene->addChild(surface("light planks", planks(0), lambert(light).get()));
    scene->addChild(surface("dark planks", planks(1), lambert(dark).get()));
    std::vector<Quad> walls = boxQuads(Vec3(-kRoom, -kRoom, 0), Vec3(kRoom, kRoom, kRoom));
    walls.erase(walls.begin()); // the floor is the table
    scene->addChild(surface("walls", walls, lambert(Vec3(0.75f, 0.73f, 0.7f)).get()));
    scene->addChild(surface("prism", prismSides(), glass(1.5f).get()));
    scene->addChild(beam().get());
    scene->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);

    osg::ref_ptr<AreaLight> sky =
        new AreaLight(Vec3(-35, 0, 59), Vec3(0, 20, 0), Vec3(30, 0, 0), Vec3(1.6f, 1.75f, 2.1f));
    sky->setName("sky");
    scene->addChild(sky.get());
    return scene;
}

} // namespace osgRayTrace::data
