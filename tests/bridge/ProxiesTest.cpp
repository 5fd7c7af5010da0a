// ProxiesTest.cpp - what OSG draws is met by all rays but the camera's. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/scene/SceneTraits.h"
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osgRayTrace/PhysicalMaterial>
#include <osgRayTrace/RayTracedScene>

#include <osg/Billboard>
#include <osg/BlendFunc>
#include <osg/ClipPlane>
#include <osg/ColorMask>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/PolygonMode>
#include <osg/Program>
#include <osg/ShapeDrawable>
#include <osg/Stencil>
#include <osg/TexEnvCombine>
#include <osg/Texture2D>
#include <osgFX/Scribe>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;

namespace
{

constexpr auto kOff = osg::StateAttribute::OFF;
const char* const kProxy = "traced.proxy";

void addProgram(osg::Node& node)
{
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, "void main() {}"));
    node.getOrCreateStateSet()->setAttributeAndModes(program);
}

osg::ref_ptr<osg::Geometry> shaded()
{
    const auto geometry = triangleGeometry();
    addProgram(*geometry);
    return geometry;
}

ConversionInput inputForViewer(osg::Node* root)
{
    ConversionInput input = inputFor(root);
    input.rasterizesRest = true;
    return input;
}

ConversionResult convertForViewer(osg::Node* root)
{
    SceneConverter converter;
    return converter.convert(inputForViewer(root));
}

/// Returns the number of proxies of a graph of which OSG draws all.
uint64_t proxiesOf(osg::Node* root)
{
    const ConversionResult result = convertForViewer(root);
    CHECK(result.rasterized);
    CHECK(result.scene->instances.size() == countOf(result, kProxy));
    for (const Instance& instance : result.scene->instances)
        CHECK(result.scene->materials[instance.material].culling == FaceCulling::FrontAndBack);
    return countOf(result, kProxy);
}

/// Draws a triangle that it tells to functors.
struct Teller : osg::Drawable
{
    META_Node(test, Teller)
    Teller() = default;
    Teller(const Teller& other, const osg::CopyOp& copy) : osg::Drawable(other, copy) {}

    bool supports(const osg::PrimitiveFunctor&) const override { return true; }
    void accept(osg::PrimitiveFunctor& functor) const override
    {
        functor.setVertexArray(3, corners);
        functor.drawArrays(GL_LINE_LOOP, 0, 3);
        const GLushort indices[] = {0, 1, 2, 1, 2, 9};
        functor.drawElements(GL_TRIANGLES, 6, indices);
    }
    osg::BoundingBox computeBoundingBox() const override { return {0, 0, 0, 1, 1, 1}; }
    void drawImplementation(osg::RenderInfo&) const override {}

    osg::Vec3d corners[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
};

} // namespace

TEST_CASE("proxies: of a geometry with a program, below OSG's part", "[bridge]")
{
    const auto geometry = shaded();
    geometry->getStateSet()->setMode(GL_LIGHTING, kOff);
    ConversionInput input = inputForViewer(geometry);
    input.cullAllRays = GENERATE(false, true);
    input.picks = true;
    SceneConverter converter;
    const ConversionResult result = converter.convert(input);
    REQUIRE(result.rasterized);
    CHECK(result.rasterized->size() == 1);
    CHECK(countOf(result, "rasterized.shader-program") == 1);
    CHECK(countOf(result, kProxy) == 1);
    CHECK(countOf(result, "converted.geometry") == 0); // no camera ray meets it
    CHECK(countOf(result, "approximated.shader") == 0);
    const Material& material = soleMaterial(result);
    CHECK(material.culling == FaceCulling::FrontAndBack);
    CHECK_FALSE(material.cullsAllRays);
    CHECK(material.lit); // an unlit surface would shine

    const auto traced = TracedScene::build(result.scene, std::make_shared<Workers>(1));
    const auto meets = [&](HitRule rule) {
        return traced->intersector()
            .closestHit({0.2f, 0.2f, 1}, {0, 0, -1}, 0, 9, rule)
            .has_value();
    };
    CHECK_FALSE(meets(kCameraRays));
    CHECK(meets({}));
    CHECK(meets(kPhotonRays));
    CHECK(traced->intersector().occluded({0.2f, 0.2f, -1}, {0, 0, 1}, 0, 9));

    const ConversionResult headless = convertGraph(geometry);
    CHECK(countOf(headless, kProxy) == 0);
    CHECK(soleMaterial(headless).culling == FaceCulling::None);
    CHECK_FALSE(soleMaterial(headless).lit);
}

TEST_CASE("proxies: of all opaque surfaces that OSG draws", "[bridge]")
{
    const auto geometry = triangleGeometry();
    osg::StateSet& state = *geometry->getOrCreateStateSet();
    SECTION("a hint")
    {
        RayTracedScene::setHint(geometry, RayTracedScene::RASTERIZE);
        state.setAttributeAndModes(new osg::BlendFunc); // its alpha is known
    }
    SECTION("a texture combiner")
    {
        state.setTextureAttributeAndModes(0, new osg::Texture2D(new osg::Image));
        state.setTextureAttribute(0, new osg::TexEnvCombine);
    }
    SECTION("a texture that only OpenGL has")
    {
        const osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
        texture->setTextureSize(64, 64);
        state.setTextureAttributeAndModes(0, texture);
    }
    SECTION("a depth function of a surface, in a bin above 0")
    {
        addProgram(*geometry);
        state.setAttributeAndModes(new osg::Depth(osg::Depth::GEQUAL));
        state.setRenderBinDetails(4, "RenderBin");
    }
    CHECK(proxiesOf(geometry) == 1);
}

TEST_CASE("proxies: none of what is no opaque surface of the scene", "[bridge]")
{
    const auto geometry = shaded();
    osg::StateSet& state = *geometry->getStateSet();
    osg::ref_ptr<osg::MatrixTransform> above = placed(osg::Matrixd(), geometry);
    REQUIRE(proxiesOf(above) == 1);
    SECTION("additive blending")
    {
        state.setAttributeAndModes(new osg::BlendFunc(GL_ONE, GL_ONE));
    }
    SECTION("an alpha that a program computes")
    {
        state.setMode(GL_BLEND, osg::StateAttribute::ON);
    }
    SECTION("a stencil")
    {
        state.setAttributeAndModes(new osg::Stencil);
    }
    SECTION("a colour mask")
    {
        state.setAttribute(new osg::ColorMask(false, false, false, false));
    }
    SECTION("lines")
    {
        state.setAttribute(
            new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, osg::PolygonMode::LINE));
    }
    SECTION("faces that a plane of the state cuts")
    {
        state.setAttributeAndModes(new osg::ClipPlane(2, 1.0, 0.0, 0.0, -0.5));
    }
    SECTION("without a depth test")
    {
        above->getOrCreateStateSet()->setMode(GL_DEPTH_TEST, kOff);
    }
    SECTION("without depth, which a node above overrides")
    {
        above->getOrCreateStateSet()->setAttribute(new osg::Depth(osg::Depth::LESS, 0, 1, false),
                                                   osg::StateAttribute::OVERRIDE);
        state.setAttribute(new osg::Depth);
    }
    SECTION("at the far end of depth")
    {
        state.setAttribute(new osg::Depth(osg::Depth::LEQUAL, 1.0, 1.0));
    }
    SECTION("over all depths")
    {
        state.setAttribute(new osg::Depth(osg::Depth::ALWAYS));
    }
    SECTION("before everything")
    {
        above->getOrCreateStateSet()->setRenderBinDetails(-1, "RenderBin");
    }
    SECTION("with the eye")
    {
        above->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    }
    SECTION("vertices that a program places")
    {
        geometry->setCullingActive(false);
    }
    SECTION("the inside of a hull")
    {
        state.setAttributeAndModes(new osg::CullFace(osg::CullFace::FRONT));
    }
    SECTION("instances that a program places")
    {
        geometry->getPrimitiveSet(0)->setNumInstances(3);
    }
    SECTION("a hint")
    {
        RayTracedScene::setHint(above, RayTracedScene::RASTERIZE_ONLY);
        CHECK(above->getDescription(0) == "osgRayTrace:rasterize-only");
        CHECK(RayTracedScene::getHint(above) == RayTracedScene::RASTERIZE_ONLY);
        CHECK(countOf(convertForViewer(above), "rasterized.hint") == 1);
        CHECK(countOf(convertGraph(above), "approximated.rasterize-hint") == 1);
    }
    CHECK(proxiesOf(above) == 0);
}

TEST_CASE("proxies: of the children of what OSG draws as a whole", "[bridge]")
{
    SECTION("an effect, whose nodes are no parts of their own")
    {
        const osg::ref_ptr<osgFX::Scribe> effect = new osgFX::Scribe;
        effect->addChild(placed(osg::Matrixd::translate(0, 0, 3), triangleGeometry()));
        effect->addChild(shaded());
        const ConversionResult result = convertForViewer(effect);
        CHECK(result.rasterized->size() == 1);
        CHECK(countOf(result, "rasterized.shader-program") == 0);
        CHECK(proxiesOf(effect) == 2);
    }
    SECTION("a billboard")
    {
        const osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
        billboard->addDrawable(shaded(), osg::Vec3(2.0f, 0.0f, 0.0f));
        billboard->addDrawable(new Teller, osg::Vec3(1.0f, 0.0f, 0.0f));
        const ConversionResult result = convertForViewer(billboard);
        CHECK(result.rasterized->size() == 1);
        CHECK(countOf(result, "not-traced.custom-drawable") == 0);
        CHECK(proxiesOf(billboard) == 2);
    }
}

TEST_CASE("proxies: of drawables that tell their triangles", "[bridge]")
{
    const osg::ref_ptr<Teller> teller = new Teller;
    const auto root = placed(osg::Matrixd::translate(0, 0, 5), teller);
    CHECK(proxiesOf(root) == 1);
    CHECK(convertGraph(root).scene->instances.empty());

    SceneConverter converter;
    const ConversionInput input = inputForViewer(root);
    const ConversionResult first = converter.convert(input), second = converter.convert(input);
    CHECK(countOf(first, "not-traced.custom-drawable") == 1);
    CHECK(soleMesh(first).triangles.size() == 1); // the other one has an index beyond the vertices
    CHECK(firstCorner(*first.scene, 0).z == 5.0f);
    CHECK(&soleMesh(first) == &soleMesh(second)); // its triangles are as they were

    const ViewingConditions conditions;
    const uint64_t before = graphHash(*root, conditions, osg::Matrixd());
    teller->corners[0].z() = 1.0;
    CHECK(graphHash(*root, conditions, osg::Matrixd()) == before); // the bound is as it was
    teller->setDataVariance(osg::Object::DYNAMIC);
    const uint64_t dynamic = graphHash(*root, conditions, osg::Matrixd());
    teller->corners[0].z() = 2.0;
    CHECK(graphHash(*root, conditions, osg::Matrixd()) != dynamic);
    CHECK(firstCorner(*converter.convert(input).scene, 0).z == 7.0f);
}

TEST_CASE("proxies: nothing else looks different because of them", "[bridge]")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    const auto drawn = shaded();
    osg::StateSet& state = *drawn->getStateSet();
    // A material beside the program would have the surface traced.
    const osg::ref_ptr<osg::Group> above = new osg::Group;
    above->getOrCreateStateSet()->setAttribute(new PhysicalMaterial);
    above->addChild(drawn);
    const osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity(osg::Vec4(0.7f, 0.7f, 0.7f, 1.0f));
    state.setAttribute(model);
    const osg::ref_ptr<osg::Material> red = new osg::Material;
    red->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1, 0, 0, 1));
    red->setColorMode(osg::Material::DIFFUSE);
    state.setAttribute(red);
    const ConversionResult without = convertForViewer(root);
    root->addChild(above);
    const ConversionResult with = convertForViewer(root);
    REQUIRE(countOf(with, kProxy) == 1);
    CHECK(with.scene->displayReferred);
    CHECK_FALSE(sceneTraits(*with.scene).physical); // the integrator that is chosen stays the same
    CHECK(with.scene->ambient == without.scene->ambient);
    CHECK(soleMaterial(with).ambient == soleMaterial(without).ambient);
    CHECK(countOf(with, "converted.geometry") == 1);
}

TEST_CASE("proxies: the dome of a sky has none if it keeps the light off", "[bridge]")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(placed(osg::Matrixd::scale(5, 5, 5), triangleGeometry()));
    root->addChild(placed(osg::Matrixd::translate(3, 0, 1), triangleGeometry()));
    const osg::ref_ptr<osg::LightSource> light = new osg::LightSource;
    light->getLight()->setPosition(osg::Vec4(0.5f, 0.3f, 1.0f, 0.0f));
    root->addChild(light);
    const osg::ref_ptr<osg::Geometry> inner =
        new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 90.0f));
    const osg::ref_ptr<osg::Geometry> outer =
        new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 100.0f));
    for (const auto& dome : {inner, outer})
    {
        addProgram(*dome);
        root->addChild(dome);
    }
    const auto proxies = [&] { return countOf(convertForViewer(root), kProxy); };
    CHECK(proxies() == 0);
    SECTION("lamps within")
    {
        light->getLight()->setPosition(osg::Vec4(0.5f, 0.3f, 1.0f, 1.0f));
        CHECK(proxies() == 2);
    }
    SECTION("a valley, in whose bounds everything is")
    {
        const auto valley = triangleGeometry();
        auto& corners = static_cast<osg::Vec3Array&>(*valley->getVertexArray());
        corners[0].set(-200.0f, -200.0f, -150.0f);
        corners[1].set(200.0f, -200.0f, -150.0f);
        corners[2].set(0.0f, 300.0f, 100.0f);
        addProgram(*valley);
        root->removeChild(inner);
        root->removeChild(outer);
        root->addChild(valley);
        CHECK(proxies() == 1);
    }
    SECTION("something outside")
    {
        root->addChild(placed(osg::Matrixd::translate(500, 0, 0), triangleGeometry()));
        CHECK(proxies() == 2);
    }
}
