// GltfAnimationTest.cpp - clips, skins and morph targets of glTF at given times. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfFiles.h"
#include "tests/Catch.h"

#include <osg/FrameStamp>
#include <osg/MatrixTransform>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/MorphGeometry>
#include <osgAnimation/RigGeometry>
#include <osgUtil/UpdateVisitor>

#include <set>

using namespace osgRayTrace::test;

namespace
{

/// Brings a scene to a time, as the update traversal of any viewer does.
void update(osg::Node& scene, double time)
{
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(time);
    const osg::ref_ptr<osgUtil::UpdateVisitor> visitor = new osgUtil::UpdateVisitor;
    visitor->setFrameStamp(stamp.get());
    scene.accept(*visitor);
}

/// Adds an animation of one channel of node 0.
void animate(Json& model, const std::string& path, const std::string& interpolation,
             const std::vector<float>& times, const std::vector<float>& values,
             const std::string& type)
{
    const std::size_t width = type == "VEC3" ? 3 : type == "VEC4" ? 4 : 1;
    const int input = addAccessor(model, times, kFloat, "SCALAR", times.size());
    const int output = addAccessor(model, values, kFloat, type, values.size() / width);
    model["animations"].push_back(
        {{"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}})},
         {"samplers",
          Json::array(
              {{{"input", input}, {"output", output}, {"interpolation", interpolation}}})}});
}

/// Returns the transform of node 0.
osg::Matrix firstMatrix(osg::Node& scene)
{
    return findAll<osg::MatrixTransform>(scene).at(1)->getMatrix();
}

void checkNear(const osg::Vec3d& value, double x, double y, double z)
{
    INFO(value.x() << " " << value.y() << " " << value.z());
    CHECK((value - osg::Vec3d(x, y, z)).length() < 1e-4);
}

} // namespace

TEST_CASE("gltf: translations step, go straight, or along a spline", "[gltf]")
{
    Json model = triangleModel();
    animate(model, "translation", "LINEAR", {0, 2, 4}, {0, 0, 0, 4, 0, 0, 4, 8, 0}, "VEC3");
    auto scene = sceneOf(model);
    update(*scene, 1.0);
    checkNear(firstMatrix(*scene).getTrans(), 2, 0, 0);
    update(*scene, 3.0);
    checkNear(firstMatrix(*scene).getTrans(), 4, 4, 0);
    update(*scene, 5.0); // the clip begins again
    checkNear(firstMatrix(*scene).getTrans(), 2, 0, 0);

    model = triangleModel();
    animate(model, "translation", "STEP", {0, 2, 4}, {0, 0, 0, 4, 0, 0, 4, 8, 0}, "VEC3");
    scene = sceneOf(model);
    update(*scene, 1.9);
    checkNear(firstMatrix(*scene).getTrans(), 0, 0, 0);
    update(*scene, 2.1);
    checkNear(firstMatrix(*scene).getTrans(), 4, 0, 0);

    // p(1/2) = p0 / 2 + d m0 / 8 + p1 / 2 - d m1 / 8 with d = 2, m0 = (0, 4, 0), m1 = (0, 0, 8).
    model = triangleModel();
    animate(model, "translation", "CUBICSPLINE", {0, 2},
            {9, 9, 9, 0, 0, 0, 0, 4, 0, 0, 0, 8, 6, 0, 0, 9, 9, 9}, "VEC3");
    scene = sceneOf(model);
    update(*scene, 1.0);
    checkNear(firstMatrix(*scene).getTrans(), 3, 1, -2);
}

TEST_CASE("gltf: a clip lasts from 0 to its last key", "[gltf]")
{
    Json model = triangleModel();
    animate(model, "translation", "LINEAR", {2, 4}, {1, 0, 0, 3, 0, 0}, "VEC3");
    const auto scene = sceneOf(model);
    update(*scene, 1.0);
    checkNear(firstMatrix(*scene).getTrans(), 1, 0, 0);
    update(*scene, 3.0);
    checkNear(firstMatrix(*scene).getTrans(), 2, 0, 0);
    update(*scene, 7.0);
    checkNear(firstMatrix(*scene).getTrans(), 2, 0, 0);
}

TEST_CASE("gltf: rotations take the shorter arc; those of splines are smooth", "[gltf]")
{
    const float h = 0.70710678f;
    Json model = triangleModel();
    model["nodes"][0]["scale"] = {2, 2, 2};
    // The second key is the quarter turn around z with the other sign.
    animate(model, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, -h, -h}, "VEC4");
    auto scene = sceneOf(model);
    update(*scene, 0.5);
    checkNear(osg::Vec3d(1, 0, 0) * firstMatrix(*scene), 2 * h, 2 * h, 0);

    model = triangleModel();
    animate(model, "rotation", "CUBICSPLINE", {0, 1},
            {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, h, h, 0, 0, 0, 0}, "VEC4");
    scene = sceneOf(model);
    update(*scene, 0.5);
    checkNear(osg::Vec3d(1, 0, 0) * firstMatrix(*scene), h, h, 0);
    // A quarter of the way: weights 27/32 and 5/32 of both ends.
    update(*scene, 0.25);
    const double z = 5.0 / 32 * h, w = 27.0 / 32 + 5.0 / 32 * h, angle = 2 * std::atan2(z, w);
    checkNear(osg::Vec3d(1, 0, 0) * firstMatrix(*scene), std::cos(angle), std::sin(angle), 0);
}

TEST_CASE("gltf: all clips are there, and the first one plays", "[gltf]")
{
    Json model = triangleModel();
    animate(model, "translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0}, "VEC3");
    animate(model, "translation", "LINEAR", {0, 1}, {0, 0, 0, 0, 1, 0}, "VEC3");
    model["animations"][1]["name"] = "up";
    const auto scene = sceneOf(model);
    auto* manager = dynamic_cast<osgAnimation::BasicAnimationManager*>(scene->getUpdateCallback());
    REQUIRE(manager);
    REQUIRE(manager->getAnimationList().size() == 2);
    update(*scene, 0.5);
    checkNear(firstMatrix(*scene).getTrans(), 0.5, 0, 0);
    manager->stopAll();
    manager->playAnimation(manager->getAnimationList()[1].get());
    update(*scene, 1.0);
    checkNear(firstMatrix(*scene).getTrans(), 0, 0.5, 0);
}

TEST_CASE("gltf: keys that fit no animation are refused", "[gltf]")
{
    const auto refusal = [](const std::vector<float>& times, const std::vector<float>& values,
                            const std::string& interpolation)
    {
        Json model = triangleModel();
        animate(model, "translation", interpolation, times, values, "VEC3");
        return refusalOf(model);
    };
    CHECK(refusal({0, 1}, {0, 0, 0, 1, 1, 1}, "LINEAR").empty());
    CHECK(refusal({0, 1}, {0, 0, 0}, "LINEAR").find("elements for 2 keys") != std::string::npos);
    CHECK(refusal({0, 1}, {0, 0, 0, 1, 1, 1}, "CUBICSPLINE").find("2 keys") != std::string::npos);
    CHECK(refusal({1, 0}, {0, 0, 0, 1, 1, 1}, "LINEAR").find("ascend") != std::string::npos);
    CHECK(refusal({-1, 0}, {0, 0, 0, 1, 1, 1}, "LINEAR").find("ascend") != std::string::npos);
    CHECK(refusal({}, {}, "LINEAR").find("no times") != std::string::npos);
    CHECK(refusal({0}, {0, 0, 0}, "ROUND").find("interpolation") != std::string::npos);
}

TEST_CASE("gltf: joints move vertices by their matrices, wherever the mesh's node is", "[gltf]")
{
    Json model = triangleModel();
    attributesOf(model)["JOINTS_0"] = addAccessor<std::uint8_t>(
        model, {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0}, kUnsignedByte, "VEC4", 3);
    attributesOf(model)["WEIGHTS_0"] =
        addAccessor<float>(model, {1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, kFloat, "VEC4", 3);
    const int matrices =
        addAccessor<float>(model, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1, //
                                   1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1},
                           kFloat, "MAT4", 2);
    model["nodes"] = Json::parse(R"([
        { "mesh": 0, "skin": 0, "translation": [100, 0, 0] },
        { "name": "root", "translation": [0, 0, 5], "children": [2] },
        { "name": "tip", "translation": [0, 2, 0] }])");
    model["scenes"][0]["nodes"] = {0, 1};
    model["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}};
    const float h = 0.70710678f;
    animate(model, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, h, h}, "VEC4");
    model["animations"][0]["channels"][0]["target"]["node"] = 2;

    const auto scene = sceneOf(model);
    osgAnimation::RigGeometry& rig = *findAll<osgAnimation::RigGeometry>(*scene).at(0);
    // The bound holds for the whole clip, before anything is updated.
    const osg::BoundingBox bound = rig.getBoundingBox();
    update(*scene, 0.0);
    update(*scene, 1.0 - 1e-6);
    const auto& positions = arrayOf<osg::Vec3Array>(rig.getVertexArray());
    checkNear(positions[1], 2, 0, 5);
    // (0, 4, 0) by the root: (0, 4, 5). By the tip: (0, 2, 0) turned to (-2, 0, 0), at (-2, 2, 5).
    checkNear(positions[2], -1, 3, 5);
    for (const osg::Vec3& position : positions)
        CHECK(bound.contains(position, 1e-3f));

    model["skins"][0]["joints"] = {1};
    CHECK(refusalOf(model).find("vertex 2 has joint 1") != std::string::npos);
    model["skins"][0]["joints"] = {1, 7};
    CHECK(refusalOf(model).find("skins[0].joints[1]") != std::string::npos);
    model["skins"][0]["joints"] = {1, 2, 0};
    CHECK(refusalOf(model).find("2 matrices for 3 joints") != std::string::npos);
}

TEST_CASE("gltf: two skins bind one joint in two places", "[gltf]")
{
    Json model = triangleModel();
    attributesOf(model)["JOINTS_0"] =
        addAccessor<std::uint8_t>(model, std::vector<std::uint8_t>(12), kUnsignedByte, "VEC4", 3);
    attributesOf(model)["WEIGHTS_0"] =
        addAccessor<float>(model, {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, kFloat, "VEC4", 3);
    const int moved = addAccessor<float>(model, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1},
                                         kFloat, "MAT4", 1);
    model["nodes"] = Json::parse(
        R"([{ "mesh": 0, "skin": 0 }, { "mesh": 0, "skin": 1 }, { "translation": [1, 0, 0] }])");
    model["scenes"][0]["nodes"] = {0, 1, 2};
    model["skins"] = {{{"joints", {2}}}, {{"joints", {2}}, {"inverseBindMatrices", moved}}};
    const auto scene = sceneOf(model);
    update(*scene, 0.0);
    update(*scene, 0.1);
    const auto rigs = findAll<osgAnimation::RigGeometry>(*scene);
    REQUIRE(rigs.size() == 2);
    checkNear(arrayOf<osg::Vec3Array>(rigs[0]->getVertexArray())[0], 1, 0, 0);
    checkNear(arrayOf<osg::Vec3Array>(rigs[1]->getVertexArray())[0], 1, 0, 7);
    // A vertex without weights stays with the first joint.
    checkNear(arrayOf<osg::Vec3Array>(rigs[1]->getVertexArray())[2], 1, 4, 7);
}

TEST_CASE("gltf: bones of equal names follow their own nodes", "[gltf]")
{
    Json model = triangleModel();
    attributesOf(model)["JOINTS_0"] =
        addAccessor<std::uint8_t>(model, std::vector<std::uint8_t>(12), kUnsignedByte, "VEC4", 3);
    attributesOf(model)["WEIGHTS_0"] =
        addAccessor<float>(model, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kFloat, "VEC4", 3);
    const int moved = addAccessor<float>(model, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1},
                                         kFloat, "MAT4", 1);
    // Node 1 becomes "Bone#1", and so would the second binding of node 0.
    model["nodes"] = Json::parse(R"([
        { "name": "Bone", "translation": [1, 0, 0] }, { "name": "Bone", "translation": [0, 50, 0] },
        { "mesh": 0, "skin": 0 }, { "mesh": 0, "skin": 1 }, { "mesh": 0, "skin": 2 }])");
    model["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
    model["skins"] = {
        {{"joints", {0}}}, {{"joints", {0}}, {"inverseBindMatrices", moved}}, {{"joints", {1}}}};
    auto scene = sceneOf(model);
    update(*scene, 0.0);
    update(*scene, 0.1);
    const auto rigs = findAll<osgAnimation::RigGeometry>(*scene);
    REQUIRE(rigs.size() == 3);
    checkNear(arrayOf<osg::Vec3Array>(rigs[0]->getVertexArray())[0], 1, 0, 0);
    checkNear(arrayOf<osg::Vec3Array>(rigs[1]->getVertexArray())[0], 1, 0, 7);
    checkNear(arrayOf<osg::Vec3Array>(rigs[2]->getVertexArray())[0], 0, 50, 0);

    // The first node has the name that the last one would get.
    model["nodes"] = Json::parse(R"([{ "name": "x#2" }, { "name": "x" }, { "name": "x" }])");
    model["scenes"][0]["nodes"] = {0, 1, 2};
    model["skins"] = {{{"joints", {0, 1, 2}}}};
    scene = sceneOf(model);
    std::set<std::string> names;
    for (const osgAnimation::Bone* bone : findAll<osgAnimation::Bone>(*scene))
        names.insert(bone->getName());
    CHECK(names == std::set<std::string>{"x", "x#2", "x#2#2"});
}

TEST_CASE("gltf: morph targets are added by their weights, which clips change", "[gltf]")
{
    Json model = triangleModel();
    attributesOf(model)["NORMAL"] =
        addAccessor<float>(model, {0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
    const int first = addAccessor<float>(model, {0, 0, 0, 0, 0, 2, 0, 0, 0}, kFloat, "VEC3", 3);
    const int second = addAccessor<float>(model, {0, 0, 0, 10, 0, 0, 0, 0, 0}, kFloat, "VEC3", 3);
    model["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", first}},
                                                      {{"POSITION", second}}};
    model["meshes"][0]["weights"] = {0.5, 0};
    auto scene = sceneOf(model);
    const auto positionOf = [&scene]() -> osg::Vec3d
    { return arrayOf<osg::Vec3Array>(geometryOf(*scene).getVertexArray())[1]; };
    checkNear(positionOf(), 2, 0, 1); // before any update
    model["nodes"][0]["weights"] = {0, 1};
    scene = sceneOf(model);
    checkNear(positionOf(), 12, 0, 0);

    animate(model, "weights", "LINEAR", {0, 1}, {0, 0, 1, 0.5f}, "SCALAR");
    scene = sceneOf(model);
    update(*scene, 0.5);
    checkNear(positionOf(), 2 + 2.5, 0, 1);
}

TEST_CASE("gltf: weights of morph targets may be below 0, at rest and in clips", "[gltf]")
{
    Json model = triangleModel();
    attributesOf(model)["NORMAL"] =
        addAccessor<float>(model, {0, 0, 1, 0, 0, 1, 0, 0, 1}, kFloat, "VEC3", 3);
    const int moves = addAccessor<float>(model, {0, 0, 0, 0, 0, 2, 0, 0, 0}, kFloat, "VEC3", 3);
    const int turns = addAccessor<float>(model, {0, 0, 0, 1, 0, 0, 0, 0, 0}, kFloat, "VEC3", 3);
    model["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", moves}, {"NORMAL", turns}}};
    model["meshes"][0]["weights"] = {-0.5};
    auto scene = sceneOf(model);
    const auto positionOf = [&scene]() -> osg::Vec3d
    { return arrayOf<osg::Vec3Array>(geometryOf(*scene).getVertexArray())[1]; };
    const auto normalOf = [&scene]() -> osg::Vec3d
    { return arrayOf<osg::Vec3Array>(geometryOf(*scene).getNormalArray())[1]; };
    checkNear(positionOf(), 2, 0, -1);
    const double length = std::sqrt(1.25);
    checkNear(normalOf(), -0.5 / length, 0, 1 / length);

    animate(model, "weights", "LINEAR", {0, 1}, {1, -1}, "SCALAR");
    scene = sceneOf(model);
    update(*scene, 0.25);
    checkNear(positionOf(), 2, 0, 1);
    update(*scene, 0.75);
    checkNear(positionOf(), 2, 0, -1);

    // A spline whose keys are 0 swings below: at 1/4 by its tangent -1, t (1 - t)^2 of it.
    model["animations"] = Json::array();
    animate(model, "weights", "CUBICSPLINE", {0, 1}, {0, 0, -1, 0, 0, 0}, "SCALAR");
    model["meshes"][0]["weights"] = {0};
    scene = sceneOf(model);
    update(*scene, 0.25);
    checkNear(positionOf(), 2, 0, -2 * 0.25 * 0.75 * 0.75);
}
