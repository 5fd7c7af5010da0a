// GltfModelsTest.cpp - Khronos' sample models against their own accessors. OSGRAYTRACE_GLTF_MODELS
// leads to a folder of them. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfFiles.h"
#include "tests/Catch.h"

#include <osg/TriangleFunctor>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgDB/ReadFile>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <tuple>

using namespace osgRayTrace::test;

namespace
{

/// What a primitive has: its triangles and the bounds of its vertices, to be sorted.
struct Part
{
    std::size_t triangles = 0;
    std::array<float, 6> bounds{};

    bool operator<(const Part& other) const
    {
        return std::tie(triangles, bounds) < std::tie(other.triangles, other.bounds);
    }
};
using Parts = std::vector<Part>;

/// Returns the parts of a node of the file and of all below it, by their accessors.
void collect(const Json& model, std::size_t node, Parts& parts)
{
    const Json& place = model["nodes"][node];
    for (const Json& child : place.value("children", Json::array()))
        collect(model, child, parts);
    if (!place.contains("mesh")) return;
    for (const Json& primitive : model["meshes"][place["mesh"].get<std::size_t>()]["primitives"])
    {
        const Json& positions = model["accessors"][primitive["attributes"]["POSITION"].get<int>()];
        const bool indexed = primitive.contains("indices");
        const Json& elements =
            indexed ? model["accessors"][primitive["indices"].get<int>()] : positions;
        REQUIRE(primitive.value("mode", 4) == 4);
        Part part;
        part.triangles = elements["count"].get<std::size_t>() / 3;
        for (std::size_t i = 0; i < 3; ++i)
        {
            part.bounds[i] = positions["min"][i];
            part.bounds[i + 3] = positions["max"][i];
        }
        parts.push_back(part);
    }
}

Parts partsOf(const Json& model)
{
    Parts parts;
    for (const Json& root : model["scenes"][model.value("scene", 0)]["nodes"])
        collect(model, root, parts);
    std::sort(parts.begin(), parts.end());
    return parts;
}

struct CountTriangles
{
    std::size_t count = 0;
    void operator()(const osg::Vec3&, const osg::Vec3&, const osg::Vec3&, bool = false) { ++count; }
};

/// Returns the vertices of a geometry before skins and morph targets.
const osg::Vec3Array& restPositions(const osg::Geometry& geometry)
{
    const osg::Geometry* source = &geometry;
    if (const auto* rig = dynamic_cast<const osgAnimation::RigGeometry*>(source))
        source = rig->getSourceGeometry();
    if (const auto* morph = dynamic_cast<const osgAnimation::MorphGeometry*>(source))
        return *morph->getVertexSource();
    return arrayOf<osg::Vec3Array>(source->getVertexArray());
}

/// Returns the parts of a graph along all of its paths.
Parts partsOf(osg::Node& scene)
{
    Parts parts;
    for (osg::Geometry* geometry : findAll<osg::Geometry>(scene))
    {
        osg::TriangleFunctor<CountTriangles> triangles;
        geometry->accept(triangles);
        Part part;
        part.triangles = triangles.count;
        osg::BoundingBox box;
        for (const osg::Vec3& position : restPositions(*geometry))
            box.expandBy(position);
        part.bounds = {box.xMin(), box.yMin(), box.zMin(), box.xMax(), box.yMax(), box.zMax()};
        parts.push_back(part);
    }
    std::sort(parts.begin(), parts.end());
    return parts;
}

void checkParts(const Parts& read, const Parts& expected)
{
    REQUIRE(read.size() == expected.size());
    for (std::size_t i = 0; i < read.size(); ++i)
    {
        CHECK(read[i].triangles == expected[i].triangles);
        for (std::size_t c = 0; c < 6; ++c)
            CHECK(read[i].bounds[c] == Approx(expected[i].bounds[c]).margin(1e-4));
    }
}

} // namespace

TEST_CASE("gltf: sample models have the triangles and bounds of their accessors", "[gltf]")
{
    const char* folder = std::getenv("OSGRAYTRACE_GLTF_MODELS");
    if (!folder || !std::filesystem::is_directory(folder))
    {
        WARN("skipped: OSGRAYTRACE_GLTF_MODELS leads to no sample models");
        return;
    }
    int models = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
    {
        const std::string name = entry.path().filename().string();
        const std::filesystem::path text = entry.path() / "glTF" / (name + ".gltf");
        if (!std::filesystem::exists(text)) continue;
        ++models;
        INFO(name);
        const Json model = Json::parse(std::ifstream(text));
        const Parts expected = partsOf(model);
        REQUIRE_FALSE(expected.empty());
        const std::filesystem::path binary = entry.path() / (name + ".glb");
        for (const auto& file : {text, binary})
        {
            if (!std::filesystem::exists(file)) continue;
            INFO(file.string());
            const Listening listening;
            const osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(file.string());
            REQUIRE(scene);
            CHECK(listening.text().empty());
            checkParts(partsOf(*scene), expected);
        }
    }
    CHECK(models >= 26);
}
