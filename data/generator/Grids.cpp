// Grids.cpp - lattices under an area light, for soft shadows. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/AreaLight>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;

constexpr int kCells = 6;
constexpr float kBarWidth = 0.12f;
constexpr float kGridSize = 3.0f;

/// Returns a square lattice of bars in the plane z = 0, centred on the origin.
std::vector<Quad> lattice()
{
    const float half = 0.5f * kGridSize;
    const float thick = 0.5f * kBarWidth;
    std::vector<Quad> quads;
    for (int i = 0; i <= kCells; ++i)
    {
        const float at = -half + kGridSize * float(i) / kCells;
        // Bars along y lie on those along x, so that no two faces coincide.
        const Vec3 alongX(half, thick, thick);
        const Vec3 alongY(thick, half, thick);
        for (const Quad& side : boxQuads(Vec3(0, at, 0) - alongX, Vec3(0, at, 0) + alongX))
        {
            quads.push_back(side);
        }
        for (const Quad& side :
             boxQuads(Vec3(at, 0, kBarWidth) - alongY, Vec3(at, 0, kBarWidth) + alongY))
        {
            quads.push_back(side);
        }
    }
    return quads;
}

osg::ref_ptr<osg::MatrixTransform> placed(const std::string& name, const osg::Matrixd& matrix,
                                          osg::Node* node)
{
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
    transform->setName(name);
    transform->addChild(node);
    return transform;
}

} // namespace

osg::ref_ptr<osg::Group> grids()
{
    const SceneView view{osg::Vec3d(0, -11, 7), osg::Vec3d(0, 0.3, 0.6), osg::Vec3d(0, 0, 1), 36.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("grids", view, view);
    const Quad floor{Vec3(-12, -12, 0), Vec3(12, -12, 0), Vec3(12, 12, 0), Vec3(-12, 12, 0)};
    scene->addChild(surface("floor", {floor}, lambert(Vec3(0.7f, 0.7f, 0.7f)).get()));

    // One grid is used three times: lying near the floor, lying high above it, standing.
    const osg::ref_ptr<osg::Geode> grid =
        surface("grid", lattice(), lambert(Vec3(0.6f, 0.35f, 0.2f)).get());
    scene->addChild(placed("low grid", osg::Matrixd::translate(-3.6, 0.0, 0.5), grid.get()));
    scene->addChild(placed("high grid", osg::Matrixd::translate(0.0, 0.0, 1.6), grid.get()));
    scene->addChild(placed("standing grid",
                           osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0)) *
                               osg::Matrixd::translate(3.8, 0.9, 1.56),
                           grid.get()));

    osg::ref_ptr<AreaLight> light =
        new AreaLight(Vec3(-1, -1, 0), Vec3(0, 2, 0), Vec3(2, 0, 0), Vec3(30, 29, 27));
    light->setName("light");
    const osg::ref_ptr<osg::MatrixTransform> carrier =
        placed("light position", osg::Matrixd::translate(0.0, -2.0, 6.0), light.get());
    carrier->setDataVariance(osg::Object::DYNAMIC);
    scene->addChild(carrier.get());
    return scene;
}

} // namespace osgRayTrace::data
