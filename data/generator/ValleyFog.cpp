// ValleyFog.cpp - fog that lies in a valley in the light of a low sun. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/MediumVolume>

#include <osg/Geometry>

#include <cmath>
#include <vector>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kCells = 60;       ///< of the land, along each side
constexpr double kHalf = 1100.0; ///< half the land's side [m]

double bell(double x, double width)
{
    return std::exp(-x * x / (2.0 * width * width));
}

/// Returns the height of the land [m]: a valley along y between two ranges, with a ridge that comes
/// down into it from either side.
double heightAt(double x, double y)
{
    const double bend = 90.0 * std::sin(y / 260.0);
    const double away = x - bend;
    double z = 190.0 * (1.0 - bell(away, 210.0));
    z += 55.0 * bell(away - 330.0, 130.0) * (0.6 + 0.4 * std::sin(y / 120.0 + 1.0));
    z += 70.0 * bell(away + 360.0, 150.0) * (0.6 + 0.4 * std::sin(y / 150.0));
    z += 75.0 * bell(y - 190.0, 70.0) * bell(away - 150.0, 110.0);
    z += 60.0 * bell(y + 60.0, 60.0) * bell(away + 170.0, 100.0);
    z += 6.0 * std::sin(x / 31.0 + 0.7 * std::sin(y / 47.0)) * std::sin(y / 37.0);
    return z;
}

osg::ref_ptr<osg::Geode> land()
{
    const osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    // Coordinates of files have no more digits than the text keeps.
    const auto rounded = [](double v) { return static_cast<float>(std::round(v * 100.0) / 100.0); };
    for (int j = 0; j <= kCells; ++j)
    {
        for (int i = 0; i <= kCells; ++i)
        {
            const double x = kHalf * (2.0 * i / kCells - 1.0), y = kHalf * (2.0 * j / kCells - 1.0);
            positions->push_back(Vec3(rounded(x), rounded(y), rounded(heightAt(x, y))));
            const double step = 2.0;
            Vec3d n(heightAt(x - step, y) - heightAt(x + step, y),
                    heightAt(x, y - step) - heightAt(x, y + step), 2.0 * step);
            n.normalize();
            normals->push_back(Vec3(rounded(n.x()), rounded(n.y()), rounded(n.z())));
        }
    }
    const osg::ref_ptr<osg::DrawElementsUShort> triangles =
        new osg::DrawElementsUShort(GL_TRIANGLES);
    for (int j = 0; j < kCells; ++j)
    {
        for (int i = 0; i < kCells; ++i)
        {
            const int a = j * (kCells + 1) + i, b = a + kCells + 1;
            for (const int index : {a, a + 1, b, a + 1, b + 1, b})
                triangles->push_back(static_cast<GLushort>(index));
        }
    }
    const osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(positions.get());
    geometry->setNormalArray(normals.get(), osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(triangles.get());
    const osg::ref_ptr<PhysicalMaterial> grass = lambert(Vec3(0.1f, 0.13f, 0.05f));
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->setName("land");
    geode->addDrawable(geometry.get());
    geode->getOrCreateStateSet()->setAttribute(grass.get());
    geode->getStateSet()->setAttributeAndModes(rasterMaterial(*grass, Vec3(0, 0, 1)).get());
    return geode;
}

/// Adds a church in the valley, of which the tower reaches out of the fog.
void addChurch(osg::Group& scene)
{
    const osg::ref_ptr<PhysicalMaterial> stone = lambert(Vec3(0.55f, 0.5f, 0.43f));
    const osg::ref_ptr<PhysicalMaterial> tiles = lambert(Vec3(0.35f, 0.1f, 0.06f));
    const Vec3 at(-60.0f, -250.0f, 6.0f);
    scene.addChild(surface("nave", boxQuads(at, at + Vec3(16, 40, 22)), stone.get()));
    scene.addChild(
        surface("tower", boxQuads(at + Vec3(2, -14, 0), at + Vec3(14, -2, 62)), stone.get()));
    constexpr double kRadius = 9.5, kHeight = 34.0;
    const double slant = std::hypot(kRadius, kHeight);
    const std::vector<ProfilePoint> cone{{kRadius, 0.0, kHeight / slant, kRadius / slant},
                                         {0.0, kHeight, kHeight / slant, kRadius / slant}};
    scene.addChild(turned("spire", cone, Vec3d(at + Vec3(8, -8, 62)), 24, tiles.get()));
}

} // namespace

osg::ref_ptr<osg::Group> valleyFog()
{
    const SceneView view{Vec3d(-40, -700, 400), Vec3d(0, -40, 30), Vec3d(0, 0, 1), 38.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("fog in a valley", view, view);
    scene->getOrCreateStateSet()->setMode(GL_LIGHT1, osg::StateAttribute::ON);
    scene->addChild(land().get());
    addChurch(*scene);
    scene->addChild(sun({0.62f, 0.6f, 0.36f}, {2.6f, 2.0f, 1.35f}).get());
    const osg::ref_ptr<AreaLight> sky = new AreaLight(Vec3(-1500, -1500, 1200), Vec3(0, 3000, 0),
                                                      Vec3(3000, 0, 0), Vec3(0.12f, 0.17f, 0.27f));
    sky->setName("sky");
    scene->addChild(sky.get());
    // The mean way between collisions is 40 m up to a height of 30 m, and e times as long 14 m
    // higher.
    const osg::ref_ptr<Medium> droplets = new Medium;
    droplets->setScattering(Vec3(0.025f, 0.025f, 0.025f));
    droplets->setAnisotropy(0.6f);
    const osg::ref_ptr<MediumVolume> fog = new MediumVolume(droplets.get());
    fog->setName("fog");
    fog->setShape(MediumVolume::LAYER);
    fog->setScaleHeight(14.0f);
    const osg::ref_ptr<osg::MatrixTransform> base =
        new osg::MatrixTransform(osg::Matrix::translate(0, 0, 30));
    base->addChild(fog.get());
    scene->addChild(base.get());
    return scene;
}

} // namespace osgRayTrace::data
