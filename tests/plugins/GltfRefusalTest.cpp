// GltfRefusalTest.cpp - files that are damaged or mean harm are refused with their place. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "GltfFiles.h"
#include "TemporaryFolder.h"
#include "tests/Catch.h"

#include <osgDB/ReadFile>

#include <fstream>

using namespace osgRayTrace::test;

namespace
{

void checkRefusal(const Json& model, const std::string& part)
{
    const std::string refusal = refusalOf(model);
    INFO(refusal);
    CHECK(refusal.find(part) != std::string::npos);
}

std::string glb(std::uint32_t version, std::uint32_t length, const std::string& chunks)
{
    return bytesOf<std::uint32_t>({0x46546c67, version, length}) + chunks;
}

std::string chunk(std::uint32_t type, const std::string& bytes)
{
    return bytesOf<std::uint32_t>({static_cast<std::uint32_t>(bytes.size()), type}) + bytes;
}

constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;

} // namespace

TEST_CASE("gltf: the text must be glTF 2.0", "[gltf]")
{
    const auto refusal = [](const std::string& text) { return readGltf(text).message(); };
    CHECK(refusal("").find("JSON") != std::string::npos);
    CHECK(refusal("{\"asset\":\n}").find("line 2") != std::string::npos);
    CHECK(refusal("[]").find("no object") != std::string::npos);
    CHECK(refusal("{}").find("asset") != std::string::npos);
    CHECK(refusal(R"({"asset":{"version":"1.0"}})").find("asset.version") != std::string::npos);
    CHECK(refusal(R"({"asset":{"version":"2.0"},"x":1e999})").find("JSON") != std::string::npos);
    const std::string deep = std::string(100, '[') + std::string(100, ']');
    CHECK(refusal(R"({"asset":{"version":"2.0"},"x":)" + deep + "}").find("64 levels") !=
          std::string::npos);
}

TEST_CASE("gltf: the chunks of a .glb lie within it", "[gltf]")
{
    Json model = triangleModel();
    const std::string bytes = bytesOf<float>({0, 0, 0, 2, 0, 0, 0, 4, 0});
    model["buffers"][0].erase("uri");
    std::string text = model.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::string chunks = chunk(kJson, text) + chunk(kBinary, bytes);
    const auto length = static_cast<std::uint32_t>(12 + chunks.size());
    CHECK(readGltf(glb(2, length, chunks)).validNode());
    CHECK(readGltf(glb(2, length, chunk(kJson, text))).message().find("the file has") !=
          std::string::npos);
    CHECK(readGltf(glb(1, length, chunks)).message().find("glTF 1") != std::string::npos);
    CHECK(readGltf(glb(2, length, chunk(kBinary, bytes) + chunks)).message().find("first chunk") !=
          std::string::npos);
    const auto shorter = static_cast<std::uint32_t>(12 + 8 + text.size());
    CHECK(readGltf(glb(2, shorter, chunks)).message().find("buffers[0]") != std::string::npos);
    const std::string file = glb(2, length, chunks);
    for (std::size_t end = 0; end < file.size(); end += 7)
    {
        auto result = readGltf(file.substr(0, end));
        INFO(end);
        CHECK_FALSE(result.validNode());
        CHECK_FALSE(result.message().empty());
    }
}

TEST_CASE("gltf: URIs stay in the folder of the file", "[gltf]")
{
    const TemporaryFolder folder;
    std::ofstream(folder / "data.bin", std::ios::binary)
        << bytesOf<float>({0, 0, 0, 2, 0, 0, 0, 4, 0});
    const auto refusal = [&folder](const std::string& uri)
    {
        Json model = triangleModel();
        model["buffers"][0]["uri"] = uri;
        std::ofstream(folder / "model.gltf") << model.dump();
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
        auto result = gltfPlugin().readNode(folder / "model.gltf", options.get());
        return result.validNode() ? "" : result.message();
    };
    CHECK(refusal("data.bin").empty());
    CHECK(refusal("./data%2Ebin").empty());
    for (const char* uri : {"/etc/hostname", "../data.bin", "a/../../data.bin", "%2e%2e/data.bin",
                            "a/%2E%2E/../data.bin"})
        CHECK(refusal(uri).find("leaves the folder") != std::string::npos);
    for (const char* uri : {"file:///etc/hostname", "http://example.org/data.bin", "C:data.bin"})
        CHECK(refusal(uri).find("scheme") != std::string::npos);
    CHECK(refusal("..\\data.bin").find("backslash") != std::string::npos);
    CHECK(refusal("data%00.bin").find("control") != std::string::npos);
    CHECK(refusal("data%4").find("hexadecimal") != std::string::npos);
    CHECK(refusal("other.bin").find("buffers[0].uri: ") != std::string::npos);
    CHECK(refusal("other.bin").find("no such file") != std::string::npos);
    CHECK(refusal(".").find("is a directory") != std::string::npos);
    CHECK(refusal("data:application/octet-stream;base64,AAA*").find("base64") != std::string::npos);

    Json model = triangleModel();
    model["buffers"][0]["uri"] = "data.bin";
    checkRefusal(model, "buffers[0].uri: 'data.bin' is a file beside the model");
}

TEST_CASE("gltf: nodes are a tree, and not too deep", "[gltf]")
{
    const auto with = [](const char* nodes, const Json& roots)
    {
        Json model = triangleModel();
        model["nodes"] = Json::parse(nodes);
        model["scenes"][0]["nodes"] = roots;
        return model;
    };
    checkRefusal(with(R"([{ "children": [0] }])", Json::array()), "nodes[0]");
    checkRefusal(with(R"([{ "children": [1] }, { "children": [2] }, { "children": [1] }])", {0}),
                 "already below");
    checkRefusal(with(R"([{}, { "children": [2] }, { "children": [1] }])", {0}), "above itself");
    checkRefusal(with(R"([{ "children": [1] }, {}])", {0, 1}), "scenes[0].nodes[1]");
    checkRefusal(with(R"([{}])", {0, 0}), "again");
    checkRefusal(with(R"([{}])", {1}), "scenes[0].nodes[0]: is 1");

    const auto chain = [](int length)
    {
        Json model = triangleModel();
        model["nodes"] = Json::array();
        for (int i = 0; i < length; ++i)
            model["nodes"].push_back({{"children", {i + 1}}});
        model["nodes"].push_back({{"mesh", 0}});
        return model;
    };
    CHECK(refusalOf(chain(500)).empty());
    checkRefusal(chain(501), "more than 500");
}

TEST_CASE("gltf: extensions that are required and not known are refused by name", "[gltf]")
{
    Json model = triangleModel();
    model["extensionsUsed"] = {"EXT_unknown", "KHR_materials_unlit", "KHR_materials_dispersion",
                               "KHR_materials_anisotropy", "KHR_materials_iridescence"};
    model["extensionsRequired"] = {"KHR_materials_dispersion", "KHR_materials_anisotropy"};
    {
        const Listening listening;
        CHECK(refusalOf(model).empty());
        CHECK(listening.text().find("not read: EXT_unknown, KHR_materials_dispersion\n") !=
              std::string::npos);
    }
    model["extensionsRequired"] = {"KHR_materials_unlit", "EXT_unknown"};
    checkRefusal(model, "extensionsRequired[1]: 'EXT_unknown' is required");
}

TEST_CASE("gltf: what the file makes is in proportion to it", "[gltf]")
{
    // Each of these accessors is within the buffer, and each becomes arrays of its own.
    Json model = triangleModel();
    const int view = addView(model, std::string(1 << 20, '\0'));
    for (int i = 0; i < 400; ++i)
    {
        model["accessors"].push_back(
            {{"bufferView", view}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", 87381}});
        const int accessor = static_cast<int>(model["accessors"].size()) - 1;
        model["meshes"][0]["primitives"].push_back(
            {{"mode", 0}, {"attributes", {{"POSITION", accessor}}}});
    }
    checkRefusal(model, "out of proportion");
}

TEST_CASE("gltf: a large mesh without normals is in proportion to its file", "[gltf]")
{
    // It becomes three vertices of its own for each of 524,288 triangles, which have short indices:
    // a grid of 32,768, sixteen times.
    constexpr std::uint16_t kSide = 128, kRow = kSide + 1;
    constexpr int kTimes = 16;
    std::vector<float> positions;
    for (int i = 0; i < kRow * kRow; ++i)
        positions.insert(positions.end(),
                         {static_cast<float>(i % kRow), static_cast<float>(i / kRow), 0.0f});
    std::vector<std::uint16_t> corners;
    for (int k = 0; k < kTimes * kSide * kRow; ++k)
    {
        const auto i = static_cast<std::uint16_t>(k % (kSide * kRow));
        if (i % kRow == kSide) continue;
        for (const int corner : {0, 1, +kRow, 1, kRow + 1, +kRow})
            corners.push_back(static_cast<std::uint16_t>(i + corner));
    }
    Json model = triangleModel();
    attributesOf(model)["POSITION"] =
        addAccessor<float>(model, positions, kFloat, "VEC3", kRow * kRow);
    model["meshes"][0]["primitives"][0]["indices"] =
        addAccessor<std::uint16_t>(model, corners, kUnsignedShort, "SCALAR", corners.size());
    const auto scene = sceneOf(model);
    const auto& normals = arrayOf<osg::Vec3Array>(geometryOf(*scene).getNormalArray());
    CHECK(normals.size() == 6u * kTimes * kSide * kSide);
}
