// Pool.cpp - the caustics of waves on the floor of a pool. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Surfaces.h"
#include "Transport.h"

#include <osgRayTrace/AreaLight>

#include <osg/Geometry>

#include <cmath>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kCells = 48;
constexpr double kHalf = 2.0, kDepth = 1.0; ///< half the pool's side and its depth [m]

/// A wave sin(x * along.x + y * along.y + phase).
struct Wave
{
    double x, y, phase, share;
};
constexpr Wave kWaves[] = {{4.1, 1.3, 0.3, 0.34},
                           {-2.2, 5.3, 1.9, 0.26},
                           {7.4, -3.1, 4.0, 0.18},
                           {5.2, 8.9, 2.6, 0.13},
                           {-11.3, 4.7, 5.1, 0.09}};

osg::ref_ptr<osg::Geode> waterSurface(double waves)
{
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i)
        {
            const double x = kHalf * (2.0 * i / kCells - 1.0), y = kHalf * (2.0 * j / kCells - 1.0);
            double z = 0.0, slopeX = 0.0, slopeY = 0.0;
            for (const Wave& wave : kWaves)
            {
                const double at = wave.x * x + wave.y * y + wave.phase, size = waves * wave.share;
                z += size * std::sin(at);
                slopeX += size * wave.x * std::cos(at);
                slopeY += size * wave.y * std::cos(at);
            }
            Vec3d normal(-slopeX, -slopeY, 1.0);
            normal.normalize();
            positions->push_back(Vec3d(x, y, z));
            normals->push_back(normal);
            if (i == kCells || j == kCells) continue;
            const int a = j * (kCells + 1) + i, b = a + kCells + 1;
            for (const int index : {a, a + 1, b + 1, a, b + 1, b})
                triangles->push_back(static_cast<GLushort>(index));
        }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(positions.get());
    geometry->setNormalArray(normals.get(), osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(triangles.get());
    osg::ref_ptr<osg::Geode> node = new osg::Geode;
    node->setName("water");
    const osg::ref_ptr<PhysicalMaterial> water = glass(1.33f);
    node->getOrCreateStateSet()->setAttribute(water.get());
    node->getStateSet()->setAttributeAndModes(rasterMaterial(*water, Vec3(0, 0, 1)).get());
    node->addDrawable(geometry.get());
    return node;
}

} // namespace

osg::ref_ptr<osg::Group> pool(double waves)
{
    const SceneView view{Vec3d(0.2, -2.6, 2.4), Vec3d(0.0, 0.1, -0.8), Vec3d(0, 0, 1), 48.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("pool", view, view);
    const float h = static_cast<float>(kHalf), d = static_cast<float>(-kDepth), top = 0.15f;
    scene->addChild(surface("floor",
                            {{Vec3(-h, -h, d), Vec3(h, -h, d), Vec3(h, h, d), Vec3(-h, h, d)}},
                            lambert(Vec3(0.6f, 0.7f, 0.75f)).get()));
    scene->addChild(
        surface("walls",
                {{Vec3(-h, -h, d), Vec3(-h, h, d), Vec3(-h, h, top), Vec3(-h, -h, top)},
                 {Vec3(h, h, d), Vec3(h, -h, d), Vec3(h, -h, top), Vec3(h, h, top)},
                 {Vec3(-h, h, d), Vec3(h, h, d), Vec3(h, h, top), Vec3(-h, h, top)},
                 {Vec3(h, -h, d), Vec3(-h, -h, d), Vec3(-h, -h, top), Vec3(h, -h, top)}},
                lambert(Vec3(0.5f, 0.65f, 0.75f)).get()));
    scene->addChild(waterSurface(waves));
    // A square of the area of the sun's disc, 0.53 degrees across at this distance.
    const double distance = 30.0,
                 side = std::sqrt(osg::PI) * distance * std::tan(osg::DegreesToRadians(0.5 * 0.53));
    const Vec3d towards(0.28, 0.34, 0.9), sun = towards * (distance / towards.length());
    const auto s = static_cast<float>(side);
    scene->addChild(new AreaLight(Vec3(sun), Vec3(0, s, 0), Vec3(s, 0, 0),
                                  Vec3(1.0f, 0.95f, 0.85f) * 40000.0f));
    scene->addChild(new AreaLight(Vec3(-2.5f, 1.0f, 2.0f), Vec3(0, 0.4f, 0), Vec3(0.4f, 0, 0),
                                  Vec3(20, 16, 10)));
    return scene;
}

} // namespace osgRayTrace::data
