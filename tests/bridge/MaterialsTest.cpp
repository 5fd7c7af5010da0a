// MaterialsTest.cpp - the surface that inherited state gives, and the rule for colours.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ToneMap.h"
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/CullFace>
#include <osg/Fog>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/PolygonOffset>

#include <limits>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

constexpr auto kOn = osg::StateAttribute::ON;
constexpr auto kOff = osg::StateAttribute::OFF;
constexpr auto kSide = osg::Material::FRONT_AND_BACK;

osg::ref_ptr<osg::Material> newMaterial(osg::Material::ColorMode mode)
{
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(mode);
    material->setAmbient(kSide, {0.1f, 0.0f, 0.0f, 1.0f});
    material->setDiffuse(kSide, {0.2f, 0.0f, 0.0f, 0.5f});
    material->setSpecular(kSide, {0.3f, 0.0f, 0.0f, 1.0f});
    material->setEmission(kSide, {0.4f, 0.0f, 0.0f, 1.0f});
    material->setShininess(kSide, 20.0f);
    return material;
}

void setColor(osg::Geometry& geometry, osg::Array::Binding binding)
{
    const unsigned int size = binding == osg::Array::BIND_OVERALL ? 1 : 3;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array(size);
    for (osg::Vec4& color : *colors)
        color.set(0.0f, 0.5f, 1.0f, 0.25f);
    geometry.setColorArray(colors, binding);
}

Material materialOf(osg::Node* root)
{
    const ConversionResult result = convertGraph(root);
    REQUIRE(result.scene->instances.size() == 1);
    return soleMaterial(result);
}

const Vec3 kColor(0.0f, 0.5f, 1.0f);

} // namespace

TEST_CASE("without any material: osgViewer's default, coloured by the vertices", "[bridge]")
{
    const auto geometry = triangleGeometry();
    Material material = materialOf(geometry);
    CHECK(material.model == MaterialModel::FixedFunction);
    CHECK(material.lit);
    CHECK(material.diffuse == Vec3(0.8f));
    CHECK(material.ambient == Vec3(0.2f)); // see applyColor in MaterialConverter.cpp
    CHECK(material.specular == Vec3(0.0f));
    CHECK(material.vertexColorUse == VertexColorUse::None);

    setColor(*geometry, osg::Array::BIND_OVERALL);
    material = materialOf(geometry);
    CHECK(material.ambient == kColor);
    CHECK(material.diffuse == kColor);
    CHECK(material.vertexColorUse == VertexColorUse::None);

    setColor(*geometry, osg::Array::BIND_PER_VERTEX);
    CHECK(materialOf(geometry).vertexColorUse == VertexColorUse::AmbientAndDiffuse);
}

TEST_CASE("without material and colours: ambient follows diffuse once glColor changes", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    const osg::ref_ptr<osg::Geometry> other = triangleGeometry();
    root->addChild(other);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    other->getOrCreateStateSet()->setAttribute(material);
    const auto plain = [&root]
    {
        const ConversionResult result = convertGraph(root);
        return result.scene->materials[result.scene->instances[0].material];
    };
    CHECK(plain().ambient == Vec3(0.2f));
    CHECK(plain().diffuse == Vec3(0.8f));
    material->setDiffuse(kSide, {0.3f, 0.3f, 0.3f, 1.0f});
    CHECK(plain().ambient == Vec3(0.8f));
    material->setColorMode(osg::Material::SPECULAR);
    material->setSpecular(kSide, {0.8f, 0.8f, 0.8f, 1.0f});
    CHECK(plain().ambient == Vec3(0.2f)); // glColor is that of SPECULAR, which is 0.8, too

    // One graph has a material that sets glColor, and vertex colours that ambient light follows.
    material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    const ConversionResult result = convertGraph(root);
    CHECK(result.scene->materials[result.scene->instances[1].material].ambient == Vec3(0.3f));
    CHECK(result.scene->materials[result.scene->instances[0].material].ambient == Vec3(0.8f));
}

TEST_CASE("culled faces are there for other rays than the camera's, or for none; lamps always are",
          "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::StateSet* state = geometry->getOrCreateStateSet();
    state->setAttribute(new osg::CullFace(osg::CullFace::FRONT));
    SceneConverter converter;
    ConversionInput input = inputFor(geometry);
    const auto converted = [&] { return soleMaterial(converter.convert(input)); };
    input.cullAllRays = true;
    CHECK(!converted().cullsAllRays); // nothing is culled
    state->setMode(GL_CULL_FACE, kOn);
    CHECK(converted().culling == FaceCulling::Front);
    CHECK(converted().cullsAllRays);
    input.cullAllRays = false;
    CHECK(converted().culling == FaceCulling::Front);
    CHECK(!converted().cullsAllRays); // the graph is the same: the material must be another one

    osg::ref_ptr<PhysicalMaterial> lamp = new PhysicalMaterial;
    state->setAttribute(lamp);
    input.cullAllRays = true;
    CHECK(converted().cullsAllRays);
    lamp->setEmission(osg::Vec3(1.0f, 0.0f, 0.0f));
    CHECK(!converted().cullsAllRays);
}

TEST_CASE("polygon offset is reported where its back can be seen", "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::StateSet* state = geometry->getOrCreateStateSet();
    const auto reported = [&]
    { return countOf(convertGraph(geometry), "approximated.polygon-offset"); };
    state->setAttribute(new osg::PolygonOffset(1.0f, 1.0f));
    CHECK(reported() == 0);
    state->setMode(GL_POLYGON_OFFSET_FILL, kOn);
    CHECK(reported() == 1);
    state->setMode(GL_CULL_FACE, kOn); // culls back faces
    CHECK(reported() == 0);
    state->setAttribute(new osg::CullFace(osg::CullFace::FRONT));
    CHECK(reported() == 1);
    state->setAttribute(new osg::PolygonOffset(0.0f, 0.0f));
    CHECK(reported() == 0);
}

TEST_CASE("osg::Material: all values, and colours by its color mode", "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::StateSet* state = geometry->getOrCreateStateSet();
    setColor(*geometry, osg::Array::BIND_PER_VERTEX);

    state->setAttribute(newMaterial(osg::Material::OFF));
    Material material = materialOf(geometry);
    CHECK(material.ambient == Vec3(0.1f, 0.0f, 0.0f));
    CHECK(material.diffuse == Vec3(0.2f, 0.0f, 0.0f));
    CHECK(material.specular == Vec3(0.3f, 0.0f, 0.0f));
    CHECK(material.emission == Vec3(0.4f, 0.0f, 0.0f));
    CHECK(material.shininess == 20.0f);
    CHECK(material.alpha == 1.0f); // blending is off
    CHECK(material.vertexColorUse == VertexColorUse::None);

    state->setMode(GL_BLEND, kOn);
    CHECK(materialOf(geometry).alpha == 0.5f);

    const std::pair<osg::Material::ColorMode, VertexColorUse> modes[] = {
        {osg::Material::AMBIENT, VertexColorUse::Ambient},
        {osg::Material::DIFFUSE, VertexColorUse::Diffuse},
        {osg::Material::SPECULAR, VertexColorUse::Specular},
        {osg::Material::EMISSION, VertexColorUse::Emission},
        {osg::Material::AMBIENT_AND_DIFFUSE, VertexColorUse::AmbientAndDiffuse}};
    for (const auto& [mode, use] : modes)
    {
        state->setAttribute(newMaterial(mode));
        CHECK(materialOf(geometry).vertexColorUse == use);
    }

    setColor(*geometry, osg::Array::BIND_OVERALL);
    state->setAttribute(newMaterial(osg::Material::DIFFUSE));
    material = materialOf(geometry);
    CHECK(material.ambient == Vec3(0.1f, 0.0f, 0.0f));
    CHECK(material.diffuse == kColor);
    CHECK(material.alpha == 0.25f);
}

TEST_CASE("unlit geometry shows its colour and nothing else", "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::StateSet* state = geometry->getOrCreateStateSet();
    state->setMode(GL_LIGHTING, kOff);
    state->setAttribute(newMaterial(osg::Material::OFF));
    setColor(*geometry, osg::Array::BIND_OVERALL);
    Material material = materialOf(geometry);
    CHECK_FALSE(material.lit);
    CHECK(material.diffuse == kColor);
    CHECK(material.emission == Vec3(0.0f));

    setColor(*geometry, osg::Array::BIND_PER_VERTEX);
    CHECK(materialOf(geometry).vertexColorUse == VertexColorUse::AmbientAndDiffuse);

    geometry->setColorArray(nullptr);
    CHECK(materialOf(geometry).diffuse ==
          Vec3(0.2f, 0.0f, 0.0f)); // glColor as osg::Material leaves it
}

TEST_CASE("lighting is on above the scene unless the view says otherwise", "[bridge]")
{
    const auto geometry = triangleGeometry();
    ConversionInput input = inputFor(geometry);
    input.lighting = false;
    SceneConverter converter;
    ConversionResult result = converter.convert(input);
    CHECK_FALSE(soleMaterial(result).lit);
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, kOn);
    result = converter.convert(input);
    CHECK(soleMaterial(result).lit);
    CHECK(result.scene->ambient == Vec3(0.2f));
}

TEST_CASE("state is that of the path: overridden, protected, and not leaked to siblings",
          "[bridge]")
{
    const auto leaf = triangleGeometry();
    leaf->getOrCreateStateSet()->setAttribute(newMaterial(osg::Material::OFF));
    osg::ref_ptr<osg::Group> above = new osg::Group;
    above->addChild(leaf);
    osg::ref_ptr<osg::Material> own = new osg::Material;
    own->setColorMode(osg::Material::OFF);
    own->setDiffuse(kSide, {0.0f, 1.0f, 0.0f, 1.0f});
    osg::StateSet* state = above->getOrCreateStateSet();

    state->setAttribute(own);
    CHECK(materialOf(above).diffuse == Vec3(0.2f, 0.0f, 0.0f));
    state->setAttribute(own, osg::StateAttribute::OVERRIDE);
    CHECK(materialOf(above).diffuse == Vec3(0.0f, 1.0f, 0.0f));
    leaf->getStateSet()->setAttribute(newMaterial(osg::Material::OFF),
                                      osg::StateAttribute::PROTECTED);
    CHECK(materialOf(above).diffuse == Vec3(0.2f, 0.0f, 0.0f));

    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(above);
    root->addChild(triangleGeometry());
    const ConversionResult result = convertGraph(root);
    REQUIRE(result.scene->instances.size() == 2);
    CHECK(result.scene->materials[result.scene->instances[1].material].diffuse == Vec3(0.8f));
}

TEST_CASE("one geometry under different state is one mesh with two materials; equal ones merge",
          "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::ref_ptr<osg::Group> root = new osg::Group;
    for (int i = 0; i < 4; ++i)
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        if (i > 0)
            group->getOrCreateStateSet()->setAttribute(
                newMaterial(i < 3 ? osg::Material::OFF : osg::Material::AMBIENT));
        group->addChild(geometry);
        root->addChild(group);
    }
    const ConversionResult result = convertGraph(root);
    const auto& instances = result.scene->instances;
    REQUIRE(instances.size() == 4);
    CHECK(result.scene->meshes.size() == 1);
    CHECK(instances[0].material != instances[1].material);
    CHECK(instances[1].material == instances[2].material); // two objects of equal values
    CHECK(result.scene->materials.size() == 2); // without vertex colours the color mode is ignored
}

TEST_CASE("light model: ambient of the scene, two sides of the material", "[bridge]")
{
    const auto geometry = triangleGeometry();
    CHECK(convertGraph(geometry).scene->ambient == Vec3(0.1f));
    osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity({0.25f, 0.5f, 0.75f, 1.0f});
    model->setTwoSided(true);
    geometry->getOrCreateStateSet()->setAttribute(model);
    const ConversionResult result = convertGraph(geometry);
    CHECK(result.scene->ambient == Vec3(0.25f, 0.5f, 0.75f));
    CHECK(soleMaterial(result).twoSidedLighting);
}

TEST_CASE("PhysicalMaterial wins over osg::Material and is taken as it is", "[bridge]")
{
    const auto geometry = triangleGeometry();
    setColor(*geometry, osg::Array::BIND_PER_VERTEX);
    osg::StateSet* state = geometry->getOrCreateStateSet();
    state->setAttribute(newMaterial(osg::Material::OFF));
    state->setMode(GL_LIGHTING, kOff);
    osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    physical->setBaseColor({0.25f, 0.5f, 0.75f});
    physical->setMetallic(0.5f);
    physical->setRoughness(0.25f);
    physical->setTransmission(0.125f);
    physical->setIor(1.75f);
    state->setAttribute(physical);
    const ConversionResult result = convertGraph(geometry);
    const Material& material = soleMaterial(result);
    CHECK(material.model == MaterialModel::Physical);
    CHECK(material.lit);
    CHECK(material.baseColor == Vec3(0.25f, 0.5f, 0.75f));
    CHECK(material.metallic == 0.5f);
    CHECK(material.roughness == 0.25f);
    CHECK(material.transmission == 0.125f);
    CHECK(material.ior == 1.75f);
    CHECK(material.vertexColorUse == VertexColorUse::None);
    CHECK_FALSE(result.scene->displayReferred);
    CHECK(result.scene->lights.empty());
}

TEST_CASE("fog is that of the state, and without one of OpenGL's first values", "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::StateSet* state = geometry->getOrCreateStateSet();
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(osg::Fog::LINEAR);
    fog->setColor({0.25f, 0.5f, 0.75f, 0.1f});
    fog->setDensity(-2.0f);
    fog->setStart(3.0f);
    fog->setEnd(std::numeric_limits<float>::infinity());
    fog->setUseRadialFog(true);
    state->setAttribute(fog);
    CHECK(materialOf(geometry).fog.mode == FogMode::None); // the mode is off

    state->setMode(GL_FOG, kOn);
    Fog converted = materialOf(geometry).fog;
    CHECK(converted.mode == FogMode::Linear);
    CHECK(converted.radial);
    CHECK(converted.color == Vec3(0.25f, 0.5f, 0.75f));
    CHECK(converted.density == 0.0f);
    CHECK(converted.start == 3.0f);
    CHECK(converted.end == 1.0f);
    fog->setMode(osg::Fog::EXP2);
    CHECK(materialOf(geometry).fog.mode == FogMode::ExponentialSquared);

    state->removeAttribute(fog);
    state->setMode(GL_FOG, kOn);
    converted = materialOf(geometry).fog;
    CHECK(converted.mode == FogMode::Exponential);
    CHECK(converted.color == Vec3(0.0f));
    CHECK(converted.density == 1.0f);
    CHECK_FALSE(converted.radial);
}

TEST_CASE("fog of a linear scene is decoded from sRGB, and separates materials", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    const auto geometry = triangleGeometry();
    for (const float red : {0.5f, 0.6f})
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        osg::ref_ptr<osg::Fog> fog = new osg::Fog;
        fog->setColor({red, 1.0f, 0.0f, 1.0f});
        group->getOrCreateStateSet()->setAttributeAndModes(fog);
        group->getOrCreateStateSet()->setAttribute(new PhysicalMaterial);
        group->addChild(geometry);
        root->addChild(group);
    }
    const ConversionResult result = convertGraph(root);
    REQUIRE(result.scene->instances.size() == 2);
    CHECK_FALSE(result.scene->displayReferred);
    const Material& first = result.scene->materials[result.scene->instances[0].material];
    const Material& second = result.scene->materials[result.scene->instances[1].material];
    CHECK(first.fog.color == Vec3(linearFromSrgb(0.5f), 1.0f, 0.0f));
    CHECK(second.fog.color == Vec3(linearFromSrgb(0.6f), 1.0f, 0.0f));
}

TEST_CASE("colour rule: fixed-function scenes as shown, others decoded from sRGB", "[bridge]")
{
    const auto fixed = triangleGeometry();
    setColor(*fixed, osg::Array::BIND_OVERALL);
    const auto varied = triangleGeometry();
    setColor(*varied, osg::Array::BIND_PER_VERTEX);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(fixed);
    root->addChild(varied);
    SceneConverter converter;
    ConversionInput input = inputFor(root);

    const auto checkDisplayReferred = [&]
    {
        const ConversionResult result = converter.convert(input);
        CHECK(result.scene->displayReferred);
        CHECK(result.scene->background == Vec4(0.2f, 0.2f, 0.4f, 1.0f));
        CHECK(soleMaterial(result).diffuse == kColor);
        CHECK(result.scene->meshes[1]->colors[0] == Vec4(kColor, 0.25f));
    };
    const auto checkLinear = [&]
    {
        const float half = linearFromSrgb(0.5f);
        const ConversionResult result = converter.convert(input);
        CHECK_FALSE(result.scene->displayReferred);
        CHECK(result.scene->background ==
              Vec4(Vec3(linearFromSrgb(0.2f), linearFromSrgb(0.2f), linearFromSrgb(0.4f)), 1.0f));
        CHECK(soleMaterial(result).diffuse == Vec3(0.0f, half, 1.0f));
        CHECK(result.scene->meshes[1]->colors[0] == Vec4(0.0f, half, 1.0f, 0.25f));
        CHECK(half == Approx(0.21404f).epsilon(1e-4));
    };

    checkDisplayReferred();
    input.colorRule = RayTraceSettings::LINEAR;
    checkLinear();
    input.colorRule = RayTraceSettings::AUTOMATIC_COLOR;
    const auto physical = triangleGeometry();
    physical->getOrCreateStateSet()->setAttribute(new PhysicalMaterial);
    root->addChild(physical);
    checkLinear();
    physical->setNodeMask(0);
    checkDisplayReferred();
    physical->setNodeMask(~0u);
    input.colorRule = RayTraceSettings::DISPLAY_REFERRED;
    checkDisplayReferred();
}
