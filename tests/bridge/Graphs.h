// Graphs.h - small scene graphs and their conversion, for the tests of the bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/convert/SceneConverter.h"

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/MatrixTransform>

#include <initializer_list>

namespace osgRayTrace::engine
{

/// Returns the lower left half of the unit square, counter-clockwise seen from +z. Its arrays have
/// Embree's layout, so that they can be shared.
inline osg::ref_ptr<osg::Geometry> triangleGeometry()
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    vertices->push_back({0.0f, 0.0f, 0.0f});
    vertices->push_back({1.0f, 0.0f, 0.0f});
    vertices->push_back({0.0f, 1.0f, 0.0f});
    vertices->reserve(8);
    geometry->setVertexArray(vertices);
    const GLuint indices[] = {0, 1, 2};
    geometry->addPrimitiveSet(new osg::DrawElementsUInt(GL_TRIANGLES, 3, indices));
    return geometry;
}

/// Returns count vertices (i, i*i, 0): no three of them are collinear.
inline osg::ref_ptr<osg::Vec3Array> curveVertices(unsigned int count)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (unsigned int i = 0; i < count; ++i)
        vertices->push_back(osg::Vec3(float(i), float(i * i), 0.0f));
    return vertices;
}

inline osg::ref_ptr<osg::Geometry> curveGeometry(unsigned int count, osg::PrimitiveSet* primitives)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(curveVertices(count));
    geometry->addPrimitiveSet(primitives);
    return geometry;
}

inline ConversionInput inputFor(osg::Node* root)
{
    ConversionInput input;
    input.root = root;
    return input;
}

inline ConversionResult convertGraph(osg::Node* root)
{
    SceneConverter converter;
    return converter.convert(inputFor(root));
}

/// Returns the mesh of the only instance.
inline const Mesh& soleMesh(const ConversionResult& result)
{
    return *result.scene->meshes.at(result.scene->instances.at(0).mesh);
}

inline const Material& soleMaterial(const ConversionResult& result)
{
    return result.scene->materials.at(result.scene->instances.at(0).material);
}

inline uint64_t countOf(const ConversionResult& result, const std::string& what)
{
    const auto found = result.counts.find(what);
    return found == result.counts.end() ? 0 : found->second;
}

/// Returns the position of the first vertex of the first triangle of an instance, in engine space.
inline Vec3 firstCorner(const Scene& scene, std::size_t instance)
{
    const Instance& use = scene.instances.at(instance);
    const Mesh& mesh = *scene.meshes.at(use.mesh);
    const Vec3 p = mesh.positions[mesh.triangles[0].x];
    return use.placed ? transformPoint(use.engineFromLocal, p) : p;
}

inline osg::ref_ptr<osg::MatrixTransform> placed(const osg::Matrixd& matrix, osg::Node* child)
{
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
    transform->addChild(child);
    return transform;
}

} // namespace osgRayTrace::engine
