// StateMatchTest.cpp - materials, lights, colours and inheritance look as OpenGL draws them.
// SPDX-License-Identifier: MIT
#include "StateScenes.h"

#include <osg/LightModel>
#include <osg/LightSource>
#include <osg/Material>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// Returns a shape so fine that OpenGL's lighting at vertices equals lighting at points.
osg::ref_ptr<osg::ShapeDrawable> shapeOf(osg::Shape* shape, const osg::Vec4& color)
{
    osg::ref_ptr<osg::TessellationHints> hints = new osg::TessellationHints;
    hints->setDetailRatio(10.0f);
    osg::ref_ptr<osg::ShapeDrawable> drawable = new osg::ShapeDrawable(shape, hints.get());
    drawable->setColor(color);
    return drawable;
}

osg::ref_ptr<osg::Material> shinyMaterial()
{
    osg::ref_ptr<osg::Material> material = new osg::Material;
    const auto both = osg::Material::FRONT_AND_BACK;
    material->setAmbient(both, {0.3f, 0.1f, 0.2f, 1.0f});
    material->setDiffuse(both, {0.2f, 0.5f, 0.3f, 1.0f});
    material->setSpecular(both, {0.8f, 0.7f, 0.3f, 1.0f});
    material->setEmission(both, {0.0f, 0.05f, 0.1f, 1.0f});
    material->setShininess(both, 20.0f);
    return material;
}

osg::ref_ptr<osg::LightSource> lamp(int number, const osg::Vec4& position, const osg::Vec4& color)
{
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    osg::Light& light = *source->getLight();
    light.setLightNum(number);
    light.setPosition(position);
    light.setAmbient(color * 0.1f);
    light.setDiffuse(color);
    light.setSpecular(color);
    return source;
}

} // namespace

TEST_CASE("match: shapes in the colours that ShapeDrawable gives them", "[gl][coverage]")
{
    const auto at = [](double x, double y, osg::Node* node)
    {
        return placed(osg::Matrixd::rotate(-1.2, osg::Vec3d(1, 0, 0)) *
                          osg::Matrixd::translate(x, y, 0.0),
                      node);
    };
    const auto root = groupOf(
        {at(-2.5, 1.2, shapeOf(new osg::Sphere({}, 0.9f), {0.9f, 0.3f, 0.2f, 1.0f})),
         at(0.0, 1.2, shapeOf(new osg::Cone({}, 0.9f, 1.6f), {0.2f, 0.9f, 0.3f, 1.0f})),
         at(2.5, 1.2, shapeOf(new osg::Cylinder({}, 0.8f, 1.4f), {0.2f, 0.3f, 0.9f, 1.0f})),
         at(-2.5, -1.2, shapeOf(new osg::Box({}, 1.4f), {0.8f, 0.8f, 0.2f, 1.0f})),
         at(0.0, -1.2, shapeOf(new osg::Capsule({}, 0.5f, 0.9f), {0.8f, 0.4f, 0.8f, 1.0f}))});
    CHECK(matches("shapes", root));
}

TEST_CASE("match: without materials and colours, alone and beside a material", "[gl][coverage]")
{
    const auto plain = [](float x)
    {
        const osg::ref_ptr<osg::Geometry> geometry = square(1.7f);
        geometry->setColorArray(nullptr);
        return placed(osg::Matrixd::translate(x, 0.0, 0.0), geometry);
    };
    osg::ref_ptr<osg::LightModel> bright = new osg::LightModel; // only ambient light differs
    bright->setAmbientIntensity({0.3f, 0.3f, 0.3f, 1.0f});
    const osg::ref_ptr<osg::Group> alone = groupOf({plain(-1.8f), plain(1.8f)});
    alone->getOrCreateStateSet()->setAttribute(bright);
    CHECK(matches("no-material", alone));

    const osg::ref_ptr<osg::MatrixTransform> other = plain(1.8f);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, {0.2f, 0.5f, 0.3f, 1.0f});
    other->getOrCreateStateSet()->setAttribute(material);
    const osg::ref_ptr<osg::Group> beside = groupOf({plain(-1.8f), other});
    beside->getOrCreateStateSet()->setAttribute(bright);
    CHECK(matches("no-material-beside-one", beside));
}

TEST_CASE("match: a pyramid with colours and normals of its own, as osgshape has", "[gl][coverage]")
{
    const osg::ref_ptr<osg::Geometry> pyramid = new osg::Geometry;
    const osg::Vec3 base[] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}};
    const osg::Vec3 top(0, 0, 1);
    const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array, normals = new osg::Vec3Array;
    const osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    for (int side = 0; side < 4; ++side)
    {
        const osg::Vec3 a = base[side], b = base[(side + 1) % 4];
        osg::Vec3 normal = (b - a) ^ (top - a);
        normal.normalize();
        for (const osg::Vec3& v : {a, b, top})
        {
            vertices->push_back(v * 2.0f);
            normals->push_back(normal);
        }
        colors->push_back({1, 0, 0, 1});
        colors->push_back({0, 1, 0, 1});
        colors->push_back({0, 0, 1, 1});
    }
    pyramid->setVertexArray(vertices);
    pyramid->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    pyramid->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 12));
    const auto turned = placed(osg::Matrixd::rotate(-1.0, osg::Vec3d(1, 0.3, 0)), pyramid);
    pyramid->setNormalArray(normals, osg::Array::BIND_PER_VERTEX);
    CHECK(matches("pyramid-normals", turned));
}

TEST_CASE("match: osgshape's hull, textured and without coordinates", "[gl][coverage]")
{
    const osg::ref_ptr<osg::ConvexHull> hull = new osg::ConvexHull;
    const osg::Vec3 corners[] = {{-2, 2, -2}, {0, -2, -2}, {2, 2, -2}, {0, 0, 2}};
    hull->setVertices(new osg::Vec3Array(4, corners));
    GLubyte indices[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    hull->setIndices(new osg::UByteArray(12, indices));
    const osg::ref_ptr<osg::ShapeDrawable> pyramid = new osg::ShapeDrawable(hull);
    pyramid->getOrCreateStateSet()->setTextureAttributeAndModes(0, textureOf(patchwork(8, GL_RGB)));
    CHECK(matches("osgshape-pyramid",
                  placed(osg::Matrixd::rotate(-osg::PI_2, osg::Vec3d(1, 0, 0)), pyramid)));
}

TEST_CASE("match: Material with every color mode, lit and not", "[gl][coverage]")
{
    const std::pair<const char*, osg::Material::ColorMode> modes[] = {
        {"off", osg::Material::OFF},
        {"ambient", osg::Material::AMBIENT},
        {"diffuse", osg::Material::DIFFUSE},
        {"specular", osg::Material::SPECULAR},
        {"emission", osg::Material::EMISSION},
        {"ambient-and-diffuse", osg::Material::AMBIENT_AND_DIFFUSE}};
    for (const auto& [name, mode] : modes)
        for (const bool lit : {true, false})
        {
            const auto ball = shapeOf(new osg::Sphere({}, 3.0f), {0.9f, 0.4f, 0.2f, 1.0f});
            const auto material = shinyMaterial();
            material->setColorMode(mode);
            osg::StateSet& state = *ball->getOrCreateStateSet();
            state.setAttribute(material);
            if (!lit) state.setMode(GL_LIGHTING, kOff);
            CHECK(matches(std::string("color-mode-") + name + (lit ? "" : "-unlit"), ball));
        }
}

TEST_CASE("match: LightModel with two sides, a local viewer, separate highlights", "[gl][coverage]")
{
    const int kind = GENERATE(0, 1, 2, 3);
    const char* const names[] = {"one-sided", "two-sided", "local-viewer", "separate-specular"};
    const osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity({0.2f, 0.2f, 0.25f, 1.0f});
    model->setTwoSided(kind == 1);
    model->setLocalViewer(kind == 2);
    if (kind == 3) model->setColorControl(osg::LightModel::SEPARATE_SPECULAR_COLOR);
    const auto material = shinyMaterial();
    material->setDiffuse(osg::Material::BACK, {0.7f, 0.2f, 0.2f, 1.0f});
    material->setSpecular(osg::Material::BACK, {0.1f, 0.2f, 0.9f, 1.0f});

    // A hemisphere that is open to the side shows both of its faces.
    const auto ball = shapeOf(new osg::Sphere({}, 2.5f), {1, 1, 1, 1});
    const osg::ref_ptr<osg::ShapeDrawable> bowl =
        shapeOf(new osg::Cone({}, 2.0f, 3.0f), {1, 1, 1, 1});
    const osg::ref_ptr<osg::TessellationHints> open = new osg::TessellationHints;
    open->setDetailRatio(10.0f);
    open->setCreateBottom(false);
    bowl->setTessellationHints(open);
    osg::ref_ptr<osg::Node> thing = ball;
    if (kind <= 1) thing = placed(osg::Matrixd::rotate(-2.4, osg::Vec3d(1, 0.4, 0)), bowl);
    osg::StateSet& state = *thing->getOrCreateStateSet();
    state.setAttribute(model);
    state.setAttribute(material);
    if (kind == 3) state.setTextureAttributeAndModes(0, textureOf(patchwork(8, GL_RGB)));
    CHECK(matches(std::string("light-model-") + names[kind], thing));
}

TEST_CASE("match: lights of the graph: positions, attenuation, spots, numbers, places",
          "[gl][coverage]")
{
    const auto root = groupOf({shapeOf(new osg::Sphere({-1.5f, 0, 0}, 1.4f), {1, 1, 1, 1}),
                               shapeOf(new osg::Sphere({1.5f, 0, 0}, 1.4f), {1, 1, 1, 1})});
    osg::StateSet& state = *root->getOrCreateStateSet();
    state.setAttribute(shinyMaterial());
    const auto warm = lamp(1, {0.0f, 3.0f, 3.0f, 1.0f}, {0.9f, 0.6f, 0.3f, 1.0f});
    warm->getLight()->setConstantAttenuation(0.5f);
    warm->getLight()->setLinearAttenuation(0.1f);
    warm->getLight()->setQuadraticAttenuation(0.02f);
    const auto spot = lamp(3, {0.0f, 0.0f, 0.0f, 1.0f}, {0.3f, 0.8f, 1.0f, 1.0f});
    spot->getLight()->setDirection({0.0f, 0.0f, -1.0f});
    spot->getLight()->setSpotCutoff(20.0f);
    spot->getLight()->setSpotExponent(8.0f);
    const auto sun = lamp(2, {-1.0f, -1.0f, 0.2f, 0.0f}, {0.4f, 0.4f, 0.1f, 1.0f});
    root->addChild(placed(osg::Matrixd::translate(0.5, 0.0, 0.0), warm));
    root->addChild(placed(osg::Matrixd::translate(1.5, 0.2, 6.0), spot));
    root->addChild(sun);
    for (const unsigned int number : {1u, 2u, 3u})
        state.setMode(GL_LIGHT0 + number, kOn);
    CHECK(matches("lights", root));
}

TEST_CASE("match: states with OVERRIDE and PROTECTED", "[gl][coverage]")
{
    const auto ballWith = [](double x, double y, unsigned int value)
    {
        const auto ball = shapeOf(new osg::Sphere({}, 0.9f), {1, 1, 1, 1});
        const osg::ref_ptr<osg::Material> green = new osg::Material;
        green->setDiffuse(osg::Material::FRONT_AND_BACK, {0.1f, 0.9f, 0.1f, 1.0f});
        ball->getOrCreateStateSet()->setAttribute(green, value);
        ball->getStateSet()->setMode(GL_LIGHTING, kOff | (value & osg::StateAttribute::PROTECTED));
        return placed(osg::Matrixd::translate(x, y, 0.0), ball);
    };
    const auto inner = groupOf(
        {ballWith(-1.2, 1.2, kOn), ballWith(1.2, 1.2, kOn | osg::StateAttribute::PROTECTED)});
    inner->getOrCreateStateSet()->setAttribute(shinyMaterial(),
                                               kOn | osg::StateAttribute::OVERRIDE);
    inner->getStateSet()->setMode(GL_LIGHTING, kOn | osg::StateAttribute::OVERRIDE);
    const auto root = groupOf(
        {inner, ballWith(-1.2, -1.2, kOn), ballWith(1.2, -1.2, osg::StateAttribute::INHERIT)});
    CHECK(matches("inheritance", root));
}
