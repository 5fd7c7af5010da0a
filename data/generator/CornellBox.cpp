// CornellBox.cpp - the Cornell box from its published measurements. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/AreaLight>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;

// Positions are those measured in [CornellBox]: x to the left in the picture, y up, z away from the
// camera [mm].
const Quad kFloor{Vec3(552.8f, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 559.2f), Vec3(549.6f, 0, 559.2f)};
const Quad kCeiling{Vec3(556, 548.8f, 0), Vec3(556, 548.8f, 559.2f), Vec3(0, 548.8f, 559.2f),
                    Vec3(0, 548.8f, 0)};
const Quad kLight{Vec3(343, 548.8f, 227), Vec3(343, 548.8f, 332), Vec3(213, 548.8f, 332),
                  Vec3(213, 548.8f, 227)};
const Quad kBackWall{Vec3(549.6f, 0, 559.2f), Vec3(0, 0, 559.2f), Vec3(0, 548.8f, 559.2f),
                     Vec3(556, 548.8f, 559.2f)};
const Quad kRightWall{Vec3(0, 0, 559.2f), Vec3(0, 0, 0), Vec3(0, 548.8f, 0),
                      Vec3(0, 548.8f, 559.2f)};
const Quad kLeftWall{Vec3(552.8f, 0, 0), Vec3(549.6f, 0, 559.2f), Vec3(556, 548.8f, 559.2f),
                     Vec3(556, 548.8f, 0)};

const std::vector<Quad> kShortBlock{
    {Vec3(130, 165, 65), Vec3(82, 165, 225), Vec3(240, 165, 272), Vec3(290, 165, 114)},
    {Vec3(290, 0, 114), Vec3(290, 165, 114), Vec3(240, 165, 272), Vec3(240, 0, 272)},
    {Vec3(130, 0, 65), Vec3(130, 165, 65), Vec3(290, 165, 114), Vec3(290, 0, 114)},
    {Vec3(82, 0, 225), Vec3(82, 165, 225), Vec3(130, 165, 65), Vec3(130, 0, 65)},
    {Vec3(240, 0, 272), Vec3(240, 165, 272), Vec3(82, 165, 225), Vec3(82, 0, 225)},
};
const std::vector<Quad> kTallBlock{
    {Vec3(423, 330, 247), Vec3(265, 330, 296), Vec3(314, 330, 456), Vec3(472, 330, 406)},
    {Vec3(423, 0, 247), Vec3(423, 330, 247), Vec3(472, 330, 406), Vec3(472, 0, 406)},
    {Vec3(472, 0, 406), Vec3(472, 330, 406), Vec3(314, 330, 456), Vec3(314, 0, 456)},
    {Vec3(314, 0, 456), Vec3(314, 330, 456), Vec3(265, 330, 296), Vec3(265, 0, 296)},
    {Vec3(265, 0, 296), Vec3(265, 330, 296), Vec3(423, 330, 247), Vec3(423, 0, 247)},
};

// These linear RGB colours stand for the measured spectra, as in other renderers.
const Vec3 kWhite(0.73f, 0.73f, 0.73f);
const Vec3 kRed(0.65f, 0.05f, 0.05f);
const Vec3 kGreen(0.12f, 0.45f, 0.15f);
const Vec3 kRadiance(17.0f, 12.0f, 4.0f);

/// Returns the frame between an outer quad and an inner one: the ceiling around the light, which
/// lies in the ceiling's plane.
std::vector<Quad> frame(const Quad& outer, const Quad& inner)
{
    std::vector<Quad> quads;
    for (size_t i = 0; i < 4; ++i)
    {
        const size_t next = (i + 1) % 4;
        quads.push_back({outer[i], outer[next], inner[next], inner[i]});
    }
    return quads;
}

} // namespace

osg::ref_ptr<osg::Group> cornellBox(CornellVariant variant)
{
    const osg::ref_ptr<PhysicalMaterial> white = lambert(kWhite);
    const bool mirrorFloor = variant == CornellVariant::MirrorFloor;
    const bool mirrorBlock = mirrorFloor || variant == CornellVariant::TallMirror;
    const bool blocks = variant != CornellVariant::GlassSphere;

    const osg::Vec3d up(0, 1, 0);
    osg::ref_ptr<osg::MatrixTransform> scene =
        newScene("Cornell box", {osg::Vec3d(278, 278, -800), osg::Vec3d(278, 278, 0), up, 39.3},
                 {osg::Vec3d(278, 275, -720), osg::Vec3d(278, 275, 280), up, 42.0});
    scene->addChild(surface("floor", {kFloor}, mirrorFloor ? mirror().get() : white.get()));
    scene->addChild(surface("ceiling", frame(kCeiling, kLight), white.get()));
    scene->addChild(surface("back wall", {kBackWall}, white.get()));
    scene->addChild(surface("right wall", {kRightWall}, lambert(kGreen).get()));
    scene->addChild(surface("left wall", {kLeftWall}, lambert(kRed).get()));
    if (blocks) scene->addChild(surface("short block", kShortBlock, white.get()));
    if (blocks)
        scene->addChild(
            surface("tall block", kTallBlock, mirrorBlock ? mirror().get() : white.get()));
    if (!blocks)
        scene->addChild(sphere("glass sphere", Vec3(278, 121, 279.6f), 120.0f, glass(1.5f).get()));

    // The light's front, which faces cross(edgeU, edgeV), looks down.
    osg::ref_ptr<AreaLight> light =
        new AreaLight(kLight[0], kLight[1] - kLight[0], kLight[3] - kLight[0], kRadiance);
    light->setName("light");
    scene->addChild(light.get());
    return scene;
}

} // namespace osgRayTrace::data
