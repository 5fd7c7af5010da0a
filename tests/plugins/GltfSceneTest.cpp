// GltfSceneTest.cpp - nodes, cameras, lights and scenes of glTF. Layer: tests.
// SPDX-License-Identifier: MIT
#include "GltfFiles.h"
#include "tests/Catch.h"

#include <osg/Camera>
#include <osg/FrontFace>
#include <osg/LightSource>
#include <osg/MatrixTransform>
#include <osg/ValueObject>

using namespace osgRayTrace::test;

namespace
{

/// Returns a point of the first mesh in the coordinates of the scene.
osg::Vec3d placed(osg::Node& scene, const osg::Vec3d& point)
{
    osg::Node& mesh = *findAll<osg::Geode>(scene).at(0);
    return point * osg::computeLocalToWorld(mesh.getParentalNodePaths().at(0));
}

void checkPoint(const osg::Vec3d& point, double x, double y, double z)
{
    CHECK(point.x() == Approx(x).margin(1e-6));
    CHECK(point.y() == Approx(y).margin(1e-6));
    CHECK(point.z() == Approx(z).margin(1e-6));
}

} // namespace

TEST_CASE("gltf: Y up becomes Z up, unless it shall not", "[gltf]")
{
    const Json model = triangleModel();
    checkPoint(placed(*sceneOf(model), {1, 2, 3}), 1, -3, 2);
    checkPoint(placed(*sceneOf(model, "noRotation"), {1, 2, 3}), 1, 2, 3);
}

TEST_CASE("gltf: transforms are matrices, or translation, rotation and scale", "[gltf]")
{
    Json model = triangleModel();
    model["nodes"][0]["translation"] = {10, 20, 30};
    model["nodes"][0]["rotation"] = {0, 0, 0.70710678, 0.70710678}; // a quarter turn around z
    model["nodes"][0]["scale"] = {1, 2, 3};
    checkPoint(placed(*sceneOf(model, "noRotation"), {1, 1, 1}), 8, 21, 33);

    model = triangleModel();
    model["nodes"][0]["matrix"] = {0, 1, 0, 0, -2, 0, 0, 0, 0, 0, 3, 0, 10, 20, 30, 1};
    checkPoint(placed(*sceneOf(model, "noRotation"), {1, 1, 1}), 8, 21, 33);
}

TEST_CASE("gltf: a mirrored node turns the winding, and a second one turns it back", "[gltf]")
{
    Json model = triangleModel();
    model["nodes"] = Json::parse(R"([{ "children": [1], "scale": [-1, 1, 1] },
                                     { "mesh": 0, "scale": [1, 1, -2] }])");
    const auto scene = sceneOf(model);
    const auto frontOf = [](const osg::Node& node)
    {
        const auto* face = dynamic_cast<const osg::FrontFace*>(
            node.getStateSet()->getAttribute(osg::StateAttribute::FRONTFACE));
        return face->getMode();
    };
    const auto transforms = findAll<osg::MatrixTransform>(*scene);
    REQUIRE(transforms.size() == 3); // the first turns Y up
    CHECK(frontOf(*transforms[1]) == osg::FrontFace::CLOCKWISE);
    CHECK(frontOf(*transforms[2]) == osg::FrontFace::COUNTER_CLOCKWISE);
}

TEST_CASE("gltf: nodes that share a mesh share its geometry", "[gltf]")
{
    Json model = triangleModel();
    model["nodes"] = Json::parse(R"([{ "name": "a", "mesh": 0 }, { "name": "b", "mesh": 0 }])");
    model["scenes"][0]["nodes"] = {0, 1};
    const auto scene = sceneOf(model);
    const auto geodes = findAll<osg::Geode>(*scene);
    REQUIRE(geodes.size() == 2);
    CHECK(geodes[0] == geodes[1]);
    CHECK(geodes[0]->getParent(0)->getName() == "a");
    CHECK(geodes[0]->getParent(1)->getName() == "b");
}

TEST_CASE("gltf: extras are user values", "[gltf]")
{
    Json model = triangleModel();
    model["nodes"][0]["extras"] =
        Json::parse(R"({ "kind": "chair", "legs": 4, "red": true, "sizes": [1, 2] })");
    const auto scene = sceneOf(model);
    const osg::Node& node = *findAll<osg::Geode>(*scene).at(0)->getParent(0);
    std::string kind, sizes;
    double legs = 0.0;
    bool red = false;
    CHECK((node.getUserValue("kind", kind) && kind == "chair"));
    CHECK((node.getUserValue("legs", legs) && legs == 4.0));
    CHECK((node.getUserValue("red", red) && red));
    CHECK((node.getUserValue("sizes", sizes) && sizes == "[1,2]"));
}

TEST_CASE("gltf: cameras draw nothing and have the file's projection", "[gltf]")
{
    Json model = triangleModel();
    model["cameras"] = Json::parse(R"([
        { "type": "perspective", "name": "lens",
          "perspective": { "yfov": 0.5, "aspectRatio": 2, "znear": 0.1, "zfar": 50 } },
        { "type": "orthographic", "orthographic": { "xmag": 2, "ymag": 1, "znear": 1, "zfar": 9 } }])");
    model["nodes"] = Json::parse(R"([{ "mesh": 0 }, { "camera": 0, "translation": [0, 0, 5] },
                                     { "camera": 1, "name": "above" }])");
    model["scenes"][0]["nodes"] = {0, 1, 2};
    const auto scene = sceneOf(model, "noRotation");
    const auto cameras = findAll<osg::Camera>(*scene);
    REQUIRE(cameras.size() == 2);
    CHECK(cameras[0]->getName() == "lens");
    CHECK(cameras[1]->getName() == "above");
    double fovy = 0, aspect = 0, near = 0, far = 0, left = 0, right = 0, bottom = 0, top = 0;
    REQUIRE(cameras[0]->getProjectionMatrixAsPerspective(fovy, aspect, near, far));
    CHECK(osg::DegreesToRadians(fovy) == Approx(0.5));
    CHECK(aspect == Approx(2.0));
    CHECK(near == Approx(0.1));
    CHECK(far == Approx(50.0));
    REQUIRE(cameras[1]->getProjectionMatrixAsOrtho(left, right, bottom, top, near, far));
    CHECK(right == Approx(2.0));
    CHECK(top == Approx(1.0));
    const osg::NodePath path = cameras[0]->getParentalNodePaths().at(0);
    CHECK(osg::computeLocalToWorld(path).getTrans() == osg::Vec3d(0, 0, 5));
    CHECK(cameras[0]->getNumChildren() == 0);
    CHECK(cameras[0]->getRenderOrder() == osg::Camera::NESTED_RENDER);

    model["cameras"][0]["perspective"]["yfov"] = 4;
    CHECK(refusalOf(model).find("cameras[0].perspective.yfov") != std::string::npos);
}

TEST_CASE("gltf: lights give the illuminance that the file says", "[gltf]")
{
    Json model = triangleModel();
    model["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([
        { "type": "directional", "intensity": 6.2831853, "color": [1, 0.5, 0] },
        { "type": "point", "intensity": 314.15927 },
        { "type": "spot", "spot": { "outerConeAngle": 0.5235988, "innerConeAngle": 0.5 } }])");
    model["nodes"] = Json::parse(R"([{ "mesh": 0 },
        { "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "extensions": { "KHR_lights_punctual": { "light": 1 } } },
        { "extensions": { "KHR_lights_punctual": { "light": 2 } } }])");
    model["scenes"][0]["nodes"] = {0, 1, 2, 3};
    const auto scene = sceneOf(model);
    const auto sources = findAll<osg::LightSource>(*scene);
    REQUIRE(sources.size() == 3);
    // 2 pi lux make a white surface as bright as 2 cd/m^2: an osg::Light of 2.
    const osg::Light& sun = *sources[0]->getLight();
    CHECK(sun.getDiffuse().r() == Approx(2.0f));
    CHECK(sun.getDiffuse().g() == Approx(1.0f));
    CHECK(sun.getPosition() == osg::Vec4(0, 0, 1, 0)); // where the light comes from
    const osg::Light& bulb = *sources[1]->getLight();
    const float distance = 5.0f;
    const float attenuation = bulb.getConstantAttenuation() +
                              bulb.getLinearAttenuation() * distance +
                              bulb.getQuadraticAttenuation() * distance * distance;
    CHECK(bulb.getDiffuse().r() / attenuation == Approx(100.0f / 25.0f));
    CHECK(sources[2]->getLight()->getSpotCutoff() == Approx(30.0f));
    for (const osg::LightSource* source : sources)
    {
        const int number = source->getLight()->getLightNum();
        CHECK(number > 0); // the viewer has light 0
        CHECK(scene->getStateSet()->getMode(GL_LIGHT0 + number) == osg::StateAttribute::ON);
    }
}

TEST_CASE("gltf: ranges of lights are kept for rays, and one line says so", "[gltf]")
{
    Json model = triangleModel();
    model["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::parse(R"([{ "type": "point" }, { "type": "point" }])");
    model["nodes"] = Json::parse(R"([{ "mesh": 0 },
        { "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "extensions": { "KHR_lights_punctual": { "light": 1 } } }])");
    model["scenes"][0]["nodes"] = {0, 1, 2};
    const auto linesOf = [&model]
    {
        const Listening listening;
        sceneOf(model);
        const std::string& text = listening.text();
        const std::size_t first = text.find("lights have a range");
        if (first == std::string::npos) return 0;
        return text.find("lights have a range", first + 1) == std::string::npos ? 1 : 2;
    };
    CHECK(linesOf() == 0);
    for (Json& light : model["extensions"]["KHR_lights_punctual"]["lights"])
        light["range"] = 3;
    CHECK(linesOf() == 1);
    const auto scene = sceneOf(model);
    for (const osg::LightSource* source : findAll<osg::LightSource>(*scene))
    {
        float range = 0.0f;
        CHECK(source->getLight()->getUserValue("osgRayTrace.range", range));
        CHECK(range == 3.0f);
    }
    model["extensions"]["KHR_lights_punctual"]["lights"][0]["range"] = 0;
    CHECK(readGltf(model.dump()).message().find("range: is not above 0") != std::string::npos);
}

TEST_CASE("gltf: instances of a node share its mesh", "[gltf]")
{
    Json model = triangleModel();
    const int places =
        addAccessor<float>(model, {1, 0, 0, 0, 2, 0, 0, 0, 3, 4, 4, 4}, kFloat, "VEC3", 4);
    model["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    model["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        places;
    const auto scene = sceneOf(model, "noRotation");
    osg::Geode& mesh = *findAll<osg::Geode>(*scene).at(0);
    REQUIRE(mesh.getNumParents() == 4);
    const osg::MatrixList matrices = mesh.getWorldMatrices();
    CHECK(matrices[3].getTrans() == osg::Vec3d(4, 4, 4));
}

TEST_CASE("gltf: the scene is the file's own, or the one that is asked for", "[gltf]")
{
    Json model = triangleModel();
    model["nodes"] = Json::parse(R"([{ "mesh": 0 }, { "name": "other", "mesh": 0 }])");
    model["scenes"] = Json::parse(R"([{ "nodes": [0] }, { "name": "second", "nodes": [0, 1] }])");
    CHECK(findAll<osg::Geode>(*sceneOf(model)).size() == 1);
    CHECK(findAll<osg::Geode>(*sceneOf(model, "scene=1")).size() == 2);
    CHECK(findAll<osg::Geode>(*sceneOf(model, "noRotation scene=second")).size() == 2);
    CHECK(refusalOf(model, "scene=third").find("scene=third") != std::string::npos);
    model["scene"] = 1;
    CHECK(findAll<osg::Geode>(*sceneOf(model)).size() == 2);
}
