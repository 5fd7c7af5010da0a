// CornellBox.cpp - the Cornell box from its published measurements. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "CornellBoxTable.h"
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/MediumVolume>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;

Quad quadOf(const cornell::Corners& corners)
{
    Quad quad;
    for (std::size_t i = 0; i < 4; ++i)
        quad[i] = corners[i].as<Vec3>();
    return quad;
}

/// Returns the top and the four sides of a block; the published list of sides begins at another
/// edge for each block.
std::vector<Quad> blockOf(const cornell::Corners& base, float height,
                          const std::array<std::array<std::size_t, 2>, 4>& edges)
{
    const Vec3 up(0.0f, height, 0.0f);
    Quad top = quadOf(base);
    for (Vec3& corner : top)
        corner += up;
    std::vector<Quad> quads{top};
    for (const auto& [from, to] : edges)
        quads.push_back({top[from] - up, top[from], top[to], top[to] - up});
    return quads;
}

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
    const osg::ref_ptr<PhysicalMaterial> white = lambert(cornell::kWhite.as<Vec3>());
    const bool mirrorFloor = variant == CornellVariant::MirrorFloor;
    const bool mirrorBlock = mirrorFloor || variant == CornellVariant::TallMirror;
    const bool blocks = variant != CornellVariant::GlassSphere;

    const Quad light = quadOf(cornell::kLight);
    const std::vector<Quad> shortBlock =
        blockOf(cornell::kShortBase, cornell::kShortHeight, {{{3, 2}, {0, 3}, {1, 0}, {2, 1}}});
    const std::vector<Quad> tallBlock =
        blockOf(cornell::kTallBase, cornell::kTallHeight, {{{0, 3}, {3, 2}, {2, 1}, {1, 0}}});

    const osg::Vec3d up(0, 1, 0);
    osg::ref_ptr<osg::MatrixTransform> scene =
        newScene("Cornell box", {osg::Vec3d(278, 278, -800), osg::Vec3d(278, 278, 0), up, 39.3},
                 {osg::Vec3d(278, 275, -720), osg::Vec3d(278, 275, 280), up, 42.0});
    scene->addChild(
        surface("floor", {quadOf(cornell::kFloor)}, mirrorFloor ? mirror().get() : white.get()));
    scene->addChild(surface("ceiling", frame(quadOf(cornell::kCeiling), light), white.get()));
    scene->addChild(surface("back wall", {quadOf(cornell::kBackWall)}, white.get()));
    scene->addChild(surface("right wall", {quadOf(cornell::kRightWall)},
                            lambert(cornell::kGreen.as<Vec3>()).get()));
    scene->addChild(surface("left wall", {quadOf(cornell::kLeftWall)},
                            lambert(cornell::kRed.as<Vec3>()).get()));
    if (blocks) scene->addChild(surface("short block", shortBlock, white.get()));
    if (blocks)
        scene->addChild(
            surface("tall block", tallBlock, mirrorBlock ? mirror().get() : white.get()));
    if (!blocks)
        scene->addChild(sphere("glass sphere", Vec3(278, 121, 279.6f), 120.0f, glass(1.5f).get()));

    // The light's front, which faces cross(edgeU, edgeV), looks down.
    osg::ref_ptr<AreaLight> areaLight = new AreaLight(
        light[0], light[1] - light[0], light[3] - light[0], cornell::kRadiance.as<Vec3>());
    areaLight->setName("light");
    scene->addChild(areaLight.get());
    if (variant == CornellVariant::Fog)
    {
        const osg::ref_ptr<Medium> fog = new Medium;
        const float density = 0.69314718f / 560.0f; // [1/mm]
        fog->setScattering(Vec3(1.0f, 1.0f, 1.0f) * (0.95f * density));
        fog->setAbsorption(Vec3(1.0f, 1.0f, 1.0f) * (0.05f * density));
        fog->setAnisotropy(0.3f);
        const osg::ref_ptr<MediumVolume> volume = new MediumVolume(fog.get());
        volume->setName("fog");
        scene->addChild(volume.get());
    }
    return scene;
}

} // namespace osgRayTrace::data
