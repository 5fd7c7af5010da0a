// LightsTest.cpp - osg::Light, the viewer's light, area lights and emitting geometry.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/TracedLight>

#include <osg/LightSource>
#include <osg/ValueObject>

#include <cmath>
#include <limits>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

constexpr auto kOn = osg::StateAttribute::ON;

/// Holds a triangle and lights; the given light numbers are enabled for the whole scene.
struct LitScene
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    ConversionInput input;
    SceneConverter converter;

    explicit LitScene(std::initializer_list<unsigned int> enabled = {0, 1})
    {
        root->addChild(triangleGeometry());
        for (const unsigned int number : enabled)
            root->getOrCreateStateSet()->setMode(GL_LIGHT0 + number, kOn);
        input.root = root;
    }

    osg::Light* add(int number, const osg::Matrixd& matrix = osg::Matrixd(),
                    osg::LightSource::ReferenceFrame frame = osg::LightSource::RELATIVE_RF)
    {
        osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->getLight()->setLightNum(number);
        source->setReferenceFrame(frame);
        osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
        transform->addChild(source);
        root->addChild(transform);
        return source->getLight();
    }

    std::vector<Light> lights() { return converter.convert(input).scene->lights; }
};

bool near(const Vec3& a, const Vec3& b)
{
    return glm::length(a - b) < 1e-5f;
}

Vec3 triangleNormal(const Mesh& mesh, std::size_t i)
{
    const UVec3& t = mesh.triangles[i];
    return glm::normalize(glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                     mesh.positions[t.z] - mesh.positions[t.x]));
}

} // namespace

TEST_CASE("directional light: travels away from its position, turned by transforms", "[bridge]")
{
    LitScene scene;
    osg::Light* light = scene.add(1, osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(0.0, 1.0, 0.0)) *
                                         osg::Matrixd::scale(2.0, 2.0, 2.0) *
                                         osg::Matrixd::translate(100.0, 0.0, 0.0));
    light->setPosition({0.0f, 0.0f, 2.0f, 0.0f});
    light->setAmbient({0.1f, 0.2f, 0.3f, 1.0f});
    light->setDiffuse({0.4f, 0.5f, 0.6f, 1.0f});
    light->setSpecular({0.7f, 0.8f, 0.9f, 1.0f});
    const auto lights = scene.lights();
    REQUIRE(lights.size() == 1);
    CHECK(lights[0].kind == LightKind::Directional);
    CHECK(lights[0].number == 1);
    CHECK_FALSE(lights[0].eyeSpace);
    CHECK(near(lights[0].direction, {-1.0f, 0.0f, 0.0f}));
    CHECK(lights[0].ambient == Vec3(0.1f, 0.2f, 0.3f));
    CHECK(lights[0].diffuse == Vec3(0.4f, 0.5f, 0.6f));
    CHECK(lights[0].specular == Vec3(0.7f, 0.8f, 0.9f));
}

TEST_CASE("point light: position relative to the origin, attenuation and spot terms", "[bridge]")
{
    LitScene scene;
    scene.input.origin.set(6.0e6, 0.0, 0.0);
    osg::Light* light = scene.add(1, osg::Matrixd::translate(6.0e6, 5.0, 0.0));
    light->setPosition({2.0f, 4.0f, 6.0f, 2.0f});
    light->setDirection({0.0f, -3.0f, 0.0f});
    light->setConstantAttenuation(0.5f);
    light->setLinearAttenuation(0.25f);
    light->setQuadraticAttenuation(0.125f);
    light->setSpotExponent(8.0f);
    light->setSpotCutoff(60.0f);
    auto lights = scene.lights();
    REQUIRE(lights.size() == 1);
    CHECK(lights[0].kind == LightKind::Point);
    CHECK(near(lights[0].position, {1.0f, 7.0f, 3.0f}));
    CHECK(near(lights[0].direction, {0.0f, -1.0f, 0.0f}));
    CHECK(lights[0].attenuationConstant == 0.5f);
    CHECK(lights[0].attenuationLinear == 0.25f);
    CHECK(lights[0].attenuationQuadratic == 0.125f);
    CHECK(lights[0].spotExponent == 8.0f);
    CHECK(lights[0].spotCosCutoff == Approx(0.5f));

    CHECK(lights[0].range == 0.0f);
    light->setUserValue("osgRayTrace.range", 3.0f);
    CHECK(scene.lights()[0].range == 3.0f);

    light->setSpotCutoff(180.0f);
    CHECK(scene.lights()[0].spotCosCutoff == -1.0f);
    light->setSpotCutoff(135.0f); // OpenGL has no such angle
    CHECK(scene.lights()[0].spotCosCutoff == -1.0f);

    light->setPosition({std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f, 1.0f});
    CHECK(scene.lights().empty());
    CHECK(countOf(scene.converter.convert(scene.input), "skipped.light") == 1);
}

TEST_CASE("traced lights: as many as there are, on all that is lit, whatever their numbers",
          "[bridge]")
{
    LitScene scene({1});
    for (int i = 0; i < 3; ++i)
    {
        osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->setLight(new TracedLight);
        CHECK(source->getStateSet()->getModeList().empty());
        source->getLight()->setLightNum(i == 2 ? 20000 : 1);
        source->getLight()->setPosition({float(i), 0.0f, 0.0f, 1.0f});
        scene.root->addChild(source);
    }
    scene.add(1)->setPosition({9.0f, 0.0f, 0.0f, 1.0f});
    scene.add(2); // no mode has enabled it
    const ConversionResult result = scene.converter.convert(scene.input);
    const std::vector<Light>& lights = result.scene->lights;
    REQUIRE(lights.size() == 4);
    CHECK(lights[0].number == 1);
    CHECK(lights[0].position.x == 9.0f);
    const Material& material = result.scene->materials[0];
    for (std::size_t i = 1; i < 4; ++i)
    {
        CHECK(lights[i].number == kNoLightNumber);
        CHECK(lights[i].position.x == float(i - 1));
        CHECK(isLightEnabled(material, lights[i].number));
    }
    CHECK_FALSE(isLightEnabled(material, 2));
    CHECK(countOf(result, "skipped.light") == 0);
    CHECK(countOf(result, "unused.light-replaced") == 0);
}

TEST_CASE("absolute light sources and the headlight are in eye space", "[bridge]")
{
    LitScene scene;
    scene.add(1, osg::Matrixd::translate(5.0, 0.0, 0.0), osg::LightSource::ABSOLUTE_RF)
        ->setPosition({1.0f, 2.0f, 3.0f, 1.0f});
    scene.input.origin.set(100.0, 0.0, 0.0);
    osg::ref_ptr<osg::Light> headlight = new osg::Light(0); // default: position (0, 0, 1, 0)
    scene.input.viewLight = headlight;
    auto lights = scene.lights();
    REQUIRE(lights.size() == 2);
    CHECK(lights[0].number == 0);
    CHECK(lights[0].eyeSpace);
    CHECK(lights[0].direction == Vec3(0.0f, 0.0f, -1.0f));
    CHECK(lights[1].eyeSpace);
    CHECK(lights[1].position == Vec3(1.0f, 2.0f, 3.0f));

    headlight->setPosition({101.0f, 0.0f, 0.0f, 1.0f});
    scene.input.viewLightInEyeSpace = false; // a sky light
    lights = scene.lights();
    CHECK_FALSE(lights[0].eyeSpace);
    CHECK(lights[0].position == Vec3(1.0f, 0.0f, 0.0f));
}

TEST_CASE("the headlight casts no shadows unless asked to, all other lights do", "[bridge]")
{
    LitScene scene;
    scene.add(1, osg::Matrixd(), osg::LightSource::ABSOLUTE_RF);
    scene.input.viewLight = new osg::Light(0);
    auto lights = scene.lights();
    REQUIRE(lights.size() == 2);
    CHECK_FALSE(lights[0].castsShadows);
    CHECK(lights[1].castsShadows); // a light of the application

    const ConversionSettings before = scene.input;
    scene.input.headlightShadows = true;
    CHECK_FALSE(static_cast<const ConversionSettings&>(scene.input) == before);
    CHECK(scene.lights()[0].castsShadows);

    scene.input.headlightShadows = false;
    scene.input.viewLightInEyeSpace = false;
    CHECK(scene.lights()[0].castsShadows); // a sky light

    scene.input.viewLightInEyeSpace = true;
    scene.add(0);
    CHECK(scene.lights()[0].castsShadows); // the light replaces the headlight
}

TEST_CASE("lights are kept by number: the last one in the graph replaces all before it", "[bridge]")
{
    LitScene scene;
    scene.input.viewLight = new osg::Light(0);
    scene.add(0)->setDiffuse({0.25f, 0.0f, 0.0f, 1.0f});
    scene.add(0)->setDiffuse({0.5f, 0.0f, 0.0f, 1.0f});
    const auto lights = scene.lights();
    REQUIRE(lights.size() == 1);
    CHECK(lights[0].diffuse.x == 0.5f);
    CHECK_FALSE(lights[0].eyeSpace);
    // The report counts the light of the graph that was replaced, but not the viewer's.
    CHECK(countOf(scene.converter.convert(scene.input), "unused.light-replaced") == 1);
}

TEST_CASE("lights are enabled for each surface by mode, wherever their source is", "[bridge]")
{
    LitScene scene({});
    scene.input.viewLight = new osg::Light(0);
    scene.add(1);
    scene.add(2);
    osg::ref_ptr<osg::Group> other = new osg::Group;
    other->addChild(triangleGeometry());
    other->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::OFF);
    other->getOrCreateStateSet()->setMode(GL_LIGHT1, kOn);
    scene.root->addChild(other);
    const ConversionResult result = scene.converter.convert(scene.input);
    const auto& instances = result.scene->instances;
    CHECK(result.scene->materials[instances[0].material].lightMask == 0x1);
    CHECK(result.scene->materials[instances[1].material].lightMask == 0x2);
    CHECK(result.scene->lights.size() == 2); // number 2 is not enabled
    CHECK(countOf(result, "converted.light") == 1);
    CHECK(countOf(result, "converted.headlight") == 1);
    // A light of the graph with the number of the viewer's light replaces the viewer's.
    scene.add(0);
    CHECK(countOf(scene.converter.convert(scene.input), "converted.light") == 2);
    CHECK(countOf(scene.converter.convert(scene.input), "converted.headlight") == 0);
    CHECK(countOf(scene.converter.convert(scene.input), "converted.sky-light") == 0);
}

TEST_CASE("lights of any number shine on what has their mode on", "[bridge]")
{
    constexpr int kHighest = 16383;
    LitScene scene({0, 1, 31, 32, 39, 40, 1000, kHighest});
    for (const int number : {0, 1, 31, 32, 39, 1000, kHighest, 33})
        scene.add(number);
    osg::ref_ptr<osg::Group> other = new osg::Group;
    other->addChild(triangleGeometry());
    other->getOrCreateStateSet()->setMode(GL_LIGHT0 + 39, osg::StateAttribute::OFF);
    scene.root->addChild(other);
    const ConversionResult result = scene.converter.convert(scene.input);
    std::vector<uint32_t> numbers;
    for (const Light& light : result.scene->lights)
        numbers.push_back(light.number);
    CHECK(numbers == std::vector<uint32_t>{0, 1, 31, 32, 39, 1000, kHighest}); // 33 is not enabled
    const auto materialOf = [&](std::size_t i)
    { return result.scene->materials[result.scene->instances[i].material]; };
    const Material first = materialOf(0), second = materialOf(1);
    for (const uint32_t number : {0u, 1u, 31u, 32u, 40u, 1000u, uint32_t(kHighest)})
        CHECK((isLightEnabled(first, number) && isLightEnabled(second, number)));
    CHECK(isLightEnabled(first, 39));
    CHECK_FALSE(isLightEnabled(second, 39));
    for (const uint32_t number : {2u, 33u, 999u, 16382u, 16384u, kNoLightNumber - 1})
        CHECK_FALSE(isLightEnabled(first, number));
    CHECK(countOf(result, "skipped.light") == 0);
}

TEST_CASE("lights whose mode is another one of OpenGL's are named", "[bridge]")
{
    LitScene scene({0});
    scene.add(-1);
    scene.add(0x403a); // as a mode of a light this would be GL_RESCALE_NORMAL
    scene.root->getOrCreateStateSet()->setMode(0x803a, kOn);
    const ConversionResult result = scene.converter.convert(scene.input);
    CHECK(result.scene->lights.empty());
    CHECK(countOf(result, "skipped.light") == 2);
}

TEST_CASE("a viewer's light may have any number", "[bridge]")
{
    LitScene scene({});
    scene.input.viewLight = new osg::Light(77);
    const auto lights = scene.lights();
    REQUIRE(lights.size() == 1);
    CHECK(lights[0].number == 77);
}

TEST_CASE("area light: parallelogram, quad that points back at it, black lamp material", "[bridge]")
{
    osg::ref_ptr<osgRayTrace::AreaLight> light = new osgRayTrace::AreaLight(
        {1.0f, 0.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 3.0f, 0.0f}, {17.0f, 12.0f, 4.0f});
    osg::ref_ptr<osg::MatrixTransform> root =
        new osg::MatrixTransform(osg::Matrixd::translate(6.0e6, 1.0, 0.0));
    root->addChild(light);
    ConversionInput input = inputFor(root);
    input.origin.set(6.0e6, 0.0, 0.0);
    SceneConverter converter;

    ConversionResult result = converter.convert(input);
    REQUIRE(result.scene->lights.size() == 1);
    REQUIRE(result.scene->instances.size() == 1);
    const Light& converted = result.scene->lights[0];
    CHECK(converted.kind == LightKind::Parallelogram);
    CHECK(converted.corner == Vec3(1.0f, 1.0f, 0.0f));
    CHECK(converted.edgeU == Vec3(2.0f, 0.0f, 0.0f));
    CHECK(converted.edgeV == Vec3(0.0f, 3.0f, 0.0f));
    CHECK(converted.radiance == Vec3(17.0f, 12.0f, 4.0f));
    CHECK_FALSE(converted.twoSided);
    CHECK(converted.instance == 0);
    CHECK(result.scene->instances[0].light == 0);
    CHECK_FALSE(result.scene->displayReferred);
    const Material& lamp = soleMaterial(result);
    CHECK(lamp.model == MaterialModel::Physical);
    CHECK(lamp.baseColor == Vec3(0.0f));
    CHECK(lamp.emission == converted.radiance);
    const Mesh& mesh = soleMesh(result);
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.positions[2] == Vec3(3.0f, 4.0f, 0.0f));
    for (std::size_t i = 0; i < 2; ++i)
        CHECK(triangleNormal(mesh, i) == Vec3(0.0f, 0.0f, 1.0f));

    light->setTwoSided(true);
    CHECK(converter.convert(input).scene->lights[0].twoSided);
    light->setRadiance({0.0f, 0.0f, 0.0f});
    result = converter.convert(input);
    CHECK(result.scene->lights.empty());
    CHECK(result.scene->instances.size() == 1);
    light->setEdgeV({1.0f, 0.0f, 0.0f});
    result = converter.convert(input);
    CHECK(result.scene->instances.empty());
    CHECK(countOf(result, "skipped.area-light") == 1);
}

TEST_CASE("area light: a mirrored transform keeps the front where the node has it", "[bridge]")
{
    osg::ref_ptr<osgRayTrace::AreaLight> light = new osgRayTrace::AreaLight(
        {0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, {1.0f, 1.0f, 1.0f});
    // The front is +z in the node; if the node is scaled by -1 along x it still is +z, and along z
    // it is -z.
    for (const double sign : {1.0, -1.0})
    {
        osg::ref_ptr<osg::MatrixTransform> root =
            new osg::MatrixTransform(osg::Matrixd::scale(-sign, 1.0, sign < 0.0 ? -1.0 : 1.0));
        root->addChild(light);
        const ConversionResult result = convertGraph(root);
        const Light& converted = result.scene->lights[0];
        const Vec3 front = glm::cross(converted.edgeU, converted.edgeV);
        CHECK(front.z == static_cast<float>(sign));
        CHECK(triangleNormal(soleMesh(result), 0).z == static_cast<float>(sign));
    }
}

TEST_CASE("geometry that emits is a light for each of its instances", "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    physical->setEmission({3.0f, 2.0f, 1.0f});
    geometry->getOrCreateStateSet()->setAttribute(physical);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    root->addChild(geometry);
    osg::ref_ptr<osg::MatrixTransform> moved =
        new osg::MatrixTransform(osg::Matrixd::translate(0.0, 0.0, 5.0));
    moved->addChild(geometry);
    root->addChild(moved);
    const ConversionResult result = convertGraph(root);
    REQUIRE(result.scene->lights.size() == 2);
    for (uint32_t i = 0; i < 2; ++i)
    {
        const Light& light = result.scene->lights[i];
        CHECK(light.kind == LightKind::Mesh);
        CHECK(light.radiance == Vec3(3.0f, 2.0f, 1.0f));
        CHECK(light.twoSided);
        REQUIRE(light.instance < 3);
        CHECK(result.scene->instances[light.instance].light == i);
    }
    CHECK(result.scene->instances[0].light == kInvalid);
}

TEST_CASE("lights with a size: by kind, by name, in engine lengths", "[bridge]")
{
    LitScene scene({0, 1, 2, 3});
    scene.root->addChild(
        new osg::MatrixTransform(osg::Matrixd::translate(1e-9, 0.0, 0.0))); // without effect
    scene.add(0)->setPosition(osg::Vec4(0, 0, 5, 1));
    scene.add(1)->setPosition(osg::Vec4(0, 0, 5, 0));
    osg::Light* key = scene.add(2);
    key->setPosition(osg::Vec4(1, 0, 5, 1));
    key->setName("key");
    scene.add(3)->setPosition(osg::Vec4(0, 1, 0, 0));
    scene.root->getChild(5)->asGroup()->getChild(0)->setName("sky");

    for (const Light& light : scene.lights())
        CHECK_FALSE(isSoft(light)); // by default

    scene.input.lightSizes = {0.5f, 2.0f, {{"key", 0.25f}, {"sky", 60.0f}, {"nobody", 1.0f}}};
    const ConversionResult result = scene.converter.convert(scene.input);
    const auto& lights = result.scene->lights;
    REQUIRE(lights.size() == 4);
    CHECK(lights[0].radius * result.scene->unit == Approx(0.5));
    CHECK(lights[0].sine == 0.0f);
    CHECK(lights[1].sine == Approx(std::sin(glm::radians(1.0)))); // the angle is a diameter
    CHECK(lights[1].radius == 0.0f);
    CHECK(lights[2].radius * result.scene->unit == Approx(0.25));
    CHECK(lights[3].sine == Approx(0.5));
    CHECK(countOf(result, "warned.light-size") == 1);
    CHECK(result.paths.at("warned.light-size").front() == "light-sizes 'nobody'");

    // A tiny scene has a unit of its own; another size of a light alone makes a new snapshot.
    scene.root->removeChild(0u);
    osg::ref_ptr<osg::MatrixTransform> small =
        new osg::MatrixTransform(osg::Matrixd::scale(1e-12, 1e-12, 1e-12));
    small->addChild(triangleGeometry());
    scene.root->addChild(small);
    const auto first = scene.converter.convert(scene.input).scene;
    REQUIRE(first->unit < 1e-6);
    CHECK(first->lights[0].radius * first->unit == Approx(0.5));
    scene.input.lightSizes.radius = 0.75f;
    const auto second = scene.converter.convert(scene.input).scene;
    CHECK(second != first);
    CHECK(second->lights[0].radius * second->unit == Approx(0.75));
    CHECK(second->lights[0].changed != first->lights[0].changed);
    CHECK(second->lights[1].changed == first->lights[1].changed);
}
