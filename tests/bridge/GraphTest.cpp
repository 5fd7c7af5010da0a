// GraphTest.cpp - which parts of a graph are visible, where they are, and what becomes an instance.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include <osg/AutoTransform>
#include <osg/Billboard>
#include <osg/Camera>
#include <osg/LOD>
#include <osg/PositionAttitudeTransform>
#include <osg/Projection>
#include <osg/Sequence>
#include <osg/ShapeDrawable>
#include <osg/Switch>
#include <osgParticle/ModularEmitter>
#include <osgParticle/ModularProgram>
#include <osgParticle/ParticleSystem>
#include <osgParticle/ParticleSystemUpdater>
#include <osgParticle/PrecipitationEffect>
#include <osgSim/DOFTransform>
#include <osgSim/MultiSwitch>
#include <osgText/Text>

#include <cmath>
#include <limits>

using namespace osgRayTrace::engine;

namespace
{

/// Returns a triangle whose first corner is (x, 0, 0).
osg::ref_ptr<osg::Node> triangleAt(double x)
{
    return placed(osg::Matrixd::translate(x, 0.0, 0.0), triangleGeometry());
}

std::vector<float> visibleAt(const ConversionResult& result)
{
    std::vector<float> xs;
    for (std::size_t i = 0; i < result.scene->instances.size(); ++i)
        xs.push_back(firstCorner(*result.scene, i).x);
    return xs;
}

/// Returns how far the corner is from the place that OSG's own matrix of the path gives.
float cornerError(osg::Transform* transform)
{
    transform->addChild(triangleGeometry());
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(transform);
    const ConversionResult result = convertGraph(root);
    REQUIRE(result.scene->instances.size() == 1);
    const osg::Matrixd world = osg::computeLocalToWorld({root.get(), transform});
    const Mesh& mesh = soleMesh(result);
    float error = 0.0f;
    const osg::Vec3d corners[] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    for (std::size_t i = 0; i < 3; ++i)
    {
        const osg::Vec3d p = corners[i] * world;
        error = std::max(error, glm::length(mesh.positions[i] - Vec3(p.x(), p.y(), p.z())));
    }
    return error;
}

} // namespace

TEST_CASE("transforms of every kind place geometry as OSG does", "[bridge]")
{
    osg::ref_ptr<osg::PositionAttitudeTransform> attitude = new osg::PositionAttitudeTransform;
    attitude->setPosition({1.0, 2.0, 3.0});
    attitude->setPivotPoint({0.5, 0.0, 0.0});
    attitude->setScale({1.0, -2.0, 3.0});
    attitude->setAttitude(osg::Quat(0.7, osg::Vec3d(1.0, 1.0, 0.0)));
    CHECK(cornerError(attitude) < 1e-6f);

    osg::ref_ptr<osgSim::DOFTransform> joint = new osgSim::DOFTransform;
    joint->setPutMatrix(osg::Matrixd::translate(4.0, 0.0, 0.0));
    joint->setCurrentScale({1.0f, 2.0f, 1.0f});
    joint->setCurrentHPR({0.3f, 0.2f, 0.1f});
    joint->setCurrentTranslate({0.0f, 1.0f, 0.0f});
    CHECK(cornerError(joint) < 1e-6f);

    osg::ref_ptr<osg::AutoTransform> automatic = new osg::AutoTransform;
    automatic->setPosition({1.0, 2.0, 3.0});
    automatic->setAutoRotateMode(osg::AutoTransform::ROTATE_TO_CAMERA);
    CHECK(cornerError(automatic) < 1e-6f);

    osg::ref_ptr<osg::MatrixTransform> absolute =
        new osg::MatrixTransform(osg::Matrixd::translate(9.0, 0.0, 0.0));
    absolute->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    const auto nested = placed(osg::Matrixd::translate(100.0, 0.0, 0.0), absolute);
    absolute->addChild(triangleGeometry());
    const ConversionResult result = convertGraph(nested);
    CHECK(visibleAt(result) == std::vector<float>{9.0f});
    CHECK(countOf(result, "approximated.absolute-transform") == 1);
}

TEST_CASE("nested transforms at earth radius keep float precision near the origin", "[bridge]")
{
    const double radius = 6.378137e6;
    auto node = placed(osg::Matrixd::translate(0.25, 0.0, 0.0), triangleGeometry());
    node = placed(osg::Matrixd::rotate(0.1, osg::Vec3d(0.0, 0.0, 1.0)), node);
    node = placed(osg::Matrixd::translate(radius, radius, 0.125), node);
    node = placed(osg::Matrixd::rotate(1.0, osg::Vec3d(0.3, 0.2, 0.9)), node);
    const osg::Matrixd world = osg::Matrixd::translate(0.25, 0.0, 0.0) *
                               osg::Matrixd::rotate(0.1, osg::Vec3d(0.0, 0.0, 1.0)) *
                               osg::Matrixd::translate(radius, radius, 0.125) *
                               osg::Matrixd::rotate(1.0, osg::Vec3d(0.3, 0.2, 0.9));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(node);

    ConversionInput input = inputFor(root);
    input.eye = input.origin = osg::Vec3d(1.0, 1.0, 1.0) + osg::Vec3d() * world;
    SceneConverter converter;
    const auto check = [&](const ConversionResult& result)
    {
        const osg::Vec3d expected = osg::Vec3d() * world - input.origin;
        const Vec3 got = firstCorner(*result.scene, 0);
        CHECK(glm::length(got - Vec3(expected.x(), expected.y(), expected.z())) < 1e-6f);
        CHECK(result.scene->origin.x == input.origin.x());
    };
    check(converter.convert(input));
    root->addChild(placed(osg::Matrixd::translate(5.0, 0.0, 0.0), node)); // now an instance
    const ConversionResult instanced = converter.convert(input);
    CHECK(instanced.scene->instances[0].placed);
    check(instanced);
}

TEST_CASE("shared geometry with large local coordinates in double keeps its shape", "[bridge]")
{
    osg::ref_ptr<osg::Vec3dArray> vertices = new osg::Vec3dArray;
    vertices->push_back({6.0e6, 0.0, 0.0});
    vertices->push_back({6.0e6 + 0.1, 0.0, 0.0});
    vertices->push_back({6.0e6, 0.1, 0.0});
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(geometry);
    root->addChild(placed(osg::Matrixd::translate(0.0, 0.0, 1.0), geometry));
    ConversionInput input = inputFor(root);
    input.origin.set(6.0e6, 0.0, 0.0);
    SceneConverter converter;
    const ConversionResult result = converter.convert(input);
    REQUIRE(result.scene->instances.size() == 2);
    REQUIRE(result.scene->meshes.size() == 1);
    const Instance& second = result.scene->instances[1];
    const Mesh& mesh = *result.scene->meshes[0];
    CHECK(glm::length(transformPoint(second.engineFromLocal, mesh.positions[1]) -
                      Vec3(0.1f, 0.0f, 1.0f)) < 1e-6f);
    CHECK(glm::length(transformPoint(second.engineFromLocal, mesh.positions[2]) -
                      Vec3(0.0f, 0.1f, 1.0f)) < 1e-6f);
}

TEST_CASE("singular, projective and not finite transforms are skipped and counted",
          "[bridge][stability 15]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(placed(osg::Matrixd::scale(1.0, 0.0, 0.0), triangleGeometry()));
    root->addChild(placed(osg::Matrixd::scale(0.0, 0.0, 0.0), triangleGeometry()));
    root->addChild(placed(osg::Matrixd::translate(std::nan(""), 0.0, 0.0), triangleGeometry()));
    osg::Matrixd infinite;
    infinite(0, 0) = std::numeric_limits<double>::infinity();
    root->addChild(placed(infinite, triangleGeometry()));
    root->addChild(placed(osg::Matrixd::perspective(40.0, 1.0, 1.0, 10.0), triangleGeometry()));
    root->addChild(placed(osg::Matrixd::scale(1.0, 1.0, 1e-9), triangleGeometry()));
    const ConversionResult result = convertGraph(root);
    CHECK(result.scene->instances.size() == 1);
    CHECK(countOf(result, "skipped.singular-transform") == 2);
    CHECK(countOf(result, "skipped.not-finite-transform") == 2);
    CHECK(countOf(result, "skipped.projective-transform") == 1);
}

TEST_CASE("shared geometry becomes one mesh with placed instances, single use is baked", "[bridge]")
{
    const auto shared = triangleGeometry();
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(placed(osg::Matrixd::translate(1.0, 0.0, 0.0), shared));
    root->addChild(placed(
        osg::Matrixd::scale(-1.0, 2.0, 2.0) * osg::Matrixd::translate(5.0, 0.0, 0.0), shared));
    root->addChild(triangleAt(3.0));
    const ConversionResult result = convertGraph(root);
    REQUIRE(result.scene->instances.size() == 3);
    const auto& instances = result.scene->instances;
    CHECK(instances[1].placed);
    CHECK(instances[2].placed);
    CHECK(instances[1].mesh == instances[2].mesh);
    CHECK_FALSE(instances[1].mirrored);
    CHECK(instances[2].mirrored);
    const Mat3 normalFromLocal = normalMatrix(instances[2].engineFromLocal.linear);
    CHECK(glm::length(normalFromLocal * Vec3(1.0f, 0.0f, 0.0f) - Vec3(-1.0f, 0.0f, 0.0f)) < 1e-6f);
    CHECK(glm::length(normalFromLocal * Vec3(0.0f, 1.0f, 0.0f) - Vec3(0.0f, 0.5f, 0.0f)) < 1e-6f);
    CHECK_FALSE(instances[0].placed);
    CHECK(visibleAt(result) == std::vector<float>{3.0f, 1.0f, 5.0f}); // those in place come first
}

TEST_CASE("a use of shared geometry that Embree could not invert is baked", "[bridge]")
{
    const auto shared = triangleGeometry();
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(shared);
    root->addChild(placed(osg::Matrixd::scale(1e-10, 1e-10, 1e-10), shared));
    SceneConverter converter;
    const ConversionResult result = converter.convert(inputFor(root));
    REQUIRE(result.scene->instances.size() == 2);
    CHECK_FALSE(result.scene->instances[0].placed);
    CHECK(result.scene->instances[1].placed);
    CHECK(result.scene->meshes[result.scene->instances[0].mesh]->positions[1].x == Approx(1e-10f));
    CHECK(converter.convert(inputFor(root)).scene == result.scene);
}

TEST_CASE("node masks, switches and sequences hide what they hide in OSG", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    const auto masked = triangleAt(1.0);
    masked->setNodeMask(0x2);
    root->addChild(masked);
    const auto geometry = triangleGeometry();
    geometry->setNodeMask(0x0);
    root->addChild(geometry);

    osg::ref_ptr<osg::Switch> choice = new osg::Switch;
    choice->addChild(triangleAt(2.0), false);
    choice->addChild(triangleAt(3.0), true);
    root->addChild(choice);

    osg::ref_ptr<osgSim::MultiSwitch> multi = new osgSim::MultiSwitch;
    multi->addChild(triangleAt(4.0));
    multi->addChild(triangleAt(5.0));
    multi->setSingleChildOn(0, 1);
    root->addChild(multi);

    osg::ref_ptr<osg::Sequence> sequence = new osg::Sequence;
    sequence->addChild(triangleAt(6.0), 1.0);
    sequence->addChild(triangleAt(7.0), 1.0);
    sequence->setValue(1);
    root->addChild(sequence);

    CHECK(visibleAt(convertGraph(root)) == std::vector<float>{1.0f, 3.0f, 5.0f, 7.0f});

    ConversionInput input = inputFor(root);
    input.traversalMask = 0x1;
    SceneConverter converter;
    CHECK(visibleAt(converter.convert(input)) == std::vector<float>{3.0f, 5.0f, 7.0f});

    root->setNodeMask(0x2);
    CHECK(converter.convert(input).scene->instances.empty());
}

TEST_CASE("levels of detail: the child for the eye's distance, in the LOD's own coordinates",
          "[bridge]")
{
    osg::ref_ptr<osg::LOD> lod = new osg::LOD;
    lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
    lod->setCenter({0.0f, 0.0f, 0.0f});
    lod->setRadius(1.0f);
    lod->addChild(triangleAt(0.0), 0.0f, 10.0f);
    lod->addChild(triangleAt(1.0), 10.0f, 100.0f);
    const auto root =
        placed(osg::Matrixd::scale(2.0, 2.0, 2.0) * osg::Matrixd::translate(6.0e6, 0.0, 0.0), lod);
    ConversionInput input = inputFor(root);
    input.origin.set(6.0e6, 0.0, 0.0);
    SceneConverter converter;
    const auto visibleFrom = [&](double distance)
    {
        input.eye.set(6.0e6 + distance, 0.0, 0.0);
        return visibleAt(converter.convert(input));
    };
    CHECK(visibleFrom(19.0) == std::vector<float>{0.0f}); // 9.5 in local units
    CHECK(visibleFrom(21.0) == std::vector<float>{2.0f});
    CHECK(visibleFrom(201.0).empty());

    lod->setRangeMode(osg::LOD::PIXEL_SIZE_ON_SCREEN); // the finest level is taken
    CHECK(visibleFrom(50.0) == std::vector<float>{2.0f});
}

TEST_CASE("billboards turn to the eye", "[bridge]")
{
    osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard; // axis z, normal -y
    osg::ref_ptr<osg::Geometry> quad = osg::createTexturedQuadGeometry(
        {-1.0f, 0.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f});
    billboard->addDrawable(quad, {10.0f, 0.0f, 0.0f});
    billboard->addDrawable(quad, {20.0f, 0.0f, 0.0f});
    ConversionInput input = inputFor(billboard);
    input.eye.set(-100.0, 0.0, 0.0);
    SceneConverter converter;
    const ConversionResult result = converter.convert(input);
    REQUIRE(result.scene->instances.size() == 2);
    for (std::size_t i = 0; i < 2; ++i)
    {
        const Vec3 corner = firstCorner(*result.scene, i);
        CHECK(corner.x == Approx(10.0f * (i + 1)));
        CHECK(std::fabs(corner.y) == Approx(1.0f));
    }
}

TEST_CASE("cameras and projections inside the graph are not part of the scene", "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osg::Camera> hud = new osg::Camera;
    hud->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    hud->setRenderOrder(osg::Camera::POST_RENDER);
    hud->addChild(triangleAt(1.0));
    root->addChild(hud);
    osg::ref_ptr<osg::Camera> target = new osg::Camera;
    target->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    target->setRenderOrder(osg::Camera::PRE_RENDER);
    target->addChild(triangleAt(2.0));
    root->addChild(target);
    osg::ref_ptr<osg::Projection> projection =
        new osg::Projection(osg::Matrixd::ortho2D(0, 1, 0, 1));
    projection->addChild(triangleAt(3.0));
    root->addChild(projection);
    osg::ref_ptr<osg::Camera> nested = new osg::Camera;
    nested->setRenderOrder(osg::Camera::NESTED_RENDER);
    nested->setViewMatrix(osg::Matrixd::translate(4.0, 0.0, 0.0));
    nested->addChild(triangleGeometry());
    root->addChild(nested);

    ConversionResult result = convertGraph(root);
    CHECK(visibleAt(result) == std::vector<float>{4.0f});
    CHECK(countOf(result, "not-traced.hud-camera") == 1);
    CHECK(countOf(result, "not-traced.render-to-texture-camera") == 1);
    CHECK(countOf(result, "not-traced.projection") == 1);

    // A viewer's camera that is given as the root is only a group.
    osg::ref_ptr<osg::Camera> viewer = new osg::Camera;
    viewer->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
    viewer->setViewMatrix(osg::Matrixd::translate(0.0, 0.0, -10.0));
    viewer->setProjectionMatrixAsPerspective(30.0, 1.0, 1.0, 100.0);
    viewer->addChild(triangleAt(1.0));
    result = convertGraph(viewer);
    CHECK(visibleAt(result) == std::vector<float>{1.0f});
    CHECK(firstCorner(*result.scene, 0).z == 0.0f);
}

TEST_CASE("text, particles and custom drawables are counted, shapes are traced", "[bridge]")
{
    struct Custom : public osg::Drawable
    {
        void drawImplementation(osg::RenderInfo&) const override {}
    };
    osg::ref_ptr<osg::Geode> root = new osg::Geode;
    osg::ref_ptr<osgText::Text> text = new osgText::Text;
    text->setText("solid boxes");
    root->addDrawable(text);
    root->addDrawable(new osgParticle::ParticleSystem);
    root->addDrawable(new Custom);
    root->addDrawable(new osg::ShapeDrawable(new osg::Box(osg::Vec3(), 1.0f)));
    const ConversionResult result = convertGraph(root);
    CHECK(countOf(result, "not-traced.text") == 1);
    CHECK(countOf(result, "not-traced.particles") == 1);
    CHECK(countOf(result, "not-traced.custom-drawable") == 1);
    REQUIRE(countOf(result, "converted.geometry") == 1);
    CHECK(soleMesh(result).triangles.size() == 12);
    CHECK(soleMesh(result).normals.size() == soleMesh(result).positions.size());
}

TEST_CASE("what moves particles is not seen, and not counted as something that is not traced",
          "[bridge]")
{
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    root->addChild(new osgParticle::ModularEmitter);
    root->addChild(new osgParticle::ModularProgram);
    root->addChild(new osgParticle::ParticleSystemUpdater);
    CHECK(countOf(convertGraph(root), "not-traced.custom-node") == 0);
    CHECK(countOf(convertGraph(root), "not-traced.particles") == 0);
    root->addChild(new osgParticle::PrecipitationEffect); // this node is visible
    CHECK(countOf(convertGraph(root), "not-traced.particles") == 1);
    // OSG goes on drawing all of these nodes in a viewer.
    ConversionInput input = inputFor(root);
    input.rasterizesRest = true;
    SceneConverter converter;
    const ConversionResult result = converter.convert(input);
    REQUIRE(result.rasterized);
    CHECK(result.rasterized->size() == 4);
}

TEST_CASE("names are node paths of the first use", "[bridge]")
{
    const auto geometry = triangleGeometry();
    geometry->setName("roof");
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->setName("town");
    osg::ref_ptr<osg::Group> house = new osg::Group;
    house->addChild(geometry);
    root->addChild(house);
    root->addChild(geometry);
    CHECK(soleMesh(convertGraph(root)).name == "town/Group/roof");
}

TEST_CASE("thousands of nested groups do not overflow the stack", "[bridge]")
{
    osg::ref_ptr<osg::Node> node = triangleGeometry();
    for (int i = 0; i < 10000; ++i)
    {
        if (i == 4900) CHECK(convertGraph(node).scene->instances.size() == 1);
        osg::ref_ptr<osg::Group> group = new osg::Group;
        if (i % 2 == 0) group->getOrCreateStateSet()->setMode(GL_LIGHTING, i % 4 == 0);
        group->addChild(node);
        node = group;
    }
    const ConversionResult tooDeep = convertGraph(node);
    CHECK(tooDeep.scene->instances.empty());
    CHECK(countOf(tooDeep, "skipped.too-deep") == 1);
}
