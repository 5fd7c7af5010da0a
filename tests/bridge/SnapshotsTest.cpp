// SnapshotsTest.cpp - what two conversions of one graph share, and which stamps change.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include "osgRayTrace/bridge/geometry/HostArrays.h"

#include <osgRayTrace/AreaLight>

#include <osg/LightSource>
#include <osg/Material>
#include <osg/Texture2D>

using namespace osgRayTrace::engine;

namespace
{

struct TwoTriangles
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::Geometry> first = triangleGeometry();
    osg::ref_ptr<osg::Geometry> second = triangleGeometry();
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform;
    SceneConverter converter;

    TwoTriangles()
    {
        root->addChild(first);
        transform->addChild(second);
        root->addChild(transform);
    }
    std::shared_ptr<const Scene> convert() { return converter.convert(inputFor(root)).scene; }
};

} // namespace

TEST_CASE("an unchanged graph gives the same scene", "[bridge]")
{
    TwoTriangles graph;
    graph.root->addChild(new osgRayTrace::AreaLight);
    graph.root->addChild(new osg::LightSource);
    const auto scene = graph.convert();
    CHECK(graph.convert() == scene);
    CHECK(graph.convert() == scene);
}

TEST_CASE("a changed array or primitive set makes one new mesh", "[bridge]")
{
    TwoTriangles graph;
    const auto before = graph.convert();
    const auto checkSecondChanged = [&](const std::shared_ptr<const Scene>& old)
    {
        const auto after = graph.convert();
        REQUIRE(after->meshes.size() == 2);
        CHECK(after->meshes[0] == old->meshes[0]);
        CHECK(after->meshes[1] != old->meshes[1]);
        CHECK(after->meshes[1]->changed > old->meshes[1]->changed);
        CHECK(after->meshes[1]->changed == after->changed);
        CHECK(after->instances[0].changed == old->instances[0].changed);
        CHECK(after->instances[1].changed > old->instances[1].changed);
        CHECK(after->materials[0].changed == old->materials[0].changed);
        return after;
    };
    auto* vertices = static_cast<osg::Vec3Array*>(graph.second->getVertexArray());
    (*vertices)[1].x() = 2.0f;
    vertices->dirty();
    auto scene = checkSecondChanged(before);
    CHECK(scene->meshes[1]->positions[1].x == 2.0f);

    graph.second->setVertexArray(new osg::Vec3Array(*vertices));
    scene = checkSecondChanged(scene);
    osg::ref_ptr<osg::Vec3Array> normal = new osg::Vec3Array;
    normal->push_back({0.0f, 1.0f, 0.0f});
    graph.second->setNormalArray(normal, osg::Array::BIND_OVERALL);
    scene = checkSecondChanged(scene);
    graph.second->setPrimitiveSet(0, new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    scene = checkSecondChanged(scene);
    static_cast<osg::DrawArrays*>(graph.second->getPrimitiveSet(0))->setMode(GL_TRIANGLE_STRIP);
    scene = checkSecondChanged(scene);
    graph.second->setDataVariance(osg::Object::DYNAMIC);
    checkSecondChanged(scene);
}

TEST_CASE("a moved instance keeps its mesh, a changed material changes only itself", "[bridge]")
{
    TwoTriangles graph;
    graph.transform->removeChild(graph.second);
    graph.transform->addChild(graph.first);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    graph.transform->getOrCreateStateSet()->setAttribute(material);
    material->setColorMode(osg::Material::OFF);
    material->setDiffuse(osg::Material::FRONT_AND_BACK, {0.0f, 1.0f, 0.0f, 1.0f});
    const auto before = graph.convert();
    REQUIRE(before->meshes.size() == 1);
    REQUIRE(before->materials.size() == 2);

    graph.transform->setMatrix(osg::Matrixd::translate(1.0, 0.0, 0.0));
    const auto moved = graph.convert();
    CHECK(moved != before);
    CHECK(moved->meshes == before->meshes);
    CHECK(moved->instances[0].changed == before->instances[0].changed);
    CHECK(moved->instances[1].changed > before->instances[1].changed);

    material->setDiffuse(osg::Material::FRONT_AND_BACK, {1.0f, 0.0f, 0.0f, 1.0f});
    const auto painted = graph.convert();
    CHECK(painted->meshes == before->meshes);
    CHECK(painted->instances[1].changed == moved->instances[1].changed);
    CHECK(painted->materials[0].changed == moved->materials[0].changed);
    CHECK(painted->materials[1].changed > moved->materials[1].changed);
}

TEST_CASE("what has moved once has a mesh of its own, which is placed from then on", "[bridge]")
{
    TwoTriangles graph;
    const auto before = graph.convert();
    CHECK_FALSE(before->instances[1].placed);
    graph.transform->setMatrix(osg::Matrixd::translate(1.0, 0.0, 0.0));
    const auto first = graph.convert();
    REQUIRE(first->instances.size() == 2);
    CHECK_FALSE(first->instances[0].placed);
    CHECK(first->meshes[0] == before->meshes[0]);
    CHECK(first->instances[1].placed);
    CHECK(firstCorner(*first, 1) == Vec3(1.0f, 0.0f, 0.0f));
    graph.transform->setMatrix(osg::Matrixd::translate(2.0, 0.0, 0.0));
    const auto second = graph.convert();
    CHECK(second->meshes == first->meshes);
    CHECK(firstCorner(*second, 1) == Vec3(2.0f, 0.0f, 0.0f));
    graph.transform->setMatrix(osg::Matrixd());
    CHECK(graph.convert()->instances[1].placed);
}

TEST_CASE("a changed light or background changes the scene and no geometry", "[bridge]")
{
    TwoTriangles graph;
    ConversionInput input = inputFor(graph.root);
    osg::ref_ptr<osg::Light> light = new osg::Light(0);
    input.viewLight = light;
    const auto before = graph.converter.convert(input).scene;
    light->setDiffuse({0.1f, 0.1f, 0.1f, 1.0f});
    const auto lit = graph.converter.convert(input).scene;
    CHECK(lit->lights[0].changed > before->lights[0].changed);
    CHECK(lit->meshes == before->meshes);
    input.clearColor.set(1.0f, 0.0f, 0.0f, 1.0f);
    const auto red = graph.converter.convert(input).scene;
    CHECK(red->changed > lit->changed);
    CHECK(red->lights[0].changed == lit->lights[0].changed);
}

TEST_CASE("a texture is converted again only if its image changes", "[bridge]")
{
    TwoTriangles graph;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    for (const auto& geometry : {graph.first, graph.second})
    {
        geometry->setTexCoordArray(0, new osg::Vec2Array(3));
        geometry->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
    }
    const auto before = graph.convert();
    REQUIRE(before->textures.size() == 1);
    CHECK(graph.convert() == before);
    image->dirty();
    const auto after = graph.convert();
    CHECK(after->textures[0] != before->textures[0]);
    CHECK(after->textures[0]->changed > before->textures[0]->changed);
    CHECK(after->meshes == before->meshes);

    texture->setImage(nullptr); // released after the upload to OpenGL
    CHECK(graph.convert()->textures == after->textures);
}

TEST_CASE("removed geometry is forgotten, and its arrays are freed with the scene", "[bridge]")
{
    TwoTriangles graph;
    auto scene = graph.convert();
    osg::observer_ptr<osg::Array> array = graph.second->getVertexArray();
    graph.transform->removeChild(graph.second);
    graph.second = nullptr;
    scene = graph.convert();
    CHECK(scene->meshes.size() == 1);
    releaseHostArrays();
    CHECK_FALSE(array.valid());
}

TEST_CASE("forget: the next conversion reads everything again", "[bridge]")
{
    TwoTriangles graph;
    const auto before = graph.convert();
    (*static_cast<osg::Vec3Array*>(graph.first->getVertexArray()))[1].x() = 2.0f; // without dirty()
    CHECK(graph.convert() == before);
    graph.converter.forget();
    const auto after = graph.convert();
    CHECK(after->meshes[0] != before->meshes[0]);
    CHECK(after->meshes[0]->changed > before->meshes[0]->changed);
}
