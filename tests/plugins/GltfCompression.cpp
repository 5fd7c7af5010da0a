// GltfCompression.cpp - encodes by draco, meshoptimizer and libwebp. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfCompression.h"

#ifdef OSGRAYTRACE_TEST_DRACO
#include <draco/compression/encode.h>
#endif
#ifdef OSGRAYTRACE_TEST_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef OSGRAYTRACE_TEST_WEBP
#include <webp/encode.h>
#endif

#include <cmath>

namespace osgRayTrace::test
{

Grid gridOf(int cells)
{
    Grid grid;
    const int side = cells + 1;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
        {
            const float u = static_cast<float>(x) / static_cast<float>(cells);
            const float v = static_cast<float>(y) / static_cast<float>(cells);
            const float slope = 1.5f * std::cos(3.0f * u);
            const float length = std::sqrt(1.0f + slope * slope);
            const float height = 0.5f * static_cast<float>(cells) * std::sin(3.0f * u);
            for (const float value : {static_cast<float>(x), static_cast<float>(y), height})
                grid.positions.push_back(value);
            for (const float value : {-slope / length, 0.0f, 1.0f / length})
                grid.normals.push_back(value);
            grid.texcoords.push_back(u);
            grid.texcoords.push_back(v);
        }
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x)
        {
            const auto a = static_cast<std::uint32_t>(y * side + x);
            const auto b = a + static_cast<std::uint32_t>(side);
            grid.indices.insert(grid.indices.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
    return grid;
}

Json plainModel(const Grid& grid)
{
    Json model = triangleModel();
    const std::size_t count = grid.count();
    Json& attributes = attributesOf(model);
    attributes["POSITION"] = addAccessor(model, grid.positions, kFloat, "VEC3", count);
    attributesOf(model)["NORMAL"] = addAccessor(model, grid.normals, kFloat, "VEC3", count);
    attributesOf(model)["TEXCOORD_0"] = addAccessor(model, grid.texcoords, kFloat, "VEC2", count);
    model["meshes"][0]["primitives"][0]["indices"] =
        addAccessor(model, grid.indices, kUnsignedInt, "SCALAR", grid.indices.size());
    return model;
}

#ifdef OSGRAYTRACE_TEST_DRACO
namespace
{

void addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, std::int8_t components,
                  const std::vector<float>& values)
{
    draco::GeometryAttribute layout;
    layout.Init(type, nullptr, components, draco::DT_FLOAT32, false,
                std::int64_t(sizeof(float)) * components, 0);
    const int id = mesh.AddAttribute(layout, true, mesh.num_points());
    for (std::uint32_t i = 0; i < mesh.num_points(); ++i)
        mesh.attribute(id)->SetAttributeValue(
            draco::AttributeValueIndex(i),
            values.data() + std::size_t(i) * static_cast<std::size_t>(components));
}

/// Adds an entry and a node with an entry below it, and as much for the positions.
void addMetadata(draco::Mesh& mesh)
{
    auto ofMesh = std::make_unique<draco::GeometryMetadata>();
    auto below = std::make_unique<draco::Metadata>();
    below->AddEntryString("author", "nobody");
    ofMesh->AddEntryInt("version", 3);
    ofMesh->AddSubMetadata("more", std::move(below));
    mesh.AddMetadata(std::move(ofMesh));
    auto ofPositions = std::make_unique<draco::AttributeMetadata>();
    ofPositions->AddEntryString("name", "position");
    mesh.AddAttributeMetadata(0, std::move(ofPositions));
}

} // namespace

std::string dracoBytes(const Grid& grid, const DracoStyle& style)
{
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(grid.count()));
    addAttribute(mesh, draco::GeometryAttribute::POSITION, 3, grid.positions);
    addAttribute(mesh, draco::GeometryAttribute::NORMAL, 3, grid.normals);
    addAttribute(mesh, draco::GeometryAttribute::TEX_COORD, 2, grid.texcoords);
    for (std::size_t i = 0; i + 2 < grid.indices.size(); i += 3)
        mesh.AddFace({draco::PointIndex(grid.indices[i]), draco::PointIndex(grid.indices[i + 1]),
                      draco::PointIndex(grid.indices[i + 2])});
    if (style.metadata) addMetadata(mesh);
    draco::Encoder encoder;
    encoder.SetSpeedOptions(style.speed, style.speed);
    encoder.SetEncodingMethod(style.edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                                : draco::MESH_SEQUENTIAL_ENCODING);
    for (const auto type : {draco::GeometryAttribute::POSITION, draco::GeometryAttribute::NORMAL,
                            draco::GeometryAttribute::TEX_COORD})
        encoder.SetAttributeQuantization(type, style.bits);
    draco::EncoderBuffer bytes;
    const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &bytes);
    if (!status.ok()) throw std::runtime_error(status.error_msg_string());
    return std::string(bytes.data(), bytes.size());
}

Json dracoModel(const Grid& grid, const std::string& bytes)
{
    Json model = triangleModel();
    model["extensionsUsed"] = model["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const auto add = [&model](int type, const char* kind, std::size_t count)
    {
        model["accessors"].push_back({{"componentType", type}, {"type", kind}, {"count", count}});
        return static_cast<int>(model["accessors"].size()) - 1;
    };
    const int view = addView(model, bytes);
    Json& primitive = model["meshes"][0]["primitives"][0];
    primitive["attributes"]["POSITION"] = add(kFloat, "VEC3", grid.count());
    primitive["attributes"]["NORMAL"] = add(kFloat, "VEC3", grid.count());
    primitive["attributes"]["TEXCOORD_0"] = add(kFloat, "VEC2", grid.count());
    primitive["indices"] = add(kUnsignedInt, "SCALAR", grid.indices.size());
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}};
    return model;
}
#endif

#ifdef OSGRAYTRACE_TEST_MESHOPT
namespace
{

std::string bytesFrom(const std::vector<unsigned char>& buffer, std::size_t size)
{
    return std::string(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size));
}

} // namespace

std::string meshoptVertices(const void* vertices, std::size_t count, std::size_t stride)
{
    std::vector<unsigned char> buffer(meshopt_encodeVertexBufferBound(count, stride));
    return bytesFrom(
        buffer, meshopt_encodeVertexBuffer(buffer.data(), buffer.size(), vertices, count, stride));
}

std::string meshoptTriangles(const std::vector<std::uint32_t>& indices, std::size_t vertices)
{
    std::vector<unsigned char> buffer(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    return bytesFrom(buffer, meshopt_encodeIndexBuffer(buffer.data(), buffer.size(), indices.data(),
                                                       indices.size()));
}

std::string meshoptSequence(const std::vector<std::uint32_t>& indices, std::size_t vertices)
{
    std::vector<unsigned char> buffer(meshopt_encodeIndexSequenceBound(indices.size(), vertices));
    return bytesFrom(buffer, meshopt_encodeIndexSequence(buffer.data(), buffer.size(),
                                                         indices.data(), indices.size()));
}

int addMeshoptView(Json& model, const std::string& compressed, std::size_t count,
                   std::size_t stride, const std::string& mode, const std::string& filter)
{
    const auto buffer = static_cast<int>(model["buffers"].size());
    model["buffers"].push_back(
        {{"byteLength", compressed.size()},
         {"uri", "data:application/octet-stream;base64," + base64(compressed)}});
    model["buffers"].push_back(
        {{"byteLength", count * stride},
         {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    Json extension = {{"buffer", buffer},
                      {"byteLength", compressed.size()},
                      {"byteStride", stride},
                      {"count", count},
                      {"mode", mode}};
    if (!filter.empty()) extension["filter"] = filter;
    Json view = {{"buffer", buffer + 1}, {"byteLength", count * stride}};
    if (mode == "ATTRIBUTES") view["byteStride"] = stride;
    view["extensions"]["EXT_meshopt_compression"] = extension;
    model["bufferViews"].push_back(view);
    return static_cast<int>(model["bufferViews"].size()) - 1;
}

Json meshoptModel(const Grid& grid, bool triangles)
{
    Json model = plainModel(grid);
    model["extensionsUsed"] = model["extensionsRequired"] = {"EXT_meshopt_compression"};
    const std::size_t count = grid.count();
    const auto compress = [&](const char* name, const std::vector<float>& values)
    {
        const std::size_t stride = values.size() / count * sizeof(float);
        const int view = addMeshoptView(model, meshoptVertices(values.data(), count, stride), count,
                                        stride, "ATTRIBUTES");
        model["accessors"][attributesOf(model)[name].get<std::size_t>()]["bufferView"] = view;
    };
    compress("POSITION", grid.positions);
    compress("NORMAL", grid.normals);
    compress("TEXCOORD_0", grid.texcoords);
    const std::string bytes =
        triangles ? meshoptTriangles(grid.indices, count) : meshoptSequence(grid.indices, count);
    const int view = addMeshoptView(model, bytes, grid.indices.size(), sizeof(std::uint32_t),
                                    triangles ? "TRIANGLES" : "INDICES");
    const auto indices = model["meshes"][0]["primitives"][0]["indices"].get<std::size_t>();
    model["accessors"][indices]["bufferView"] = view;
    return model;
}
#endif

#ifdef OSGRAYTRACE_TEST_WEBP
std::string webpBytes(const std::vector<unsigned char>& rgba, int width, int height)
{
    std::uint8_t* bytes = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), width, height, 4 * width, &bytes);
    const std::string result(reinterpret_cast<const char*>(bytes), size);
    WebPFree(bytes);
    return result;
}
#endif

} // namespace osgRayTrace::test
