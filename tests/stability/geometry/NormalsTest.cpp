// NormalsTest.cpp - vertex normals that do not suit their faces. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/stability/geometry/Pictured.h"

#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgRayTrace/PhysicalMaterial>

#include <cmath>
#include <limits>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a box whose sides have vertices of their own, so that face normals are vertex normals.
osg::ref_ptr<osg::Geometry> box(const osg::Vec3* normalOfAll, bool physical)
{
    const auto mesh = boxMesh(Vec3(-0.6f), Vec3(0.6f, 0.5f, 0.4f));
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
    for (const UVec3& t : mesh->triangles)
        for (int corner = 0; corner < 3; ++corner)
        {
            const Vec3 p = mesh->positions[t[corner]];
            vertices->push_back({p.x, p.y, p.z});
            if (normalOfAll) normals->push_back(*normalOfAll);
        }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    if (normalOfAll) geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(
        new osg::DrawArrays(GL_TRIANGLES, 0, static_cast<int>(vertices->size())));
    if (physical) geometry->getOrCreateStateSet()->setAttribute(new osgRayTrace::PhysicalMaterial);
    return geometry;
}

/// Sets the face normals, reversed if sign is -1.
void setFaceNormals(osg::Geometry& geometry, float sign)
{
    const auto& vertices = *static_cast<const osg::Vec3Array*>(geometry.getVertexArray());
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    for (std::size_t i = 0; i < vertices.size(); i += 3)
    {
        osg::Vec3 n = (vertices[i + 1] - vertices[i]) ^ (vertices[i + 2] - vertices[i]);
        n.normalize();
        for (int corner = 0; corner < 3; ++corner)
            normals->push_back(n * sign);
    }
    geometry.setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
}

const IntegratorKind kBoth[] = {IntegratorKind::Whitted, IntegratorKind::Path};

} // namespace

TEST_CASE("stability 54: normals of no length or no number are those of the faces, and counted",
          "[stability]")
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    for (const bool physical : {false, true})
    {
        for (const IntegratorKind kind : kBoth)
        {
            const auto faces = box(nullptr, physical);
            const Picture expected = pictureOf(convertGraph(lit({faces})), kind);
            CHECK(expected.mean().y > 0.01f);
            for (const osg::Vec3& bad : {osg::Vec3(0, 0, 0), osg::Vec3(nan, 0, 1),
                                         osg::Vec3(0, inf, 0), osg::Vec3(1e-30f, 0, 0) * 1e-30f})
            {
                const auto allBad = box(&bad, physical);
                CHECK(differing(pictureOf(convertGraph(lit({allBad})), kind), expected) == 0);

                // One bad normal is among good ones.
                const auto oneBad = box(nullptr, physical);
                setFaceNormals(*oneBad, 1.0f);
                (*static_cast<osg::Vec3Array*>(oneBad->getNormalArray()))[4] = bad;
                const ConversionResult converted = convertGraph(lit({oneBad}));
                CHECK(countOf(converted, "repaired.normal") == 1);
                CHECK(differing(pictureOf(converted, kind), expected) == 0);
            }
        }
    }
}

TEST_CASE("stability 54: normals opposite to their faces are counted", "[stability]")
{
    for (const bool physical : {false, true})
    {
        const auto geometry = box(nullptr, physical);
        CHECK(countOf(convertGraph(lit({geometry})), "warned.opposite-normals") == 0);
        setFaceNormals(*geometry, 1.0f);
        CHECK(countOf(convertGraph(lit({geometry})), "warned.opposite-normals") == 0);
        setFaceNormals(*geometry, -1.0f);
        CHECK(countOf(convertGraph(lit({geometry})), "warned.opposite-normals") == 12);

        // The test changes one side of the box. A single corner that leans back is normal for
        // smooth edges.
        setFaceNormals(*geometry, 1.0f);
        auto& normals = *static_cast<osg::Vec3Array*>(geometry->getNormalArray());
        normals[6] = -normals[6];
        CHECK(countOf(convertGraph(lit({geometry})), "warned.opposite-normals") == 0);
        normals[7] = -normals[7];
        normals[8] = -normals[8];
        CHECK(countOf(convertGraph(lit({geometry})), "warned.opposite-normals") == 1);

        // A transform that mirrors changes neither the faces nor the normals' sides.
        osg::ref_ptr<osg::MatrixTransform> mirrored =
            new osg::MatrixTransform(osg::Matrixd::scale(-1.0, 1.0, 1.0));
        mirrored->addChild(geometry);
        CHECK(countOf(convertGraph(lit({mirrored})), "warned.opposite-normals") == 1);
    }
}

TEST_CASE("stability 54: normals opposite to their faces are turned, but for OpenGL's materials",
          "[stability]")
{
    for (const IntegratorKind kind : kBoth)
    {
        const auto against = box(nullptr, true);
        setFaceNormals(*against, -1.0f);
        const Picture expected = pictureOf(convertGraph(lit({box(nullptr, true)})), kind);
        CHECK(expected.mean().y > 0.01f);
        CHECK(differing(pictureOf(convertGraph(lit({against})), kind), expected) == 0);

        // One-sided lighting of OpenGL takes normals as they are: all sides of the box are dark but
        // for the ambient light.
        const auto fixed = box(nullptr, false);
        const Picture shown = pictureOf(convertGraph(lit({fixed})), kind);
        setFaceNormals(*fixed, -1.0f);
        const Picture dark = pictureOf(convertGraph(lit({fixed})), kind);
        if (kind == IntegratorKind::Whitted) CHECK(dark.mean().y < 0.5f * shown.mean().y);
        CHECK(dark.progress.droppedSamples == 0);
    }
}

TEST_CASE("stability 54: slivers at the poles of spheres have no side", "[stability]")
{
    for (const osg::Vec3& centre : {osg::Vec3(), osg::Vec3(3.0f, -7.0f, 0.7f)})
        for (const float radius : {0.01f, 0.9f, 5.0f})
        {
            osg::ref_ptr<osg::ShapeDrawable> sphere =
                new osg::ShapeDrawable(new osg::Sphere(centre, radius));
            CAPTURE(radius, centre.x());
            CHECK(countOf(convertGraph(lit({sphere})), "warned.opposite-normals") == 0);
        }
}
