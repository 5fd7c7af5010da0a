// GltfFuzzTest.cpp - damaged glTF files give a scene or an error with a message, and take memory
// within reason. Layer: tests.
// SPDX-License-Identifier: MIT
#include "CountedMemory.h"
#include "FuzzSeeds.h"
#include "tests/Catch.h"
#include "tests/plugins/GltfCompression.h"

#include <osg/ComputeBoundsVisitor>
#include <osg/FrameStamp>
#include <osg/TriangleIndexFunctor>
#include <osgUtil/UpdateVisitor>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace osgRayTrace::test;

namespace
{

constexpr int kFiles = 20000;          ///< seeds
constexpr int kSanitizedFiles = 10000; ///< seeds under a sanitizer

/// What a small file may make, 64 MiB, is held in a few forms for a while.
constexpr std::size_t kMostBytes = std::size_t(400) << 20;

/// Returns a model that uses most of what is read: interleaved, sparse, normalized and integer
/// accessors, a skin, morph targets, animations, a camera, a light, instances and textures.
Json anyModel(Dice& dice)
{
    Json model = triangleModel();
    const int uv = addAccessor<std::uint16_t>(model, {0, 0, 9, 9, 1, 2}, kUnsignedShort, "VEC2", 3);
    const int joints = addAccessor<std::uint8_t>(model, std::vector<std::uint8_t>(12, 1),
                                                 kUnsignedByte, "VEC4", 3);
    const int four = addAccessor<float>(model, std::vector<float>(12, 0.5f), kFloat, "VEC4", 3);
    const int indices =
        addAccessor<std::uint16_t>(model, {0, 1, 2, 2, 1, 0}, kUnsignedShort, "SCALAR", 6);
    const int times = addAccessor<float>(model, {0, 1, 2}, kFloat, "SCALAR", 3);
    const int weights = addAccessor<float>(model, {0, 1, 0}, kFloat, "SCALAR", 3);
    const int spline = addAccessor<float>(model, std::vector<float>(27, 0.5f), kFloat, "VEC3", 9);
    const int matrices =
        addAccessor<float>(model, std::vector<float>(32, 0.25f), kFloat, "MAT4", 2);
    Json& first = model["meshes"][0]["primitives"][0];
    first["mode"] = dice.below(7);
    first["material"] = 0;
    if (dice.oneIn(2)) first["indices"] = indices;
    if (dice.oneIn(2)) first["attributes"]["NORMAL"] = 0;
    if (dice.oneIn(2)) first["attributes"]["TEXCOORD_0"] = uv;
    if (dice.oneIn(2)) first["attributes"]["COLOR_0"] = four;
    if (dice.oneIn(2)) first["targets"] = {{{"POSITION", 0}}};
    first["attributes"]["JOINTS_0"] = joints;
    first["attributes"]["WEIGHTS_0"] = four;
    model["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}};
    model["nodes"] = Json::parse(R"([
        { "mesh": 0, "children": [1], "rotation": [0, 0, 0, 1] }, { "children": [2, 3] },
        { "camera": 0, "scale": [1, -1, 1] }, { "mesh": 0, "weights": [0.5],
          "extensions": { "KHR_lights_punctual": { "light": 0 } } } ])");
    if (dice.oneIn(2)) model["nodes"][0]["skin"] = 0;
    if (dice.oneIn(2))
        model["nodes"][3]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
            {"TRANSLATION", 0}, {"ROTATION", four}};
    model["cameras"] = Json::parse(
        R"([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 0.1, "zfar": 9 } }])");
    model["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::parse(R"([{ "type": "spot", "spot": { "outerConeAngle": 0.5 } }])");
    model["animations"] = Json::parse(R"([{ "channels": [
        { "sampler": 0, "target": { "node": 3, "path": "weights" } },
        { "sampler": 1, "target": { "node": 1, "path": "translation" } },
        { "sampler": 2, "target": { "node": 2, "path": "rotation" } }],
        "samplers": [{}, { "interpolation": "CUBICSPLINE" }, { "interpolation": "STEP" }] }])");
    Json& samplers = model["animations"][0]["samplers"];
    const int outputs[] = {weights, spline, four};
    for (std::size_t i = 0; i < 3; ++i)
    {
        samplers[i]["input"] = times;
        samplers[i]["output"] = outputs[i];
    }
    model["materials"] = Json::parse(R"([{ "pbrMetallicRoughness": { "baseColorTexture":
        { "index": 0, "extensions": { "KHR_texture_transform": { "scale": [2, 2] } } } },
        "alphaMode": "BLEND", "extensions": { "KHR_materials_volume": { "thicknessFactor": 1 } } }])");
    model["textures"] = Json::parse(R"([{ "source": 0, "sampler": 0 }])");
    model["samplers"] = Json::parse(R"([{ "wrapS": 33071, "minFilter": 9987 }])");
    model["images"] =
        Json::parse(R"([{ "uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUg==" }])");
    return model;
}

#if defined(OSGRAYTRACE_TEST_DRACO) || defined(OSGRAYTRACE_TEST_MESHOPT) ||                        \
    defined(OSGRAYTRACE_TEST_WEBP)
/// Damages compressed bytes, which a damaged base64 would hide, now and then.
std::string worn(std::string bytes, Dice& dice)
{
    for (int i = dice.oneIn(2) ? 1 + dice.below(3) : 0; i > 0 && !bytes.empty(); --i)
        damageBytes(bytes, dice.below(kDamages), dice);
    return bytes;
}
#endif

/// Returns a model whose mesh, or whose image, is compressed; a plain one if no library is there.
Json anyCompressedModel(Dice& dice)
{
    const Grid grid = gridOf(1 + dice.below(6));
    Json model = plainModel(grid);
    switch (dice.below(3))
    {
#ifdef OSGRAYTRACE_TEST_DRACO
    case 0:
    {
        const DracoStyle style{4 + dice.below(10), !dice.oneIn(3), dice.below(11), dice.oneIn(4)};
        model = dracoModel(grid, worn(dracoBytes(grid, style), dice));
        if (dice.oneIn(3)) model["meshes"][0]["primitives"][0]["mode"] = 5;
        return model;
    }
#endif
#ifdef OSGRAYTRACE_TEST_MESHOPT
    case 1:
    {
        const char* const kModes[] = {"ATTRIBUTES", "TRIANGLES", "INDICES"};
        const char* const kFilters[] = {"", "NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
        model = meshoptModel(grid, dice.oneIn(2));
        const std::string bytes =
            worn(meshoptVertices(grid.positions.data(), grid.count(), 12), dice);
        const int view =
            addMeshoptView(model, bytes, grid.count(), dice.oneIn(3) ? 8 : 12,
                           dice.oneIn(3) ? dice.oneOf(kModes) : kModes[0], dice.oneOf(kFilters));
        model["accessors"][attributesOf(model)["POSITION"].get<std::size_t>()]["bufferView"] = view;
        return model;
    }
#endif
#ifdef OSGRAYTRACE_TEST_WEBP
    case 2:
    {
        const std::string bytes =
            worn(webpBytes(std::vector<unsigned char>(4 * 9 * 9, 200), 9, 9), dice);
        model["textures"] =
            Json::parse(R"([{ "extensions": { "EXT_texture_webp": { "source": 0 } } }])");
        model["images"] = {{{"uri", "data:;base64," + base64(bytes)}}};
        model["materials"] =
            Json::parse(R"([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }])");
        model["meshes"][0]["primitives"][0]["material"] = 0;
        return model;
    }
#endif
    default:
        return model;
    }
}

/// Returns some value of a tree, by a random walk.
Json& anyValue(Json& value, Dice& dice)
{
    Json* at = &value;
    while (at->is_structured() && !at->empty() && !dice.oneIn(12))
    {
        auto child = at->begin();
        std::advance(child, dice.below(static_cast<int>(at->size())));
        at = &*child;
    }
    return *at;
}

/// Puts another value somewhere: numbers at the edges, other kinds, nothing.
void damageTree(Json& model, Dice& dice)
{
    const double kNumbers[] = {0,          1,
                               2,          3,
                               4,          5,
                               -1,         0.5,
                               12,         255,
                               65535,      65536,
                               1e6,        1e9,
                               1e15,       1e300,
                               -1e9,       5120,
                               4294967296, 2147483647.,
                               5126.0,     9007199254740992.,
                               7,          16};
    Json& value = anyValue(model, dice);
    switch (dice.below(7))
    {
    case 0:
        value = Json();
        return;
    case 1:
        value = Json::array();
        return;
    case 2:
        value = dice.oneIn(2) ? Json("MAT4") : Json("../x%2");
        return;
    case 3:
        value = anyValue(model, dice);
        return;
    default:
        value = dice.oneOf(kNumbers);
        if (value.get<double>() == std::floor(value.get<double>()) &&
            std::fabs(value.get<double>()) < 1e16)
            value = static_cast<std::int64_t>(value.get<double>());
    }
}

std::string glbOf(const Json& model)
{
    std::string text = model.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto size = static_cast<std::uint32_t>(text.size());
    return bytesOf<std::uint32_t>({0x46546c67, 2, size + 20, size, 0x4e4f534a}) + text;
}

/// Reads the smaller sample models, if they are there.
std::vector<std::string> sampleFiles()
{
    std::vector<std::string> files;
    const char* folder = std::getenv("OSGRAYTRACE_GLTF_MODELS");
    for (const char* name : {"Box", "BoxInterleaved", "RiggedSimple", "AnimatedMorphCube"})
    {
        const std::filesystem::path path =
            std::filesystem::path(folder ? folder : "") / name / (std::string(name) + ".glb");
        std::ifstream stream(path, std::ios::binary);
        std::string bytes{std::istreambuf_iterator<char>(stream), {}};
        if (!bytes.empty()) files.push_back(bytes);
    }
    return files;
}

std::string anyFile(const std::vector<std::string>& samples, Dice& dice)
{
    if (!samples.empty() && dice.oneIn(3))
    {
        std::string file =
            samples[static_cast<std::size_t>(dice.below(static_cast<int>(samples.size())))];
        for (int i = 1 + dice.below(3); i > 0 && !file.empty(); --i)
            damageBytes(file, dice.below(kDamages), dice);
        return file;
    }
    Json model = dice.oneIn(4) ? anyCompressedModel(dice) : anyModel(dice);
    for (int i = dice.below(4); i > 0; --i)
        damageTree(model, dice);
    std::string file = dice.oneIn(2) ? glbOf(model) : model.dump();
    for (int i = dice.oneIn(3) ? 2 : 0; i > 0 && !file.empty(); --i)
        damageBytes(file, dice.below(kDamages), dice);
    return file;
}

struct TouchCorners
{
    const osg::Vec3Array* positions = nullptr;
    double sum = 0.0;
    void operator()(unsigned int a, unsigned int b, unsigned int c)
    {
        for (const unsigned int corner : {a, b, c})
            sum += positions->at(corner).x();
    }
};

/// Does with a scene what a viewer does: updates it, and reads its triangles.
void use(osg::Node& scene)
{
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    const osg::ref_ptr<osgUtil::UpdateVisitor> update = new osgUtil::UpdateVisitor;
    update->setFrameStamp(stamp.get());
    for (const double time : {0.0, 0.7})
    {
        stamp->setSimulationTime(time);
        scene.accept(*update);
    }
    osg::ComputeBoundsVisitor bounds;
    scene.accept(bounds);
    for (osg::Geometry* geometry : findAll<osg::Geometry>(scene))
    {
        osg::TriangleIndexFunctor<TouchCorners> touch;
        touch.positions = &arrayOf<osg::Vec3Array>(geometry->getVertexArray());
        geometry->accept(touch);
    }
}

} // namespace

TEST_CASE("fuzz: a damaged glTF file gives an error or a scene, and no absurd allocation", "[fuzz]")
{
    osg::setNotifyLevel(osg::ALWAYS);
    gltfPlugin();
    const std::vector<std::string> samples = sampleFiles();
    int scenes = 0, errors = 0;
    const int files = sanitizerShare() > 1 ? kSanitizedFiles * sanitizerShare() : kFiles;
    forEachSeed(files,
                [&](uint32_t seed)
                {
                    Dice dice(seed);
                    const std::string file = anyFile(samples, dice);
                    takeMemoryPeak();
                    auto result = readGltf(file);
                    const MemoryPeak peak = takeMemoryPeak();
                    CAPTURE(peak.single, file.size());
                    REQUIRE(peak.total < kMostBytes);
                    if (!result.validNode())
                    {
                        ++errors;
                        REQUIRE(result.message().find("gltf: stream: ") == 0);
                        return;
                    }
                    ++scenes;
                    use(*result.getNode());
                });
    // The damage is neither always fatal nor never.
    CHECK(scenes > seedCount(files) / 8);
    CHECK(errors > seedCount(files) / 4);
}
