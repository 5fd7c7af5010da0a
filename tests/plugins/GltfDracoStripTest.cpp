// GltfDracoStripTest.cpp - compressed triangle strips. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfCompression.h"
#include "tests/Catch.h"

#include <osg/TriangleIndexFunctor>

#include <algorithm>
#include <cmath>
#include <set>

#ifdef OSGRAYTRACE_TEST_DRACO

using namespace osgRayTrace::test;

namespace
{

/// Collects triangles by the places of their corners, from the first one of these on.
struct CollectPlaces
{
    const osg::Vec3Array* positions = nullptr;
    std::multiset<std::vector<long>> triangles;

    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        std::vector<std::pair<long, long>> places;
        for (const unsigned int i : {a, b, c})
            places.emplace_back(std::lround((*positions)[i].x()), std::lround((*positions)[i].y()));
        std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
        std::vector<long> flat;
        for (const auto& [x, y] : places)
            flat.insert(flat.end(), {x, y});
        triangles.insert(flat);
    }
};

std::multiset<std::vector<long>> trianglesOf(const Json& model)
{
    const auto scene = sceneOf(model);
    const osg::Geometry& geometry = geometryOf(*scene);
    osg::TriangleIndexFunctor<CollectPlaces> collect;
    collect.positions = &arrayOf<osg::Vec3Array>(geometry.getVertexArray());
    geometry.accept(collect);
    return collect.triangles;
}

Json& primitiveOf(Json& model)
{
    return model["meshes"][0]["primitives"][0];
}

/// Returns the mesh as a strip whose accessor has so many indices.
Json stripOf(Json model, std::size_t indices)
{
    primitiveOf(model)["mode"] = 5;
    model["accessors"][primitiveOf(model)["indices"].get<std::size_t>()]["count"] = indices;
    return model;
}

} // namespace

TEST_CASE("gltf: a compressed strip has the triangles of its mesh", "[gltf]")
{
    const Grid grid = gridOf(12);
    const std::size_t faces = grid.indices.size() / 3;
    for (const bool edgebreaker : {false, true})
    {
        const Json model = dracoModel(grid, dracoBytes(grid, {12, edgebreaker}));
        const auto expected = trianglesOf(model);
        REQUIRE(expected.size() == faces);
        // The shortest strip, one with degenerate triangles between its rows, and a list's count.
        for (const std::size_t indices : {faces + 2, faces + 2 + 11 * 4, 3 * faces})
        {
            INFO(edgebreaker << " " << indices);
            CHECK(trianglesOf(stripOf(model, indices)) == expected);
        }
        // The same accessors once more, in another primitive of the mesh.
        Json twice = stripOf(model, faces + 2);
        Json second = primitiveOf(twice);
        twice["meshes"][0]["primitives"].push_back(second);
        const auto scene = sceneOf(twice);
        REQUIRE(findAll<osg::Geometry>(*scene).size() == 2);
        CHECK(geometryOf(*scene, 1).getPrimitiveSet(0)->getNumIndices() == 3 * faces);
    }
}

TEST_CASE("gltf: a strip is too short for a mesh, and other modes are not compressed", "[gltf]")
{
    const Grid grid = gridOf(4);
    const Json model = dracoModel(grid, dracoBytes(grid, {12, true}));
    const auto refusal = [](const Json& wrong) { return refusalOf(wrong); };
    CHECK(refusal(stripOf(model, 33)).find("has 32 triangles, and the indices at most 31") !=
          std::string::npos);
    for (const std::size_t few : {0, 1, 2})
        CHECK(refusal(stripOf(model, few)).find("at most 0") != std::string::npos);
    for (const int mode : {0, 1, 2, 3, 6, 7})
    {
        Json other = model;
        primitiveOf(other)["mode"] = mode;
        CHECK(refusal(other).find("primitives[0].mode: is not that of triangles or of a strip") !=
              std::string::npos);
    }
    Json bytes = stripOf(model, 34);
    const auto indices = primitiveOf(bytes)["indices"].get<std::size_t>();
    bytes["accessors"][indices]["componentType"] = kUnsignedByte;
    CHECK(refusal(bytes).empty());
    bytes = stripOf(dracoModel(gridOf(16), dracoBytes(gridOf(16), {12, true})), 600);
    bytes["accessors"][indices]["componentType"] = kUnsignedByte;
    CHECK(refusal(bytes).find("does not fit the accessor of the indices") != std::string::npos);
}

#endif
