// Furnace.cpp - a room whose radiance is known everywhere. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osg/CullFace>

namespace osgRayTrace::data
{

osg::ref_ptr<osg::Group> furnace()
{
    // The radiance is emission / (1 - albedo) = 1.
    const osg::Vec3 half(0.5f, 0.5f, 0.5f);
    const osg::ref_ptr<PhysicalMaterial> wall = lambert(half);
    wall->setEmission(half);

    const osg::Vec3d center, up(0, 0, 1);
    osg::ref_ptr<osg::MatrixTransform> scene =
        newScene("furnace", {osg::Vec3d(0, -0.8, 0), center, up, 60.0},
                 {osg::Vec3d(0, -4, 0), center, up, 40.0});
    const osg::ref_ptr<osg::Geode> room =
        surface("room", boxQuads(osg::Vec3(-1, -1, -1), osg::Vec3(1, 1, 1)), wall.get());
    // Faces are culled so that whoever stands outside sees through the outer sides.
    room->getOrCreateStateSet()->setAttributeAndModes(new osg::CullFace(osg::CullFace::FRONT));
    scene->addChild(room);
    return scene;
}

} // namespace osgRayTrace::data
