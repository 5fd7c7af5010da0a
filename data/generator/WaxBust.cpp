// WaxBust.cpp - a bust of wax with a lamp behind it. Part of the scene generator.
// SPDX-License-Identifier: MIT
#include "Scenes.h"
#include "Surfaces.h"

#include <osgRayTrace/AreaLight>

#include <osg/Geometry>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace osgRayTrace::data
{

namespace
{

using osg::Vec3;
using osg::Vec3d;

constexpr int kColumns = 72;

/// Holds an ellipse around an upright axis, a cut through the bust.
struct Cut
{
    double z, halfWidth, halfDepth, back; ///< back: how far its middle lies behind the axis [cm]
    int rows;                             ///< of vertices, up to the next cut
};

// clang-format off
constexpr Cut kCuts[] = {
    {2.0, 1.7, 1.5, 0.0, 3},     {2.9, 3.3, 2.0, 0.0, 4},     {4.3, 4.9, 2.5, 0.0, 4},
    {5.6, 5.2, 2.6, 0.2, 3},     {6.5, 4.2, 2.3, 0.3, 3},     {7.2, 2.6, 1.9, 0.3, 3},
    {8.0, 1.65, 1.65, 0.3, 3},   {8.9, 1.5, 1.65, 0.2, 4},    {9.6, 1.75, 2.1, -0.1, 8},
    {10.4, 2.1, 2.6, -0.1, 12},  {11.6, 2.45, 2.9, 0.0, 14},  {13.0, 2.75, 3.15, 0.15, 8},
    {14.3, 2.7, 3.1, 0.25, 4},   {15.5, 2.05, 2.35, 0.3, 3},  {16.2, 1.1, 1.25, 0.3, 3},
    {16.5, 0.0, 0.0, 0.3, 0},
};

/// Holds a feature, which moves what is around its middle. Extents are standard deviations.
struct Feature
{
    Vec3d middle, extent, move; ///< [cm]
    bool paired;                ///< true: there is another one, mirrored, at -x
};

const Feature kFeatures[] = {
    {{0.0, -3.0, 11.9}, {0.36, 2.0, 0.36}, {0.0, -1.0, 0.0}, false},     // tip of the nose
    {{0.0, -3.0, 12.7}, {0.3, 2.0, 0.55}, {0.0, -0.55, 0.0}, false},     // bridge of the nose
    {{1.1, -2.7, 12.85}, {0.5, 1.5, 0.36}, {0.0, 0.7, 0.0}, true},       // eye sockets
    {{1.1, -2.7, 12.8}, {0.33, 1.5, 0.24}, {0.0, -0.4, 0.0}, true},      // eyes
    {{0.9, -2.7, 13.5}, {0.75, 1.5, 0.24}, {0.0, -0.25, 0.0}, true},     // brows
    {{1.45, -2.3, 11.8}, {0.55, 1.5, 0.55}, {0.1, -0.25, 0.0}, true},    // cheeks
    {{0.0, -2.9, 11.0}, {0.6, 1.5, 0.16}, {0.0, -0.36, 0.0}, false},     // upper lip
    {{0.0, -2.9, 10.5}, {0.5, 1.5, 0.17}, {0.0, -0.38, 0.0}, false},     // lower lip
    {{0.0, -2.6, 9.75}, {0.65, 1.5, 0.34}, {0.0, -0.8, 0.0}, false},     // chin
    {{1.6, -1.0, 9.9}, {0.7, 1.0, 0.4}, {0.3, -0.3, 0.0}, true},         // jaw
    {{2.7, 0.3, 12.2}, {1.5, 0.36, 0.62}, {1.2, 0.2, 0.0}, true},        // ears
    {{0.0, 3.2, 14.0}, {1.0, 1.2, 0.9}, {0.0, 1.6, 0.3}, false},         // a knot of hair
};
// clang-format on

/// Returns a value between two others, with the slopes of their neighbours.
double smoothBetween(double before, double from, double to, double after, double t)
{
    const double a = 0.5 * (to - before), b = 0.5 * (after - from);
    return from + t * (a + t * (3.0 * (to - from) - 2.0 * a - b + t * (2.0 * (from - to) + a + b)));
}

/// Returns the cut at a place between two: their numbers are 0, 1 and so on.
Cut cutAt(double along)
{
    constexpr int kLast = static_cast<int>(std::size(kCuts)) - 1;
    const int i = std::clamp(static_cast<int>(along), 0, kLast - 1);
    const Cut &a = kCuts[std::max(i - 1, 0)], &b = kCuts[i], &c = kCuts[i + 1],
              &d = kCuts[std::min(i + 2, kLast)];
    const double t = along - i;
    return {smoothBetween(a.z, b.z, c.z, d.z, t),
            smoothBetween(a.halfWidth, b.halfWidth, c.halfWidth, d.halfWidth, t),
            smoothBetween(a.halfDepth, b.halfDepth, c.halfDepth, d.halfDepth, t),
            smoothBetween(a.back, b.back, c.back, d.back, t), 0};
}

double gaussian(double x, double extent)
{
    return std::exp(-0.5 * x * x / (extent * extent));
}

/// Returns a point of the bust. along: see cutAt; phi: angle from +x to +y.
Vec3d pointOf(double along, double phi)
{
    const Cut cut = cutAt(along);
    const Vec3d start(cut.halfWidth * std::cos(phi), cut.back + cut.halfDepth * std::sin(phi),
                      cut.z);
    Vec3d point = start;
    for (const Feature& f : kFeatures)
    {
        for (const double side : {1.0, -1.0})
        {
            if (side < 0.0 && !f.paired) continue;
            const Vec3d away(start.x() - side * f.middle.x(), start.y() - f.middle.y(),
                             start.z() - f.middle.z());
            const double share = gaussian(away.x(), f.extent.x()) *
                                 gaussian(away.y(), f.extent.y()) *
                                 gaussian(away.z(), f.extent.z());
            point += Vec3d(side * f.move.x(), f.move.y(), f.move.z()) * share;
        }
    }
    return point;
}

Vec3d normalOf(double along, double phi)
{
    constexpr double kStep = 1e-4;
    Vec3d normal = (pointOf(along, phi + kStep) - pointOf(along, phi - kStep)) ^
                   (pointOf(along + kStep, phi) - pointOf(along - kStep, phi));
    normal.normalize();
    return normal;
}

/// Returns the places of the rows of vertices, from the lower end to the top.
std::vector<double> rowsOfBust()
{
    std::vector<double> rows;
    for (std::size_t i = 0; i < std::size(kCuts); ++i)
        for (int r = 0; r < kCuts[i].rows; ++r)
            rows.push_back(double(i) + double(r) / kCuts[i].rows);
    rows.push_back(double(std::size(kCuts) - 1));
    return rows;
}

/// Returns the angle of a column of vertices. Columns are dense around the face.
double angleOf(int column)
{
    const double turn = 2.0 * osg::PI * (column % kColumns) / kColumns;
    return turn - 0.6 * std::sin(turn) - 0.5 * osg::PI;
}

/// Returns the bust, with a flat lower end. It is closed.
osg::ref_ptr<osg::Geometry> bustGeometry()
{
    osg::ref_ptr<osg::Vec3Array> positions = new osg::Vec3Array, normals = new osg::Vec3Array;
    const auto addRow = [&](double along, const Vec3d* normal)
    {
        for (int c = 0; c <= kColumns; ++c)
        {
            positions->push_back(pointOf(along, angleOf(c)));
            normals->push_back(normal ? *normal : normalOf(along, angleOf(c)));
        }
    };
    const Vec3d up(0.0, 0.0, 1.0), down(0.0, 0.0, -1.0);
    const std::vector<double> rows = rowsOfBust();
    const int last = static_cast<int>(rows.size()) - 1;
    for (int r = 0; r <= last; ++r)
        addRow(rows[std::size_t(r)], r == last ? &up : nullptr);
    addRow(0.0, &down);
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    const auto add = [&](int a, int b, int c)
    {
        for (const int index : {a, b, c})
            triangles->push_back(static_cast<GLushort>(index));
    };
    constexpr int kAround = kColumns + 1;
    for (int r = 0; r < last; ++r)
    {
        for (int c = 0; c < kColumns; ++c)
        {
            const int a = r * kAround + c, b = a + kAround;
            add(a, a + 1, b);
            if (r + 1 < last) add(a + 1, b + 1, b);
        }
    }
    const int base = (last + 1) * kAround;
    for (int c = 1; c + 1 < kColumns; ++c)
        add(base, base + c + 1, base + c);
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(positions.get());
    geometry->setNormalArray(normals.get(), osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(triangles.get());
    return geometry;
}

osg::ref_ptr<osg::Geode> bust()
{
    osg::ref_ptr<PhysicalMaterial> wax = new PhysicalMaterial;
    wax->setBaseColor(Vec3(0.93f, 0.75f, 0.52f));
    wax->setSubsurface(1.0f);
    wax->setSubsurfaceRadius(Vec3(0.5f, 0.28f, 0.16f));
    wax->setIor(1.45f);
    wax->setRoughness(0.4f);
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->setName("bust");
    geode->addDrawable(bustGeometry().get());
    geode->getOrCreateStateSet()->setAttribute(wax);
    geode->getStateSet()->setAttributeAndModes(rasterMaterial(*wax, Vec3(0.0f, 0.5f, 0.0f)).get());
    return geode;
}

} // namespace

osg::ref_ptr<osg::Group> waxBust()
{
    const SceneView view{Vec3d(-11, -44, 15), Vec3d(0, 0, 9.2), Vec3d(0, 0, 1), 25.0};
    osg::ref_ptr<osg::MatrixTransform> scene = newScene("wax bust", view, view);
    const float w = 60.0f;
    scene->addChild(surface("table",
                            {{Vec3(-w, -w, 0), Vec3(w, -w, 0), Vec3(w, w, 0), Vec3(-w, w, 0)}},
                            lambert(Vec3(0.2f, 0.16f, 0.13f)).get()));
    scene->addChild(surface("wall",
                            {{Vec3(-w, 30, 0), Vec3(w, 30, 0), Vec3(w, 30, w), Vec3(-w, 30, w)}},
                            lambert(Vec3(0.16f, 0.19f, 0.24f)).get()));
    const std::vector<ProfilePoint> socle{
        {0.0, 0.0, 0.0, -1.0}, {2.6, 0.0, 0.0, -1.0}, {2.6, 0.0, 1.0, 0.0}, {2.6, 0.9, 1.0, 0.0},
        {2.6, 0.9, 0.0, 1.0},  {1.3, 0.9, 0.0, 1.0},  {1.3, 0.9, 1.0, 0.0}, {1.3, 1.99, 1.0, 0.0},
        {1.3, 1.99, 0.0, 1.0}, {0.0, 1.99, 0.0, 1.0}};
    scene->addChild(turned("socle", socle, Vec3d(0, 0, 0.01), kColumns,
                           lambert(Vec3(0.1f, 0.1f, 0.11f)).get()));
    scene->addChild(bust().get());
    // The lamp behind the bust lights it through; a large dim one is before it.
    osg::ref_ptr<AreaLight> lamp = new AreaLight(
        Vec3(5, 14, 22), Vec3(6, 0, 0), Vec3(0.0f, -4.0f, 4.5f), Vec3(110.0f, 100.0f, 86.0f));
    lamp->setName("lamp behind");
    scene->addChild(lamp.get());
    osg::ref_ptr<AreaLight> fill =
        new AreaLight(Vec3(-40, -30, 20), Vec3(0, 0, 20), Vec3(16, -16, 0), Vec3(2.2f, 2.4f, 2.8f));
    fill->setName("lamp before");
    scene->addChild(fill.get());
    return scene;
}

} // namespace osgRayTrace::data
