// VertexArraysTest.cpp - array types, bindings, bad values and sharing of vertex data.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include "osgRayTrace/bridge/geometry/HostArrays.h"

#include <cmath>
#include <limits>
#include <thread>

using namespace osgRayTrace::engine;

namespace
{

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

/// Returns the triangle (0,0,0) (2,0,0) (0,4,0) in an array of any type.
template <class Array, class Make> osg::ref_ptr<osg::Geometry> triangleOf(const Make& make)
{
    osg::ref_ptr<Array> array = new Array;
    array->push_back(make(0, 0));
    array->push_back(make(2, 0));
    array->push_back(make(0, 4));
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(array);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    return geometry;
}

void checkTriangle(const osg::ref_ptr<osg::Geometry>& geometry)
{
    const ConversionResult result = convertGraph(geometry);
    REQUIRE(result.scene->instances.size() == 1);
    const Mesh& mesh = soleMesh(result);
    REQUIRE(mesh.positions.size() == 3);
    CHECK(mesh.positions[0] == Vec3(0.0f));
    CHECK(mesh.positions[1] == Vec3(2.0f, 0.0f, 0.0f));
    CHECK(mesh.positions[2] == Vec3(0.0f, 4.0f, 0.0f));
}

osg::ref_ptr<osg::Geometry> twoFans()
{
    osg::ref_ptr<osg::Geometry> geometry =
        curveGeometry(6, new osg::DrawArrays(GL_TRIANGLE_FAN, 0, 4));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_FAN, 2, 4));
    return geometry;
}

} // namespace

TEST_CASE("positions of all numeric array types", "[bridge]")
{
    checkTriangle(triangleOf<osg::Vec2Array>([](int x, int y) { return osg::Vec2(x, y); }));
    checkTriangle(triangleOf<osg::Vec3Array>([](int x, int y) { return osg::Vec3(x, y, 0); }));
    checkTriangle(triangleOf<osg::Vec4Array>([](int x, int y) { return osg::Vec4(x, y, 0, 1); }));
    checkTriangle(triangleOf<osg::Vec2dArray>([](int x, int y) { return osg::Vec2d(x, y); }));
    checkTriangle(triangleOf<osg::Vec3dArray>([](int x, int y) { return osg::Vec3d(x, y, 0); }));
    checkTriangle(
        triangleOf<osg::Vec4dArray>([](int x, int y) { return osg::Vec4d(3 * x, 3 * y, 0, 3); }));
    checkTriangle(triangleOf<osg::Vec3sArray>([](int x, int y) { return osg::Vec3s(x, y, 0); }));
    checkTriangle(triangleOf<osg::Vec3bArray>([](int x, int y) { return osg::Vec3b(x, y, 0); }));
    checkTriangle(triangleOf<osg::Vec2iArray>([](int x, int y) { return osg::Vec2i(x, y); }));
}

TEST_CASE("positions in vertex attribute 0 are used without a vertex array", "[bridge]")
{
    const auto geometry =
        triangleOf<osg::Vec3Array>([](int x, int y) { return osg::Vec3(x, y, 0); });
    geometry->setVertexAttribArray(0, geometry->getVertexArray(), osg::Array::BIND_PER_VERTEX);
    geometry->setVertexArray(nullptr);
    checkTriangle(geometry);
}

TEST_CASE("triangles with vertices that are not finite or too large are dropped and counted",
          "[bridge]")
{
    for (const float bad : {kNaN, kInf, -kInf, 2e18f, -3e38f})
    {
        const auto geometry = curveGeometry(5, new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 5));
        (*static_cast<osg::Vec3Array*>(geometry->getVertexArray()))[0].y() = bad;
        const ConversionResult result = convertGraph(geometry);
        CHECK(soleMesh(result).triangles.size() == 2);
        CHECK(countOf(result, "skipped.not-finite") == 1);
        for (const Vec3& p : soleMesh(result).positions)
            CHECK(isFinite(p));
    }
}

namespace
{

/// Returns an array that does not end at the end of a page. An array that ends there by chance is
/// copied by the converter, because Embree reads past the last vertex.
template <class A>
osg::ref_ptr<A> awayFromPageEnd(osg::ref_ptr<A> array, osg::ref_ptr<osg::Array>& other)
{
    const auto begin = reinterpret_cast<std::uintptr_t>(array->getDataPointer());
    if ((begin + array->getTotalDataSize()) % 4096 != 0) return array;
    other = array;
    return osg::clone(array.get(), osg::CopyOp::DEEP_COPY_ALL);
}

} // namespace

TEST_CASE("arrays in the right layout are shared, not copied", "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::ref_ptr<osg::Array> others[4]; // kept, so that copies get other addresses
    geometry->setVertexArray(
        awayFromPageEnd(osg::ref_ptr<osg::Array>(geometry->getVertexArray()), others[0]));
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(3);
    for (osg::Vec3& n : *normals)
        n.set(0.0f, 0.0f, 1.0f);
    normals = awayFromPageEnd(normals, others[1]);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec2Array> uvs =
        awayFromPageEnd(osg::ref_ptr<osg::Vec2Array>(new osg::Vec2Array(3)), others[2]);
    geometry->setTexCoordArray(0, uvs);
    osg::ref_ptr<osg::Vec4Array> colors =
        awayFromPageEnd(osg::ref_ptr<osg::Vec4Array>(new osg::Vec4Array(3)), others[3]);
    geometry->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    const void* positions = geometry->getVertexArray()->getDataPointer();
    const void* indices = geometry->getPrimitiveSet(0)->getDataPointer();

    ConversionResult result = convertGraph(geometry);
    {
        const Mesh& mesh = soleMesh(result);
        CHECK(mesh.positions.data() == positions);
        CHECK(mesh.triangles.data() == indices);
        CHECK(mesh.normals.data() == normals->getDataPointer());
        CHECK(mesh.uvs.data() == uvs->getDataPointer());
        CHECK(mesh.colors.data() == colors->getDataPointer());
    }

    SECTION(
        "the scene keeps them alive; they go by the thread that updates, whoever used them last")
    {
        osg::observer_ptr<osg::Array> array = geometry->getVertexArray();
        geometry->setVertexArray(new osg::Vec3Array);
        CHECK(array.valid());
        CHECK(soleMesh(result).positions[1] == Vec3(1.0f, 0.0f, 0.0f));
        std::thread([&result] { result = ConversionResult(); }).join();
        CHECK(array.valid());
        releaseHostArrays();
        CHECK_FALSE(array.valid());
    }
    SECTION("a geometry or an array that says that it will change is copied")
    {
        geometry->getVertexArray()->setDataVariance(osg::Object::DYNAMIC);
        result = convertGraph(geometry);
        CHECK(soleMesh(result).positions.data() != positions);
        CHECK(soleMesh(result).triangles.data() == indices);

        geometry->setDataVariance(osg::Object::DYNAMIC);
        result = convertGraph(geometry);
        CHECK(soleMesh(result).triangles.data() != indices);
        CHECK(soleMesh(result).normals.data() != normals->getDataPointer());
        CHECK(soleMesh(result).triangles[0] == UVec3(0, 1, 2));
    }
    SECTION("an origin that is not zero moves, and so copies, the positions")
    {
        ConversionInput input = inputFor(geometry);
        input.origin.set(1.0, 2.0, 3.0);
        SceneConverter converter;
        result = converter.convert(input);
        CHECK(soleMesh(result).positions[0] == Vec3(-1.0f, -2.0f, -3.0f));
        CHECK(soleMesh(result).triangles.data() == indices);
    }
    SECTION("several placed uses share as well")
    {
        osg::ref_ptr<osg::Group> root = new osg::Group;
        for (const double x : {5.0, 7.0})
        {
            osg::ref_ptr<osg::MatrixTransform> transform =
                new osg::MatrixTransform(osg::Matrixd::translate(x, 0.0, 0.0));
            transform->addChild(geometry);
            root->addChild(transform);
        }
        result = convertGraph(root);
        CHECK(soleMesh(result).positions.data() == positions);
        CHECK(soleMesh(result).triangles.data() == indices);
    }
}

TEST_CASE("normals: none gives facets, every binding gives unit normals", "[bridge]")
{
    const auto geometry = twoFans();
    CHECK(soleMesh(convertGraph(geometry)).normals.empty());

    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    geometry->setNormalArray(normals, osg::Array::BIND_OVERALL);
    CHECK(soleMesh(convertGraph(geometry)).normals.empty());

    normals->push_back({0.0f, 0.0f, 5.0f});
    ConversionResult result = convertGraph(geometry);
    REQUIRE(soleMesh(result).normals.size() == 6);
    for (const Vec3& n : soleMesh(result).normals)
        CHECK(n == Vec3(0.0f, 0.0f, 1.0f));

    osg::ref_ptr<osg::Vec3bArray> bytes = new osg::Vec3bArray(6);
    for (osg::Vec3b& n : *bytes)
        n.set(0, -64, 0);
    geometry->setNormalArray(bytes, osg::Array::BIND_PER_VERTEX);
    result = convertGraph(geometry);
    for (const Vec3& n : soleMesh(result).normals)
        CHECK(n == Vec3(0.0f, -1.0f, 0.0f));
}

TEST_CASE("values per primitive set split the vertices that two sets use", "[bridge]")
{
    const auto geometry = twoFans();
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array;
    normals->push_back({0.0f, 0.0f, 1.0f});
    normals->push_back({0.0f, 1.0f, 0.0f});
    geometry->setNormalArray(normals, osg::Array::BIND_PER_PRIMITIVE_SET);
    osg::ref_ptr<osg::Vec4ubArray> colors = new osg::Vec4ubArray;
    colors->push_back({255, 0, 0, 255});
    colors->push_back({0, 51, 0, 255});
    geometry->setColorArray(colors, osg::Array::BIND_PER_PRIMITIVE_SET);
    osg::ref_ptr<osg::Vec2Array> uvs = new osg::Vec2Array;
    for (int i = 0; i < 6; ++i)
        uvs->push_back({0.1f * i, 0.0f});
    geometry->setTexCoordArray(0, uvs);

    const ConversionResult result = convertGraph(geometry);
    const Mesh& mesh = soleMesh(result);
    REQUIRE(mesh.positions.size() == 8);
    REQUIRE(mesh.triangles.size() == 4);
    for (std::size_t i = 0; i < 4; ++i)
    {
        const bool first = i < 2;
        for (int corner = 0; corner < 3; ++corner)
        {
            const uint32_t v = mesh.triangles[i][corner];
            CHECK(mesh.normals[v] == (first ? Vec3(0.0f, 0.0f, 1.0f) : Vec3(0.0f, 1.0f, 0.0f)));
            CHECK(mesh.colors[v] ==
                  (first ? Vec4(1.0f, 0.0f, 0.0f, 1.0f) : Vec4(0.0f, 0.2f, 0.0f, 1.0f)));
            CHECK(mesh.uvs[v].x == Approx(0.1f * mesh.positions[v].x));
        }
    }
    CHECK(mesh.positions[mesh.triangles[2].x] == Vec3(2.0f, 4.0f, 0.0f));
}

TEST_CASE("normals that are zero, NaN or missing become face normals and are counted",
          "[bridge][stability 54]")
{
    const auto geometry = curveGeometry(5, new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 5));
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(3);
    (*normals)[0].set(1.0f, 0.0f, 0.0f);
    (*normals)[1].set(0.0f, 0.0f, 0.0f);
    (*normals)[2].set(kNaN, 0.0f, 0.0f);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    const ConversionResult result = convertGraph(geometry);
    const Mesh& mesh = soleMesh(result);
    REQUIRE(mesh.normals.size() == 5);
    CHECK(mesh.normals[0] == Vec3(1.0f, 0.0f, 0.0f));
    for (std::size_t i = 1; i < 5; ++i)
        CHECK(std::fabs(mesh.normals[i].z) == 1.0f);
    CHECK(countOf(result, "repaired.normal") == 4);
}

TEST_CASE("normals follow a non-uniform, mirrored transform, and so do the fronts", "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::ref_ptr<osg::Vec3Array> normals = new osg::Vec3Array(3);
    for (osg::Vec3& n : *normals)
        n = osg::Vec3(0.0f, 1.0f, 1.0f) / std::sqrt(2.0f);
    geometry->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::MatrixTransform> transform =
        new osg::MatrixTransform(osg::Matrixd::scale(-1.0, 2.0, 1.0));
    transform->addChild(geometry);
    const ConversionResult result = convertGraph(transform);
    const Mesh& mesh = soleMesh(result);
    const Vec3 expected = glm::normalize(Vec3(0.0f, 0.5f, 1.0f));
    CHECK(glm::length(mesh.normals[0] - expected) < 1e-6f);
    const UVec3& t = mesh.triangles[0];
    const Vec3 front = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                  mesh.positions[t.z] - mesh.positions[t.x]);
    CHECK(front.z > 0.0f);
}

TEST_CASE("colours and texture coordinates of other types; bad values are replaced and counted",
          "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::ref_ptr<osg::Vec3ubArray> colors = new osg::Vec3ubArray(2);
    (*colors)[0].set(255, 51, 0);
    (*colors)[1].set(0, 255, 0);
    geometry->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Vec4dArray> uvs = new osg::Vec4dArray(3);
    (*uvs)[0].set(1.0, 3.0, 0.0, 2.0);
    (*uvs)[1].set(0.25, 0.75, 0.0, 1.0);
    (*uvs)[2].set(1.0, 1.0, 0.0, 0.0);
    geometry->setTexCoordArray(0, uvs);
    const ConversionResult result = convertGraph(geometry);
    const Mesh& mesh = soleMesh(result);
    CHECK(mesh.colors[0] == Vec4(1.0f, 0.2f, 0.0f, 1.0f));
    CHECK(mesh.colors[2] == Vec4(1.0f));
    CHECK(countOf(result, "repaired.color") == 1);
    CHECK(mesh.uvs[0] == Vec2(0.5f, 1.5f));
    CHECK(mesh.uvs[1] == Vec2(0.25f, 0.75f));
    CHECK(mesh.uvs[2] == Vec2(0.0f));
    CHECK(countOf(result, "repaired.texture-coordinate") == 1);
}
