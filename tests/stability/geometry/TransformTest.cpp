// TransformTest.cpp - transforms that are singular, mirrored, uneven or many. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Rays.h"
#include "tests/Statistics.h"
#include "tests/stability/geometry/Pictured.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"

#include <osgRayTrace/PhysicalMaterial>

#include <cmath>
#include <limits>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a smooth ball of radius 1 around the origin, whose vertices are moved by the matrix
/// beforehand.
osg::ref_ptr<osg::Geometry> ball(const osg::Matrixd& matrix = osg::Matrixd(), int rows = 24)
{
    const auto sphere = sphereMesh(Vec3(0.0f), 1.0f, rows);
    const osg::Matrixd inverse = osg::Matrixd::inverse(matrix);
    const bool mirrored = (osg::Vec3d(matrix(0, 0), matrix(0, 1), matrix(0, 2)) ^
                           osg::Vec3d(matrix(1, 0), matrix(1, 1), matrix(1, 2))) *
                              osg::Vec3d(matrix(2, 0), matrix(2, 1), matrix(2, 2)) <
                          0.0;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
    for (const Vec3& p : sphere->positions)
    {
        const osg::Vec3d local(p.x, p.y, p.z);
        vertices->push_back(local * matrix);
        // OSG's vectors are rows: multiplied from the other side, the inverse acts as the inverse
        // transpose.
        osg::Vec3d normal = osg::Matrixd::transform3x3(inverse, local);
        normal.normalize();
        normals->push_back(normal);
    }
    osg::ref_ptr<osg::DrawElementsUInt> elements = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (const UVec3& t : sphere->triangles)
        for (const GLuint i : {t.x, mirrored ? t.z : t.y, mirrored ? t.y : t.z})
            elements->push_back(i);
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(elements);
    return geometry;
}

std::shared_ptr<const TracedScene> tracedOf(osg::Node* root)
{
    return TracedScene::build(convertGraph(root).scene, std::make_shared<Workers>());
}

/// Returns the node twice, so that it becomes an instance; the second one is out of sight.
osg::ref_ptr<osg::Group> shared(const osg::Matrixd& matrix, osg::Node* child)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(placed(matrix, child));
    group->addChild(placed(matrix * osg::Matrixd::translate(0.0, 0.0, 1e6), child));
    return group;
}

struct Point
{
    Vec3d position, geometricNormal, shadingNormal;
    bool front = false;
};

std::optional<Point> shoot(const TracedScene& traced, const Vec3d& origin, const Vec3d& direction)
{
    RayHitBlock block = {};
    const Vec3 o(origin), d(glm::normalize(direction));
    setRay(block.ray, 0, o, d);
    traced.intersector().closestHits(block, 1u, Coherence::Incoherent);
    SurfaceLanes s;
    surfacesOf(traced.surfaces(), block, 1u, s);
    if (!s.hits) return std::nullopt;
    const auto at = [](const Vec3Lanes& lanes)
    { return Vec3d(lanes.x[0], lanes.y[0], lanes.z[0]); };
    return Point{at(s.position), at(s.geometricNormal), at(s.shadingNormal), (s.front & 1u) != 0};
}

Vec3d toGlm(const osg::Vec3d& v)
{
    return {v.x(), v.y(), v.z()};
}

} // namespace

TEST_CASE("stability 15: transforms that nothing can be placed by leave the rest as it is",
          "[stability]")
{
    const Picture alone = pictureOf(convertGraph(lit({ball()})), IntegratorKind::Path);
    CHECK(alone.mean().y > 0.01f);
    osg::Matrixd infinite;
    infinite(1, 1) = std::numeric_limits<double>::infinity();
    struct Case
    {
        osg::Matrixd matrix;
        const char* count;
    };
    for (const Case& c :
         {Case{osg::Matrixd::scale(1.0, 0.0, 0.0), "skipped.singular-transform"},
          Case{osg::Matrixd::scale(0.0, 0.0, 0.0), "skipped.singular-transform"},
          Case{osg::Matrixd::translate(std::nan(""), 0.0, 0.0), "skipped.not-finite-transform"},
          Case{infinite, "skipped.not-finite-transform"}})
    {
        const ConversionResult converted =
            convertGraph(lit({placed(c.matrix, ball()), shared(c.matrix, ball()), ball()}));
        CHECK(converted.scene->instances.size() == 1);
        CHECK(countOf(converted, c.count) == 3);
        const Picture picture = pictureOf(converted, IntegratorKind::Path);
        CHECK(differing(picture, alone) == 0);
    }
}

TEST_CASE("stability 15: a model under a scale of 1e-20 is kept, too small to be seen",
          "[stability]")
{
    // The transform is not skipped, because its children may be as large as the scale is small.
    const osg::Matrixd tiny = osg::Matrixd::scale(1e-20, 1e-20, 1e-20);
    const Picture alone = pictureOf(convertGraph(lit({ball()})), IntegratorKind::Path);
    for (const osg::Matrixd& matrix : {tiny * osg::Matrixd::translate(0.0, 0.0, 2.0), tiny})
    {
        const ConversionResult converted =
            convertGraph(lit({ball(), placed(matrix, ball()), shared(matrix, ball())}));
        const Picture picture = pictureOf(converted, IntegratorKind::Path);
        CHECK(picture.progress.droppedSamples == 0);
        CHECK(differing(picture, alone) == 0);
    }
    osg::ref_ptr<osg::Geometry> huge = ball(osg::Matrixd::scale(1e17, 1e17, 1e17));
    const osg::Matrixd back = osg::Matrixd::scale(1e-17, 1e-17, 1e-17);
    const Picture same = pictureOf(convertGraph(lit({placed(back, huge)})), IntegratorKind::Path);
    int different = 0; // a vertex may round the other way
    for (std::size_t i = 0; i < same.rgba.size(); ++i)
        different += std::abs(same.rgba[i] - alone.rgba[i]) > 1e-3f;
    CHECK(different < 40);
}

TEST_CASE("stability 16: mirrored and uneven scales give the normals of the moved vertices",
          "[stability]")
{
    const osg::Matrixd turn = osg::Matrixd::rotate(0.7, osg::Vec3d(1.0, 2.0, 3.0)) *
                              osg::Matrixd::translate(0.5, -0.25, 0.125);
    Uniform random(16);
    for (const osg::Matrixd& matrix :
         {osg::Matrixd::scale(-1.0, 1.0, 1.0), osg::Matrixd::scale(-2.0, 3.0, 0.5) * turn,
          osg::Matrixd::scale(-1.0, -1.0, -1.0) * turn, osg::Matrixd::scale(1.0, 1e-4, 1e4),
          osg::Matrixd::scale(1.0, -1e-4, 1e4)})
    {
        const auto moved = tracedOf(ball(matrix)), baked = tracedOf(placed(matrix, ball())),
                   instance = tracedOf(shared(matrix, ball()));
        const osg::Matrixd inverse = osg::Matrixd::inverse(matrix);
        const auto local = [&](const Vec3d& p)
        { return toGlm(osg::Vec3d(p.x, p.y, p.z) * inverse); };
        int compared = 0, wrongSide = 0;
        double worst = 0.0;
        for (int k = 0; k < 3000; ++k)
        {
            // Rays go from a point outside or inside to a point within, in the ball's own
            // coordinates.
            const auto within = [&]
            {
                return osg::Vec3d(random.between(-0.5, 0.5), random.between(-0.5, 0.5),
                                  random.between(-0.5, 0.5));
            };
            const bool outside = k % 2 == 0;
            osg::Vec3d from = within();
            const osg::Vec3d to = within();
            if (outside)
            {
                from.normalize();
                from *= 1.5;
            }
            const Vec3d origin = toGlm(from * matrix), direction = toGlm(to * matrix) - origin;
            const std::optional<Point> expected = shoot(*moved, origin, direction);
            REQUIRE(expected);
            wrongSide += expected->front != outside;
            for (const TracedScene* traced : {baked.get(), instance.get()})
            {
                const std::optional<Point> point = shoot(*traced, origin, direction);
                REQUIRE(point);
                wrongSide += point->front != outside;
                worst = std::max({worst,
                                  glm::length(local(point->position) - local(expected->position)),
                                  glm::length(point->geometricNormal - expected->geometricNormal),
                                  glm::length(point->shadingNormal - expected->shadingNormal)});
                ++compared;
            }
        }
        CAPTURE(matrix(0, 0), matrix(1, 1), matrix(2, 2), worst);
        CHECK(compared == 6000);
        CHECK(wrongSide == 0);
        CHECK(worst <= 1e-5);
    }
}

TEST_CASE("stability 16: a mirrored ball of glass refracts as one that was made mirrored",
          "[stability]")
{
    const osg::Matrixd matrix =
        osg::Matrixd::scale(-0.8, 0.7, 0.9) * osg::Matrixd::rotate(0.4, osg::Vec3d(1, 1, 0));
    osg::ref_ptr<osgRayTrace::PhysicalMaterial> glass = new osgRayTrace::PhysicalMaterial;
    glass->setTransmission(1.0f);
    glass->setRoughness(0.0f);
    const auto pictured = [&](const osg::ref_ptr<osg::Node>& node)
    {
        node->getOrCreateStateSet()->setAttribute(glass);
        osg::ref_ptr<osg::Geometry> floor = new osg::Geometry;
        osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
        for (int i = 0; i < 4; ++i)
            corners->push_back({i % 3 == 0 ? -4.0f : 1.0f, i < 2 ? -4.0f : 4.0f, -1.5f});
        floor->setVertexArray(corners);
        floor->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
        osg::ref_ptr<osgRayTrace::PhysicalMaterial> shining = new osgRayTrace::PhysicalMaterial;
        shining->setEmission({1.0f, 1.0f, 1.0f});
        floor->getOrCreateStateSet()->setAttribute(shining);
        const auto traced = tracedOf(lit({node, floor}));
        return render(traced, obliqueView(), optionsOf(IntegratorKind::Path), 64);
    };
    const Picture moved = pictured(ball(matrix, 96));
    CHECK(moved.mean().y > 0.05f);
    for (const bool instanced : {false, true})
    {
        const Picture other =
            pictured(instanced ? osg::ref_ptr<osg::Node>(shared(matrix, ball(osg::Matrixd(), 96)))
                               : osg::ref_ptr<osg::Node>(placed(matrix, ball(osg::Matrixd(), 96))));
        // A last bit may send a path to the other side of an edge: a few pixels change, but not
        // their mean.
        int different = 0;
        for (std::size_t i = 0; i < moved.rgba.size(); ++i)
            different += std::abs(moved.rgba[i] - other.rgba[i]) > 1e-5f;
        CAPTURE(instanced, different);
        CHECK(different <= static_cast<int>(moved.rgba.size() / 50));
        CHECK(glm::length(moved.mean() - other.mean()) < 1e-3f * moved.mean().y);
    }
}

TEST_CASE("stability 17: 64 nested transforms place as their product in long double does",
          "[stability]")
{
    using Matrix = glm::mat<4, 4, long double>;
    using Vector = glm::vec<4, long double>;
    Uniform random(17);
    for (const double step : {1.0, 1e5})
    {
        osg::ref_ptr<osg::Node> node = triangleGeometry();
        Matrix worldFromLocal(1.0L);
        for (int level = 0; level < 64; ++level)
        {
            const auto number = [&](double size) { return size * random.between(-1.0, 1.0); };
            const osg::Matrixd matrix =
                osg::Matrixd::scale(1.0 + number(0.1), 1.0 + number(0.1), 1.0 + number(0.1)) *
                osg::Matrixd::rotate(number(3.0),
                                     osg::Vec3d(number(1.0), number(1.0), number(1.0) + 2.0)) *
                osg::Matrixd::translate(number(step), number(step), number(step));
            Matrix m;
            for (int row = 0; row < 4; ++row)
                for (int column = 0; column < 4; ++column)
                    m[row][column] = static_cast<long double>(matrix(row, column));
            worldFromLocal = m * worldFromLocal; // each transform is above those before
            node = placed(matrix, node);
        }
        const auto world = [&](const Vec3& p)
        { return worldFromLocal * Vector(p.x, p.y, p.z, 1.0L); };
        ConversionInput input = inputFor(node);
        const Vector origin = world(Vec3(0.0f));
        input.origin.set(double(origin.x), double(origin.y), double(origin.z));
        SceneConverter converter;
        const ConversionResult result = converter.convert(input);
        const Mesh& mesh = soleMesh(result);
        double worst = 0.0;
        const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Vector p = world(corners[i]);
            const Vec3d expected(double(p.x - static_cast<long double>(input.origin.x())),
                                 double(p.y - static_cast<long double>(input.origin.y())),
                                 double(p.z - static_cast<long double>(input.origin.z())));
            worst = std::max(worst, glm::length(Vec3d(mesh.positions[i]) - expected));
        }
        CAPTURE(step, worst);
        CHECK(worst <= 1e-6);
    }
}
