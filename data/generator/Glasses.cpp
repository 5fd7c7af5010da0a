// Glasses.cpp - a glass sphere and a glass of water in a box. Part of the scene generator.
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

constexpr float kGlass = 1.5f, kWater = 1.33f; ///< indices of refraction

constexpr int kColumns = 144, kRimSteps = 8;
constexpr double kOuter = 6.0, kWall = 0.4, kInner = kOuter - kWall; ///< radii of the glass [cm]
constexpr double kHeight = 17.0, kBase = 1.4,
                 kLevel = 11.5; ///< height of the glass, its base and the water's surface [cm]

/// Adds each of three surfaces once: glass to air, glass to water, and water to air. The normals
/// point out of the denser side, to which the index belongs.
void addGlassOfWater(osg::Group& scene, const Vec3d& base)
{
    const double half = 0.5 * kWall;
    std::vector<ProfilePoint> outside{{0.0, 0.0, 0.0, -1.0}, {kOuter - 0.5, 0.0, 0.0, -1.0}};
    addArc(outside, kOuter - 0.5, 0.5, 0.5, -90.0, 0.0, 6);
    addArc(outside, kInner + half, kHeight - half, half, 0.0, 180.0, kRimSteps);
    outside.push_back({kInner, kLevel, -1.0, 0.0});
    std::vector<ProfilePoint> wet{{kInner, kLevel, -1.0, 0.0}};
    addArc(wet, kInner - 1.0, kBase + 1.0, -1.0, 0.0, -90.0, 8);
    wet.push_back({0.0, kBase, 0.0, 1.0});
    const std::vector<ProfilePoint> surface{{kInner, kLevel, 0.0, 1.0}, {0.0, kLevel, 0.0, 1.0}};
    scene.addChild(turned("glass", outside, base, kColumns, glass(kGlass).get()));
    scene.addChild(turned("wet glass", wet, base, kColumns, glass(kGlass / kWater).get()));
    scene.addChild(turned("water", surface, base, kColumns, glass(kWater).get()));
}

} // namespace

osg::ref_ptr<osg::Group> glasses()
{
    const float w = 30.0f, h = 45.0f; // half the width and the height [cm]
    const osg::ref_ptr<PhysicalMaterial> white = lambert(Vec3(0.75f, 0.75f, 0.73f));
    osg::ref_ptr<osg::MatrixTransform> scene =
        newScene("glasses", {Vec3d(0, -84, 36), Vec3d(1.5, 0, 9.5), Vec3d(0, 0, 1), 28.0},
                 {Vec3d(0, -100, 22), Vec3d(0, 0, 22), Vec3d(0, 0, 1), 37.0});
    scene->addChild(surface("box",
                            {{Vec3(-w, -w, 0), Vec3(w, -w, 0), Vec3(w, w, 0), Vec3(-w, w, 0)},
                             {Vec3(-w, -w, h), Vec3(-w, w, h), Vec3(w, w, h), Vec3(w, -w, h)},
                             {Vec3(-w, w, 0), Vec3(w, w, 0), Vec3(w, w, h), Vec3(-w, w, h)}},
                            white.get()));
    scene->addChild(surface("left wall",
                            {{Vec3(-w, -w, 0), Vec3(-w, w, 0), Vec3(-w, w, h), Vec3(-w, -w, h)}},
                            lambert(Vec3(0.65f, 0.2f, 0.08f)).get()));
    scene->addChild(surface("right wall",
                            {{Vec3(w, w, 0), Vec3(w, -w, 0), Vec3(w, -w, h), Vec3(w, w, h)}},
                            lambert(Vec3(0.1f, 0.3f, 0.55f)).get()));
    scene->addChild(sphere("glass sphere", Vec3(-11.5f, 3.0f, 8.05f), 8.0f, glass(kGlass).get()));
    addGlassOfWater(*scene, Vec3d(6.5, -4.0, 0.05));

    // The lamp is small, high on the left, towards the back: caustics fall to the front right.
    osg::ref_ptr<AreaLight> lamp =
        new AreaLight(Vec3(-27, 2, 32), Vec3(0, 3, 0), Vec3(2, 0, 2.2f), Vec3(420, 380, 320));
    lamp->setName("lamp");
    scene->addChild(lamp.get());
    return scene;
}

} // namespace osgRayTrace::data
