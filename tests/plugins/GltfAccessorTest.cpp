// GltfAccessorTest.cpp - what accessors mean, and which of them are refused. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfFiles.h"
#include "tests/Catch.h"

using namespace osgRayTrace::test;

namespace
{

bool contains(const std::string& text, const std::string& part)
{
    INFO(text);
    return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("gltf: positions are the accessor's, and triangles without normals are flat", "[gltf]")
{
    const auto scene = sceneOf(triangleModel());
    const osg::Geometry& geometry = geometryOf(*scene);
    const auto& positions = arrayOf<osg::Vec3Array>(geometry.getVertexArray());
    REQUIRE(positions.size() == 3);
    CHECK(positions[1] == osg::Vec3(2, 0, 0));
    CHECK(positions[2] == osg::Vec3(0, 4, 0));
    const auto& normals = arrayOf<osg::Vec3Array>(geometry.getNormalArray());
    for (const osg::Vec3& normal : normals)
        CHECK(normal == osg::Vec3(0, 0, 1));
}

TEST_CASE("gltf: integers are normalized, by their type", "[gltf]")
{
    Json model = triangleModel();
    const int uv = addAccessor<std::uint16_t>(model, {0, 0, 65535, 0, 13107, 65535}, kUnsignedShort,
                                              "VEC2", 3);
    model["accessors"][uv]["normalized"] = true;
    attributesOf(model)["TEXCOORD_0"] = uv;
    const int normals =
        addAccessor<std::int8_t>(model, {0, 0, 127, 0, -128, 0, -127, 0, 0}, kByte, "VEC3", 3);
    model["accessors"][normals]["normalized"] = true;
    attributesOf(model)["NORMAL"] = normals;
    const auto scene = sceneOf(model);
    const osg::Geometry& geometry = geometryOf(*scene);
    const auto& texcoords = arrayOf<osg::Vec2Array>(geometry.getTexCoordArray(0));
    CHECK(texcoords[0] == osg::Vec2(0, 1)); // v goes up in OSG
    CHECK(texcoords[1] == osg::Vec2(1, 1));
    CHECK(texcoords[2].x() == Approx(0.2f));
    CHECK(texcoords[2].y() == Approx(0.0f));
    const auto& read = arrayOf<osg::Vec3Array>(geometry.getNormalArray());
    CHECK(read[0] == osg::Vec3(0, 0, 1));
    CHECK(read[1] == osg::Vec3(0, -1, 0)); // -128 ends at -1
    CHECK(read[2] == osg::Vec3(-1, 0, 0));
}

TEST_CASE("gltf: interleaved attributes are told apart", "[gltf]")
{
    Json model = triangleModel();
    const int view = addView(model, bytesOf<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, //
                                                    0, 1, 0, 1, 0, 0}));
    model["bufferViews"][view]["byteStride"] = 24;
    const Json accessor = {
        {"bufferView", view}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", 3}};
    Json second = accessor;
    second["byteOffset"] = 12;
    model["accessors"].push_back(accessor);
    model["accessors"].push_back(second);
    attributesOf(model) = {{"POSITION", 1}, {"NORMAL", 2}};
    const auto scene = sceneOf(model);
    const osg::Geometry& geometry = geometryOf(*scene);
    const auto& positions = arrayOf<osg::Vec3Array>(geometry.getVertexArray());
    const auto& normals = arrayOf<osg::Vec3Array>(geometry.getNormalArray());
    CHECK(positions[2] == osg::Vec3(0, 1, 0));
    CHECK(normals[0] == osg::Vec3(0, 0, 1));
    CHECK(normals[1] == osg::Vec3(0, 1, 0));
    CHECK(normals[2] == osg::Vec3(1, 0, 0));

    model["bufferViews"][view]["byteStride"] = 8;
    CHECK(contains(refusalOf(model), "stride of 8"));
}

TEST_CASE("gltf: a sparse accessor replaces elements, or begins with zeros", "[gltf]")
{
    Json model = triangleModel();
    const int indices = addView(model, bytesOf<std::uint8_t>({2}));
    const int values = addView(model, bytesOf<float>({7, 8, 9}));
    model["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
        {"values", {{"bufferView", values}}}};
    auto scene = sceneOf(model);
    const auto& replaced = arrayOf<osg::Vec3Array>(geometryOf(*scene).getVertexArray());
    CHECK(replaced[1] == osg::Vec3(2, 0, 0));
    CHECK(replaced[2] == osg::Vec3(7, 8, 9));

    model["accessors"][0].erase("bufferView");
    scene = sceneOf(model);
    const auto& zeros = arrayOf<osg::Vec3Array>(geometryOf(*scene).getVertexArray());
    CHECK(zeros[1] == osg::Vec3(0, 0, 0));
    CHECK(zeros[2] == osg::Vec3(7, 8, 9));

    model["accessors"][0]["sparse"]["count"] = 4;
    CHECK(contains(refusalOf(model), "accessors[0].sparse.count"));
    model["accessors"][0]["sparse"]["count"] = 1;
    model["accessors"][0]["count"] = 2;
    CHECK(contains(refusalOf(model), "accessors[0].sparse.indices: element 0 is 2"));
}

TEST_CASE("gltf: indices of all types, and none beyond the vertices", "[gltf]")
{
    for (const int type : {kUnsignedByte, kUnsignedShort, kUnsignedInt})
    {
        Json model = triangleModel();
        attributesOf(model)["NORMAL"] = 0;
        const int indices = type == kUnsignedByte
                                ? addAccessor<std::uint8_t>(model, {2, 1, 0}, type, "SCALAR", 3)
                            : type == kUnsignedShort
                                ? addAccessor<std::uint16_t>(model, {2, 1, 0}, type, "SCALAR", 3)
                                : addAccessor<std::uint32_t>(model, {2, 1, 0}, type, "SCALAR", 3);
        model["meshes"][0]["primitives"][0]["indices"] = indices;
        const auto scene = sceneOf(model);
        const osg::PrimitiveSet& primitives = *geometryOf(*scene).getPrimitiveSet(0);
        REQUIRE(primitives.getNumIndices() == 3);
        CHECK(primitives.index(0) == 2);
        CHECK(primitives.index(2) == 0);
    }
    Json model = triangleModel();
    const int indices = addAccessor<std::uint16_t>(model, {0, 1, 3}, kUnsignedShort, "SCALAR", 3);
    model["meshes"][0]["primitives"][0]["indices"] = indices;
    CHECK(contains(refusalOf(model), "accessors[1]: has the index 3, and there are 3 vertices"));
}

TEST_CASE("gltf: all modes of primitives; what is no whole primitive is left out", "[gltf]")
{
    for (int mode = 0; mode <= 6; ++mode)
    {
        Json model = triangleModel();
        attributesOf(model)["NORMAL"] = 0;
        model["meshes"][0]["primitives"][0]["mode"] = mode;
        const Listening listening;
        const auto scene = sceneOf(model);
        const osg::PrimitiveSet& primitives = *geometryOf(*scene).getPrimitiveSet(0);
        CHECK(primitives.getMode() == static_cast<GLenum>(mode));
        CHECK(primitives.getNumIndices() == (mode == GL_LINES ? 2u : 3u));
        CHECK(listening.text().empty() == (mode != GL_LINES));
    }
    Json model = triangleModel();
    model["meshes"][0]["primitives"][0]["mode"] = 7;
    CHECK(contains(refusalOf(model), "primitives[0].mode"));
}

TEST_CASE("gltf: elements outside their bytes are refused by name, before memory is taken",
          "[gltf]")
{
    const auto refusal = [](const char* array, const char* member, const Json& value)
    {
        Json model = triangleModel();
        model[array][0][member] = value;
        return refusalOf(model);
    };
    CHECK(contains(refusal("accessors", "count", 4), "accessors[0]: 4 elements end at byte 48"));
    CHECK(contains(refusal("accessors", "count", 4000000000000ll), "accessors[0].count"));
    CHECK(contains(refusal("accessors", "count", -1), "accessors[0].count"));
    CHECK(contains(refusal("accessors", "count", 1.5), "accessors[0].count"));
    CHECK(contains(refusal("accessors", "byteOffset", 4), "accessors[0]: 3 elements end"));
    CHECK(contains(refusal("accessors", "bufferView", 1), "accessors[0].bufferView: is 1"));
    CHECK(contains(refusal("accessors", "componentType", 5124), "no type of components"));
    CHECK(contains(refusal("accessors", "type", "VEC2"), "does not fit"));
    CHECK(contains(refusal("bufferViews", "byteOffset", 9007199254740990ll), "bufferViews[0]"));
    CHECK(contains(refusal("bufferViews", "byteLength", 37), "bufferViews[0]"));
    CHECK(contains(refusal("buffers", "byteLength", 37), "buffers[0].byteLength"));

    // Without bytes of its own, an accessor is limited by the size of the file.
    Json model = triangleModel();
    model["accessors"][0].erase("bufferView");
    model["accessors"][0]["count"] = 2000000000;
    CHECK(contains(refusalOf(model), "out of proportion"));
}

TEST_CASE("gltf: numbers that are not finite become 0, and are reported", "[gltf]")
{
    Json model = triangleModel();
    const float infinite = std::numeric_limits<float>::infinity();
    attributesOf(model)["POSITION"] = addAccessor<float>(
        model, {0, 0, 0, infinite, 0, 0, 0, std::nanf(""), 0}, kFloat, "VEC3", 3);
    const Listening listening;
    const auto scene = sceneOf(model);
    CHECK(arrayOf<osg::Vec3Array>(geometryOf(*scene).getVertexArray())[1] == osg::Vec3());
    CHECK(contains(listening.text(), "2 numbers are not finite"));
}
