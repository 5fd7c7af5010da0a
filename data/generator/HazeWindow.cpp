// HazeWindow.cpp - a window of coloured panes in haze. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/MediumVolume>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr float kLow = -0.75f, kHigh = 0.75f, kSill = 1.1f, kTop = 3.1f; ///< of the window [m]
constexpr float kLead = 0.03f;                                           ///< half the width of bars

Quad inWall(float y0, float z0, float y1, float z1)
{
    return {Vec3(-3, y0, z0), Vec3(-3, y1, z0), Vec3(-3, y1, z1), Vec3(-3, y0, z1)};
}

osg::ref_ptr<PhysicalMaterial> pane(const Vec3& color)
{
    osg::ref_ptr<PhysicalMaterial> material = glass(1.5f);
    material->setBaseColor(color);
    material->setThinWalled(true);
    return material;
}

/// Adds three columns and two rows of panes with bars between them.
void addWindow(osg::Group& scene)
{
    const Vec3 colors[] = {Vec3(0.95f, 0.12f, 0.06f), Vec3(0.95f, 0.7f, 0.1f),
                           Vec3(0.1f, 0.25f, 0.95f),  Vec3(0.12f, 0.75f, 0.25f),
                           Vec3(0.9f, 0.9f, 0.85f),   Vec3(0.7f, 0.15f, 0.75f)};
    const float width = (kHigh - kLow) / 3.0f, height = (kTop - kSill) / 2.0f;
    std::vector<Quad> bars;
    for (int k = 0; k < 6; ++k)
    {
        const float y = kLow + width * static_cast<float>(k % 3);
        const float z = kSill + height * static_cast<float>(k / 3);
        scene.addChild(
            surface("pane", {inWall(y + kLead, z + kLead, y + width - kLead, z + height - kLead)},
                    pane(colors[k]).get()));
        bars.push_back(inWall(y, z, y + width, z + kLead));
        bars.push_back(inWall(y, z + height - kLead, y + width, z + height));
        bars.push_back(inWall(y, z + kLead, y + kLead, z + height - kLead));
        bars.push_back(inWall(y + width - kLead, z + kLead, y + width, z + height - kLead));
    }
    scene.addChild(surface("bars", bars, lambert(Vec3(0.05f, 0.05f, 0.05f)).get()));
}

} // namespace

osg::ref_ptr<osg::Group> hazeWindow()
{
    const SceneView view{Vec3d(2.6, -3.7, 1.7), Vec3d(-1.2, 0.6, 1.45), Vec3d(0, 0, 1), 52.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("window in haze", view, view);
    scene->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);
    const osg::ref_ptr<PhysicalMaterial> stone = lambert(Vec3(0.24f, 0.23f, 0.22f));
    scene->addChild(surface("walls",
                            {{Vec3(-3, -4, 0), Vec3(3, -4, 0), Vec3(3, 3, 0), Vec3(-3, 3, 0)},
                             {Vec3(-3, -4, 4), Vec3(-3, 3, 4), Vec3(3, 3, 4), Vec3(3, -4, 4)},
                             {Vec3(-3, 3, 0), Vec3(3, 3, 0), Vec3(3, 3, 4), Vec3(-3, 3, 4)},
                             {Vec3(3, 3, 0), Vec3(3, -4, 0), Vec3(3, -4, 4), Vec3(3, 3, 4)},
                             {Vec3(3, -4, 0), Vec3(-3, -4, 0), Vec3(-3, -4, 4), Vec3(3, -4, 4)},
                             inWall(-4, 0, 3, kSill),
                             inWall(-4, kTop, 3, 4),
                             inWall(-4, kSill, kLow, kTop),
                             inWall(kHigh, kSill, 3, kTop)},
                            stone.get()));
    addWindow(*scene);
    scene->addChild(sun({-0.8f, -0.25f, 0.52f}, {26.0f, 24.0f, 20.0f}).get());
    const osg::ref_ptr<Medium> haze = new Medium;
    haze->setScattering(Vec3(0.09f, 0.09f, 0.095f));
    haze->setAbsorption(Vec3(0.004f, 0.004f, 0.004f));
    haze->setAnisotropy(0.5f);
    const osg::ref_ptr<MediumVolume> volume = new MediumVolume(haze.get());
    volume->setName("haze");
    scene->addChild(volume.get());
    return scene;
}

} // namespace osgRayTrace::data
