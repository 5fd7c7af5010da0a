// Drinks.cpp - glasses of milk and of a golden drink, and wax. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/AreaLight>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kColumns = 64, kRimSteps = 8;
constexpr double kOuter = 3.6, kWall = 0.3, kInner = kOuter - kWall; ///< radii of a glass [cm]
constexpr double kHeight = 11.0, kBase = 1.2, kLevel = 8.0;

osg::ref_ptr<PhysicalMaterial> filled(float ior, Medium* medium)
{
    osg::ref_ptr<PhysicalMaterial> material = glass(ior);
    material->setInterior(medium);
    return material;
}

/// Returns the milk, thinned with four parts of water [1/cm]: the sum of scattering is that of
/// isotropic scattering.
osg::ref_ptr<Medium> milk()
{
    osg::ref_ptr<Medium> medium = new Medium;
    medium->setScattering(Vec3(5.1f, 6.4f, 7.5f));
    medium->setAbsorption(Vec3(0.0022f, 0.0048f, 0.028f));
    return medium;
}

osg::ref_ptr<Medium> golden()
{
    osg::ref_ptr<Medium> medium = new Medium;
    medium->setAttenuation(Vec3(0.93f, 0.55f, 0.1f), 4.0f);
    return medium;
}

osg::ref_ptr<Medium> wax()
{
    osg::ref_ptr<Medium> medium = new Medium;
    medium->setScattering(Vec3(6.0f, 5.5f, 5.0f));
    medium->setAbsorption(Vec3(0.02f, 0.09f, 0.4f));
    return medium;
}

/// Adds a glass, closed all around, and a drink that reaches into its wall.
void addGlass(osg::Group& scene, const std::string& name, const Vec3d& base, Medium* drink)
{
    const double half = 0.5 * kWall;
    std::vector<ProfilePoint> outside{{0.0, 0.0, 0.0, -1.0}, {kOuter - 0.4, 0.0, 0.0, -1.0}};
    addArc(outside, kOuter - 0.4, 0.4, 0.4, -90.0, 0.0, 6);
    addArc(outside, kInner + half, kHeight - half, half, 0.0, 180.0, kRimSteps);
    addArc(outside, kInner - 0.6, kBase + 0.6, -0.6, 0.0, -90.0, 8);
    outside.push_back({0.0, kBase, 0.0, 1.0});
    const osg::ref_ptr<Medium> wall = new Medium;
    wall->setPriority(1);
    scene.addChild(
        turned(name + " glass", outside, base, kColumns, filled(1.5f, wall.get()).get()));
    const double radius = kInner + half, bottom = kBase - 0.4;
    const std::vector<ProfilePoint> body{{0.0, bottom, 0.0, -1.0},   {radius, bottom, 0.0, -1.0},
                                         {radius, bottom, 1.0, 0.0}, {radius, kLevel, 1.0, 0.0},
                                         {radius, kLevel, 0.0, 1.0}, {0.0, kLevel, 0.0, 1.0}};
    scene.addChild(turned(name, body, base, kColumns, filled(1.34f, drink).get()));
}

/// Adds a round of wax with rounded edges.
void addWax(osg::Group& scene, const Vec3d& base)
{
    const double radius = 3.2, height = 4.4, edge = 0.7;
    std::vector<ProfilePoint> body{{0.0, 0.0, 0.0, -1.0}};
    addArc(body, radius - edge, edge, edge, -90.0, 0.0, 8);
    addArc(body, radius - edge, height - edge, edge, 0.0, 90.0, 8);
    body.push_back({0.0, height, 0.0, 1.0});
    scene.addChild(turned("wax", body, base, kColumns, filled(1.45f, wax().get()).get()));
}

} // namespace

osg::ref_ptr<osg::Group> drinks()
{
    osg::ref_ptr<osg::MatrixTransform> scene =
        newScene("drinks", {Vec3d(0, -50, 19), Vec3d(0, 0, 4.6), Vec3d(0, 0, 1), 27.0},
                 {Vec3d(0, -60, 14), Vec3d(0, 0, 8), Vec3d(0, 0, 1), 30.0});
    const float w = 60.0f;
    scene->addChild(surface("table",
                            {{Vec3(-w, -w, 0), Vec3(w, -w, 0), Vec3(w, w, 0), Vec3(-w, w, 0)}},
                            lambert(Vec3(0.42f, 0.3f, 0.2f)).get()));
    scene->addChild(surface("wall",
                            {{Vec3(-w, 26, 0), Vec3(w, 26, 0), Vec3(w, 26, w), Vec3(-w, 26, w)}},
                            lambert(Vec3(0.3f, 0.36f, 0.42f)).get()));
    addGlass(*scene, "milk", Vec3d(-8.6, 0.5, 0.01), milk().get());
    addGlass(*scene, "golden drink", Vec3d(0.4, 2.0, 0.01), golden().get());
    addWax(*scene, Vec3d(8.8, -0.5, 0.01));
    // A large lamp: light that comes through two surfaces of glass is found by chance.
    osg::ref_ptr<AreaLight> lamp =
        new AreaLight(Vec3(-58, -40, 52), Vec3(0, 66, 0), Vec3(76, 0, 14), Vec3(2.4f, 2.3f, 2.1f));
    lamp->setName("lamp");
    scene->addChild(lamp.get());
    return scene;
}

} // namespace osgRayTrace::data
