// PickScenes.h - small graphs to pick in. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/api/Picks.h"

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/MatrixTransform>

#include <cmath>

namespace osgRayTrace::test
{

constexpr auto kAll = osgUtil::Intersector::NO_LIMIT;

/// Returns the vertices of a wavy carpet of 8 x 8 cells in the square [-1,1]^2 at height z, row by
/// row.
inline osg::ref_ptr<osg::Vec3Array> carpetVertices(float z)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (int y = 0; y <= 8; ++y)
        for (int x = 0; x <= 8; ++x)
            vertices->push_back(
                {x * 0.25f - 1.0f, y * 0.25f - 1.0f, z + 0.1f * std::sin(float(x * y))});
    return vertices;
}

/// Returns the carpet's cells as triangles, with degenerate triangles and lines between them.
inline osg::ref_ptr<osg::Geometry> carpet(float z)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(carpetVertices(z));
    osg::ref_ptr<osg::DrawElementsUShort> triangles = new osg::DrawElementsUShort(GL_TRIANGLES);
    for (GLushort y = 0; y < 4; ++y)
        for (GLushort x = 0; x < 8; ++x)
        {
            const GLushort i = 9 * y + x;
            for (const int corner : {0, 1, 9, 9, 1, 10, 0, 0, 1})
                triangles->push_back(GLushort(i + corner));
        }
    geometry->addPrimitiveSet(triangles);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_LINE_STRIP, 0, 20));
    for (GLuint y = 4; y < 8; ++y)
    {
        osg::ref_ptr<osg::DrawElementsUInt> strip = new osg::DrawElementsUInt(GL_TRIANGLE_STRIP);
        for (GLuint x = 0; x <= 8; ++x)
        {
            strip->push_back(9 * y + x);
            strip->push_back(9 * (y + 1) + x);
        }
        geometry->addPrimitiveSet(strip);
    }
    geometry->setName("carpet");
    return geometry;
}

/// Returns flat quads, a quad strip and a fan, side by side, with one colour a primitive set.
inline osg::ref_ptr<osg::Geometry> tiles(float z)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> v = new osg::Vec3Array;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x)
            v->push_back({x * 0.5f - 1.0f, y * 1.0f - 1.0f, z});
    geometry->setVertexArray(v);
    osg::ref_ptr<osg::DrawElementsUByte> quads = new osg::DrawElementsUByte(GL_QUADS);
    for (const int i : {0, 1, 6, 5, 1, 2, 7, 6})
        quads->push_back(GLubyte(i));
    geometry->addPrimitiveSet(quads);
    osg::ref_ptr<osg::DrawElementsUByte> strip = new osg::DrawElementsUByte(GL_QUAD_STRIP);
    for (const int i : {2, 7, 3, 8, 4, 9})
        strip->push_back(GLubyte(i));
    geometry->addPrimitiveSet(strip);
    osg::ref_ptr<osg::DrawElementsUByte> fan = new osg::DrawElementsUByte(GL_POLYGON);
    for (const int i : {5, 9, 14, 10})
        fan->push_back(GLubyte(i));
    geometry->addPrimitiveSet(fan);
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (int i = 0; i < 3; ++i)
        colors->push_back({0.2f * i, 1.0f, 1.0f, 1.0f});
    geometry->setColorArray(colors, osg::Array::BIND_PER_PRIMITIVE_SET);
    geometry->setName("tiles");
    return geometry;
}

inline osg::ref_ptr<osg::MatrixTransform> placed(const osg::Matrixd& matrix, osg::Node* child)
{
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
    transform->addChild(child);
    return transform;
}

inline osg::ref_ptr<RayTracedScene> sceneOf(osg::Node* child)
{
    osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->addChild(child);
    return scene;
}

/// Returns a graph with both carpets in several places, shared and mirrored, and tiles in a geode.
inline osg::ref_ptr<osg::Group> manyThings()
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::Geometry> shared = carpet(0.0f);
    root->addChild(placed(osg::Matrixd::translate(0, 0, -1), shared));
    root->addChild(
        placed(osg::Matrixd::rotate(0.7, osg::Vec3d(1, 2, 3)) * osg::Matrixd::translate(0, 0, 1),
               placed(osg::Matrixd::scale(0.5, 1.5, 1.0), shared)));
    root->addChild(placed(osg::Matrixd::scale(-1.0, 1.0, 1.0), carpet(0.3f)));
    osg::ref_ptr<osg::Geode> geode = new osg::Geode;
    geode->addDrawable(tiles(0.6f));
    root->addChild(geode);
    root->addChild(carpet(-0.4f));
    return root;
}

inline Picks down(osg::Node& root, double x = 0.1, double y = 0.2)
{
    return picksByRay(root, {{x, y, 5.0}, {x, y, -5.0}}, kAll);
}

} // namespace osgRayTrace::test
