// Necklace.cpp - a chain of brushed metal on dark cloth. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Surfaces.h"
#include "Transport.h"

#include <osgRayTrace/AreaLight>

#include <cmath>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kRings = 40, kColumns = 32, kSteps = 16;
constexpr double kRing = 1.0, kWire = 0.22; ///< radii of a ring and of its wire [cm]

} // namespace

osg::ref_ptr<osg::Group> necklace(double roughness)
{
    const SceneView view{Vec3d(0, -22, 24), Vec3d(0, 0.5, 0.5), Vec3d(0, 0, 1), 42.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("necklace", view, view);
    scene->addChild(
        surface("cloth", {{Vec3(-30, -30, 0), Vec3(30, -30, 0), Vec3(30, 30, 0), Vec3(-30, 30, 0)}},
                lambert(Vec3(0.04f, 0.035f, 0.05f)).get()));
    const osg::ref_ptr<PhysicalMaterial> gold = metal(Vec3(1.0f, 0.78f, 0.34f));
    gold->setRoughness(static_cast<float>(roughness));
    std::vector<ProfilePoint> wire;
    addArc(wire, kRing, 0.0, kWire, -180.0, 180.0, kSteps);
    const osg::ref_ptr<osg::Geode> ring = turned("ring", wire, Vec3d(), kColumns, gold.get());
    for (int i = 0; i < kRings; ++i)
    {
        // The chain lies in an oval; every other ring stands on its edge.
        const double angle = 2.0 * osg::PI * i / kRings;
        const Vec3d place(10.6 * std::cos(angle), 8.6 * std::sin(angle), kRing + kWire);
        const double along = std::atan2(8.6 * std::cos(angle), -10.6 * std::sin(angle));
        const double lean = i % 2 ? osg::DegreesToRadians(84.0) : osg::DegreesToRadians(24.0);
        osg::ref_ptr<osg::MatrixTransform> link = new osg::MatrixTransform(
            osg::Matrixd::rotate(lean, osg::Vec3d(1, 0, 0)) *
            osg::Matrixd::rotate(along, osg::Vec3d(0, 0, 1)) * osg::Matrixd::translate(place));
        link->addChild(ring.get());
        scene->addChild(link.get());
    }
    scene->addChild(
        new AreaLight(Vec3(-14, -4, 16), Vec3(0, 8, 0), Vec3(6, 0, 2), Vec3(14, 13, 12)));
    scene->addChild(
        new AreaLight(Vec3(10, 6, 18), Vec3(0, 3, 0), Vec3(3, 0, -1), Vec3(30, 34, 40)));
    return scene;
}

} // namespace osgRayTrace::data
