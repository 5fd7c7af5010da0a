// Furnace.cpp - a room whose radiance is known everywhere. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

namespace osgRayTrace::data
{

osg::ref_ptr<osg::Group> furnace()
{
    // Radiance = emission / (1 - albedo) = 1.
    const osg::Vec3 half(0.5f, 0.5f, 0.5f);
    const osg::ref_ptr<PhysicalMaterial> wall = lambert(half);
    wall->setEmission(half);

    osg::ref_ptr<osg::Group> scene = newScene("furnace");
    scene->addChild(
        storedView(osg::Vec3d(0, -0.8, 0), osg::Vec3d(0, 0, 0), osg::Vec3d(0, 0, 1), 60.0));
    scene->addChild(
        surface("room", boxQuads(osg::Vec3(-1, -1, -1), osg::Vec3(1, 1, 1)), wall.get()));
    return scene;
}

} // namespace osgRayTrace::data
