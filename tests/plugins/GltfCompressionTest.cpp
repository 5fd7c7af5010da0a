// GltfCompressionTest.cpp - compressed meshes are what they are uncompressed, and damaged
// ones are refused. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfCompression.h"
#include "tests/Catch.h"

#include <osg/TriangleIndexFunctor>

#include <algorithm>
#include <cmath>

using namespace osgRayTrace::test;

namespace
{

using Triangles = std::vector<std::array<unsigned int, 3>>;

struct CollectTriangles
{
    Triangles triangles;
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        triangles.push_back({a, b, c});
    }
};

[[maybe_unused]] Triangles trianglesOf(const osg::Geometry& geometry)
{
    osg::TriangleIndexFunctor<CollectTriangles> collect;
    geometry.accept(collect);
    return collect.triangles;
}

/// Returns the triangles in a fixed order, each from its smallest corner on, as seen from the
/// front.
[[maybe_unused]] Triangles sorted(Triangles triangles)
{
    for (auto& corners : triangles)
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// Reads a model that must be read, and holds it.
struct ReadModel
{
    explicit ReadModel(const Json& model) : scene(sceneOf(model)), geometry(&geometryOf(*scene)) {}

    const osg::Vec3Array& positions() const
    {
        return arrayOf<osg::Vec3Array>(geometry->getVertexArray());
    }
    const osg::Vec3Array& normals() const
    {
        return arrayOf<osg::Vec3Array>(geometry->getNormalArray());
    }
    const osg::Vec2Array& texcoords() const
    {
        return arrayOf<osg::Vec2Array>(geometry->getTexCoordArray(0));
    }

    osg::ref_ptr<osg::Node> scene;
    const osg::Geometry* geometry;
};

template <typename ArrayType> bool equal(const ArrayType& a, const ArrayType& b)
{
    return a.size() == b.size() &&
           std::memcmp(a.getDataPointer(), b.getDataPointer(), a.getTotalDataSize()) == 0;
}

[[maybe_unused]] void checkRefusal(const Json& model, const std::string& part)
{
    const std::string refusal = refusalOf(model);
    INFO(refusal << " has not " << part);
    CHECK(refusal.find(part) != std::string::npos);
}

/// Returns the triangle with one extension required.
Json requiring(const char* extension)
{
    Json model = triangleModel();
    model["extensionsUsed"] = model["extensionsRequired"] = {extension};
    return model;
}

} // namespace

TEST_CASE("gltf: an extension whose library is not there is refused by its name", "[gltf]")
{
#ifndef OSGRAYTRACE_TEST_DRACO
    checkRefusal(requiring("KHR_draco_mesh_compression"), "'KHR_draco_mesh_compression'");
#endif
#ifndef OSGRAYTRACE_TEST_MESHOPT
    checkRefusal(requiring("EXT_meshopt_compression"), "'EXT_meshopt_compression'");
#endif
#ifndef OSGRAYTRACE_TEST_WEBP
    checkRefusal(requiring("EXT_texture_webp"), "'EXT_texture_webp'");
#endif
    checkRefusal(requiring("KHR_texture_basisu"), "'KHR_texture_basisu'");
    Json optional = requiring("KHR_texture_basisu");
    optional.erase("extensionsRequired");
    const Listening listening;
    sceneOf(optional);
    CHECK(listening.text().find("not read: KHR_texture_basisu") != std::string::npos);
}

#ifdef OSGRAYTRACE_TEST_MESHOPT
TEST_CASE("gltf: buffers of meshoptimizer are those of the model, bit by bit", "[gltf]")
{
    const Grid grid = gridOf(40);
    const ReadModel plain(plainModel(grid));
    for (const bool triangles : {false, true})
    {
        INFO(triangles);
        const ReadModel read(meshoptModel(grid, triangles));
        CHECK(equal(read.positions(), plain.positions()));
        CHECK(equal(read.normals(), plain.normals()));
        CHECK(equal(read.texcoords(), plain.texcoords()));
        const Triangles ours = trianglesOf(*read.geometry), theirs = trianglesOf(*plain.geometry);
        // That encoder may begin a triangle with another corner.
        CHECK((triangles ? sorted(ours) == sorted(theirs) : ours == theirs));
    }
}

TEST_CASE("gltf: meshoptimizer's filters are undone", "[gltf]")
{
    // The encodings of the extension, by hand: octahedral (0.5, -0.25) in 7 bits, Z stores one.
    Json model = meshoptModel(gridOf(1), false);
    const auto setView = [&model](const std::string& name, int view, int type, bool normalized)
    {
        Json& accessor = model["accessors"][attributesOf(model)[name].get<std::size_t>()];
        accessor["bufferView"] = view;
        accessor["componentType"] = type;
        accessor["normalized"] = normalized;
    };
    std::vector<signed char> normals;
    for (int i = 0; i < 4; ++i)
        normals.insert(normals.end(), {64, -32, 127, 0});
    setView("NORMAL",
            addMeshoptView(model, meshoptVertices(normals.data(), 4, 4), 4, 4, "ATTRIBUTES",
                           "OCTAHEDRAL"),
            kByte, true);
    // Exponential: 8 bits of exponent above 24 of mantissa. 3 * 2^-2 and -5 * 2^1.
    std::vector<std::uint32_t> texcoords;
    for (int i = 0; i < 4; ++i)
        texcoords.insert(texcoords.end(), {0xfe000003u, 0x01fffffbu});
    setView("TEXCOORD_0",
            addMeshoptView(model, meshoptVertices(texcoords.data(), 4, 8), 4, 8, "ATTRIBUTES",
                           "EXPONENTIAL"),
            kFloat, false);
    const ReadModel read(model);
    osg::Vec3 expected(64.0f, -32.0f, 127.0f - 64.0f - 32.0f);
    expected.normalize();
    for (const osg::Vec3& normal : read.normals())
        CHECK((normal - expected).length() < 1.5f / 127.0f);
    for (const osg::Vec2& uv : read.texcoords())
        CHECK(uv == osg::Vec2(0.75f, 1.0f + 10.0f)); // v goes up
}

TEST_CASE("gltf: rotations of meshoptimizer's quaternions are those of the model", "[gltf]")
{
    Json model = triangleModel();
    model["extensionsUsed"] = {"EXT_meshopt_compression", "EXT_mesh_gpu_instancing"};
    // The largest component, here w, is left out: x, y and z in 15 bits over the square root of
    // 1/2.
    const double angle = 1.0;
    const auto y =
        static_cast<std::int16_t>(std::lround(std::sin(angle / 2) * std::sqrt(2.0) * 16383.0));
    const std::vector<std::int16_t> quaternion = {0, y, 0,
                                                  static_cast<std::int16_t>(16383 & ~3) | 3};
    const int view = addMeshoptView(model, meshoptVertices(quaternion.data(), 1, 8), 1, 8,
                                    "ATTRIBUTES", "QUATERNION");
    model["accessors"].push_back({{"bufferView", view},
                                  {"componentType", kShort},
                                  {"normalized", true},
                                  {"type", "VEC4"},
                                  {"count", 1}});
    model["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"ROTATION", 1}};
    const osg::ref_ptr<osg::Node> scene = sceneOf(model, "noRotation");
    const auto transforms = findAll<osg::MatrixTransform>(*scene);
    const osg::Quat read = transforms.back()->getMatrix().getRotate();
    CHECK(std::fabs(read.y()) == Approx(std::sin(angle / 2)).margin(2e-4));
    CHECK(std::fabs(read.w()) == Approx(std::cos(angle / 2)).margin(2e-4));
}

TEST_CASE("gltf: what meshoptimizer cannot have written is refused with its place", "[gltf]")
{
    const Json good = meshoptModel(gridOf(8), true);
    const std::string place = "bufferViews[" + std::to_string(good["bufferViews"].size() - 1) +
                              "].extensions.EXT_meshopt_compression";
    const auto with = [&good](const char* member, const Json& value)
    {
        Json model = good;
        model["bufferViews"].back()["extensions"]["EXT_meshopt_compression"][member] = value;
        return model;
    };
    CHECK(refusalOf(good).empty());
    checkRefusal(with("mode", "POINTS"), place + ".mode: is 'POINTS'");
    checkRefusal(with("filter", "EXPONENTIAL"), place + ".byteStride");
    checkRefusal(with("filter", "SHARP"), place + ".filter");
    checkRefusal(with("byteStride", 3), place + ".byteStride: is 3");
    checkRefusal(with("count", 385), place + ".count: is no multiple of 3");
    checkRefusal(with("count", 387), place + ".count: makes 1548 bytes");
    checkRefusal(with("count", 4294967296), place + ".count: is above 2^31");
    checkRefusal(with("byteLength", 9), place + ": is damaged");
    checkRefusal(with("byteLength", 1 << 20), place + ": ends at byte");
    checkRefusal(with("buffer", good["buffers"].size() - 1),
                 place + ".buffer: is a buffer without");
    Json bare = good;
    bare["bufferViews"].back().erase("extensions");
    checkRefusal(bare, ".buffer: is a buffer without bytes");
    Json large = with("count", 30000000);
    large["bufferViews"].back()["byteLength"] = 120000000;
    checkRefusal(large, "out of proportion");
}
#endif

#ifdef OSGRAYTRACE_TEST_DRACO
TEST_CASE("gltf: meshes of draco are those of the model, within their bits", "[gltf]")
{
    constexpr int kCells = 40, kBits = 14;
    const Grid grid = gridOf(kCells);
    const Triangles expected = sorted(trianglesOf(*ReadModel(plainModel(grid)).geometry));
    for (const DracoStyle& style :
         {DracoStyle{kBits, false}, DracoStyle{kBits, true}, DracoStyle{kBits, true, 0, true}})
    {
        INFO(style.edgebreaker << " " << style.speed);
        const ReadModel read(dracoModel(grid, dracoBytes(grid, style)));
        REQUIRE(read.positions().size() == grid.count());
        // A quantised value is half a step away at most; the positions' range is that of x.
        const float step = 1.0f / static_cast<float>((1 << kBits) - 1);
        std::vector<unsigned int> numbers;
        float position = 0.0f, normal = 0.0f, texcoord = 0.0f;
        for (std::size_t i = 0; i < grid.count(); ++i)
        {
            const osg::Vec3 at = read.positions()[i];
            const auto x = std::lround(at.x()), y = std::lround(at.y());
            const auto number = static_cast<std::size_t>(y * (kCells + 1) + x);
            REQUIRE(number < grid.count());
            numbers.push_back(static_cast<unsigned int>(number));
            for (unsigned int c = 0; c < 3; ++c)
            {
                position = std::max(position, std::fabs(at[c] - grid.positions[3 * number + c]));
                normal = std::max(normal,
                                  std::fabs(read.normals()[i][c] - grid.normals[3 * number + c]));
            }
            const float u = grid.texcoords[2 * number], v = grid.texcoords[2 * number + 1];
            texcoord = std::max(texcoord, std::fabs(read.texcoords()[i].x() - u));
            texcoord = std::max(texcoord, std::fabs(read.texcoords()[i].y() - (1.0f - v)));
        }
        CHECK(position < 0.51f * step * kCells);
        CHECK(texcoord < 0.51f * step);
        CHECK(normal < 4.0f * step); // on an octahedron, whose faces are stretched
        Triangles triangles = trianglesOf(*read.geometry);
        for (auto& corners : triangles)
            for (unsigned int& corner : corners)
                corner = numbers.at(corner);
        CHECK(sorted(triangles) == expected);
    }
}

TEST_CASE("gltf: accessors of a draco mesh take their own types, and other attributes stay",
          "[gltf]")
{
    const Grid grid = gridOf(3);
    Json model = dracoModel(grid, dracoBytes(grid, {12, false}));
    const auto indices = model["meshes"][0]["primitives"][0]["indices"].get<std::size_t>();
    model["accessors"][indices]["componentType"] = kUnsignedByte;
    attributesOf(model)["COLOR_0"] =
        addAccessor<std::uint8_t>(model, std::vector<std::uint8_t>(4 * grid.count(), 255),
                                  kUnsignedByte, "VEC4", grid.count());
    const ReadModel read(model);
    CHECK(dynamic_cast<const osg::DrawElementsUByte*>(read.geometry->getPrimitiveSet(0)));
    CHECK(read.geometry->getColorArray()->getNumElements() == grid.count());
}

TEST_CASE("gltf: what draco cannot have written is refused with its place", "[gltf]")
{
    const Grid grid = gridOf(8);
    for (const bool edgebreaker : {false, true})
    {
        INFO(edgebreaker);
        const std::string bytes = dracoBytes(grid, {11, edgebreaker});
        const Json good = dracoModel(grid, bytes);
        CHECK(refusalOf(good).empty());
        const std::string place =
            "primitives[0].extensions.KHR_draco_mesh_compression.bufferView: ";
        checkRefusal(dracoModel(grid, "DRACO"), place + "is damaged");
        checkRefusal(dracoModel(grid, bytes.substr(0, bytes.size() / 2)), place + "is damaged");
        checkRefusal(dracoModel(gridOf(9), bytes),
                     place + "has 128 triangles, and the indices 162");
        Json other = good;
        for (std::size_t i = 1; i < 4; ++i)
            other["accessors"][i]["count"] = 80;
        checkRefusal(other, place + "has 81 vertices, and the accessors 80");
        other = good;
        other["accessors"][1]["count"] = 80;
        checkRefusal(other, "is not that of the primitive's other attributes");
        const char* const kName = "KHR_draco_mesh_compression";
        const auto withNormal = [&](int id)
        {
            Json model = good;
            Json& primitive = model["meshes"][0]["primitives"][0];
            primitive["extensions"][kName]["attributes"]["NORMAL"] = id;
            return model;
        };
        checkRefusal(withNormal(7), place + "has no attribute 7");
        checkRefusal(withNormal(2), place + "has 2 components of attribute 2");
        other = good;
        Json second = good["meshes"][0]["primitives"][0];
        other["meshes"][0]["primitives"].push_back(second);
        CHECK(refusalOf(other).empty());
        second["extensions"][kName]["bufferView"] = addView(other, bytes);
        other["meshes"][0]["primitives"][1] = second;
        checkRefusal(other, "of another compressed attribute as well");
    }
}

TEST_CASE("gltf: a draco mesh of many triangles in few bytes takes no memory for them", "[gltf]")
{
    // "DRACO", version 2.2, a mesh by edgebreaker, no flags; then the traversal, 2^28 vertices and
    // faces, and no data. The accessors agree, and the file is small.
    const std::string many = "\x80\x80\x80\x80\x01"; // as the library writes 2^28, from the left
    const std::string bytes =
        std::string("DRACO\x02\x02\x01\x01\0\0", 11) + '\0' + many + many + std::string(40, '\0');
    Grid grid = gridOf(1);
    Json model = dracoModel(grid, bytes);
    checkRefusal(model, "triangles, and the indices 2");
    model["accessors"].back()["count"] = 3ull << 28;
    checkRefusal(model, "out of proportion");

    // The indices of 2^21 triangles would take 6 MiB, but draco's tables 320.
    const std::string fewer = "\x80\x80\x80\x01";
    const std::string others =
        std::string("DRACO\x02\x02\x01\x01\0\0", 11) + '\0' + fewer + fewer + std::string(40, '\0');
    model = dracoModel(grid, others);
    model["accessors"].back()["componentType"] = 5121;
    model["accessors"].back()["count"] = 3 << 21;
    checkRefusal(model, "would take memory out of proportion");
}

TEST_CASE("gltf: draco's orientations and metadata take no memory that is only said", "[gltf]")
{
    // The number of orientations, of four bytes, stands before the end of the texcoords. The
    // library would take 32 MB for this number of them, and a second to read them.
    const Grid grid = gridOf(20);
    const std::string good = dracoBytes(grid, {11, true, 0});
    bool isRefused = false;
    for (std::size_t at = good.size() - 60; at + 4 <= good.size() && !isRefused; ++at)
    {
        std::string many = good;
        many.replace(at, 4, std::string("\0\0\0\x10", 4));
        isRefused =
            refusalOf(dracoModel(grid, many)).find("out of proportion") != std::string::npos;
    }
    CHECK(isRefused);

    // Each node of the metadata says that it has 100 more below it.
    std::string nested = good.substr(0, 11);
    nested[10] = static_cast<char>(0x80); // the flag of metadata
    nested += std::string("\0\0\x64", 3);
    for (int i = 0; i < 100; ++i)
        nested += std::string("\0\0\x64", 3);
    checkRefusal(dracoModel(grid, nested + std::string(400, '\0')), "has metadata that are");
}
#endif
