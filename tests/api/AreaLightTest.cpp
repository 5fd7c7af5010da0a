// AreaLightTest.cpp - tests of the area light as a node of a graph.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"

#include <osgRayTrace/AreaLight>

#include <osg/ComputeBoundsVisitor>
#include <osg/CullFace>
#include <osg/Geode>
#include <osg/Group>
#include <osgUtil/CullVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/Optimizer>
#include <osgUtil/RenderStage>
#include <osgUtil/Statistics>

#include <cmath>
#include <limits>

using osgRayTrace::AreaLight;

namespace
{

osg::ref_ptr<AreaLight> ceilingLight()
{
    return new AreaLight(osg::Vec3(1.0f, 2.0f, 3.0f), osg::Vec3(0.0f, 4.0f, 0.0f),
                         osg::Vec3(2.0f, 0.0f, 0.0f), osg::Vec3(5.0f, 0.5f, 0.0f));
}

osg::BoundingBox boxOf(osg::Node& node)
{
    osg::ComputeBoundsVisitor visitor;
    node.accept(visitor);
    return visitor.getBoundingBox();
}

osg::Vec3 normalOf(const AreaLight& light)
{
    return static_cast<const osg::Vec3Array&>(*light.getGeometry()->getNormalArray())[0];
}

osg::Vec4 colorOf(const AreaLight& light)
{
    return static_cast<const osg::Vec4Array&>(*light.getGeometry()->getColorArray())[0];
}

/// Computes the world-space box of the light from its own vectors and its path in the graph.
class LightBox : public osg::NodeVisitor
{
public:
    LightBox() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Node& node) override
    {
        if (auto* light = dynamic_cast<AreaLight*>(&node))
        {
            const osg::Matrix toWorld = osg::computeLocalToWorld(getNodePath());
            box.expandBy(light->getCorner() * toWorld);
            box.expandBy((light->getCorner() + light->getEdgeU() + light->getEdgeV()) * toWorld);
        }
        traverse(node);
    }
    osg::BoundingBox box;
};

} // namespace

TEST_CASE("area light: bounds are those of the parallelogram", "[api][arealight]")
{
    const auto light = ceilingLight();
    const osg::BoundingBox box = boxOf(*light);
    CHECK(box._min == osg::Vec3(1.0f, 2.0f, 3.0f));
    CHECK(box._max == osg::Vec3(3.0f, 6.0f, 3.0f));
    CHECK(light->getBound().center() == osg::BoundingSphere::vec_type(2.0, 4.0, 3.0));
    CHECK(light->getBound().radius() == Approx(std::sqrt(5.0)));

    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(light);
    CHECK(group->getBound().center().z() == Approx(3.0));
    light->setCorner(osg::Vec3(1.0f, 2.0f, 10.0f));
    CHECK(group->getBound().center().z() == Approx(10.0));
    CHECK(boxOf(*group)._max.z() == 10.0f);
}

TEST_CASE("area light: the quad's front is cross(edgeU, edgeV)", "[api][arealight]")
{
    const auto light = ceilingLight();
    CHECK(normalOf(*light) == osg::Vec3(0.0f, 0.0f, -1.0f));

    const auto& vertices =
        static_cast<const osg::Vec3Array&>(*light->getGeometry()->getVertexArray());
    REQUIRE(vertices.size() == 4);
    const osg::Vec3 winding = (vertices[1] - vertices[0]) ^ (vertices[2] - vertices[0]);
    CHECK(winding * normalOf(*light) > 0.0f);
    const osg::Vec3 second = (vertices[1] - vertices[2]) ^ (vertices[3] - vertices[2]);
    CHECK(second * normalOf(*light) > 0.0f);
}

TEST_CASE("area light: the quad shows the radiance encoded, and the side", "[api][arealight]")
{
    const auto light = ceilingLight();
    CHECK(colorOf(*light).r() == Approx(1.0f));                    // 5 is clamped
    CHECK(colorOf(*light).g() == Approx(0.7353569f).margin(1e-5)); // sRGB of 0.5
    CHECK(colorOf(*light).b() == 0.0f);

    const auto culled = [&light]
    {
        const osg::StateSet& state = *light->getGeometry()->getStateSet();
        return (state.getMode(GL_CULL_FACE) & osg::StateAttribute::ON) != 0;
    };
    CHECK(culled());
    light->setTwoSided(true);
    CHECK_FALSE(culled());
    CHECK((light->getGeometry()->getStateSet()->getMode(GL_LIGHTING) & osg::StateAttribute::ON) ==
          0);
    light->setTwoSided(false);
    CHECK(culled());
}

TEST_CASE("area light: values that are not finite are refused", "[api][arealight]")
{
    const auto light = ceilingLight();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    light->setCorner(osg::Vec3(nan, 0.0f, 0.0f));
    light->setEdgeU(osg::Vec3(0.0f, infinity, 0.0f));
    light->setEdgeV(osg::Vec3(0.0f, 0.0f, -infinity));
    light->setRadiance(osg::Vec3(nan, nan, nan));
    CHECK(light->getCorner() == osg::Vec3(1.0f, 2.0f, 3.0f));
    CHECK(light->getEdgeU() == osg::Vec3(0.0f, 4.0f, 0.0f));
    CHECK(light->getEdgeV() == osg::Vec3(2.0f, 0.0f, 0.0f));
    CHECK(light->getRadiance() == osg::Vec3(5.0f, 0.5f, 0.0f));
    light->setRadiance(osg::Vec3(-1.0f, 2.0f, 3.0f));
    CHECK(light->getRadiance() == osg::Vec3(0.0f, 2.0f, 3.0f));

    light->setEdgeU(osg::Vec3());
    CHECK(normalOf(*light) == osg::Vec3());
    CHECK(light->getBound().valid());
}

TEST_CASE("area light: a copy has its own quad", "[api][arealight]")
{
    const auto light = ceilingLight();
    light->setTwoSided(true);
    light->setName("lamp");
    for (const unsigned int flags : {osg::CopyOp::SHALLOW_COPY, osg::CopyOp::DEEP_COPY_ALL})
    {
        const osg::ref_ptr<osg::Object> clone = light->clone(osg::CopyOp(flags));
        auto* copy = dynamic_cast<AreaLight*>(clone.get());
        REQUIRE(copy);
        CHECK(copy->getName() == "lamp");
        CHECK(copy->getCorner() == light->getCorner());
        CHECK(copy->getEdgeU() == light->getEdgeU());
        CHECK(copy->getEdgeV() == light->getEdgeV());
        CHECK(copy->getRadiance() == light->getRadiance());
        CHECK(copy->getTwoSided());
        CHECK(copy->getGeometry() != light->getGeometry());
        CHECK(normalOf(*copy) == normalOf(*light));
        CHECK(colorOf(*copy) == colorOf(*light));
        CHECK(boxOf(*copy)._max == boxOf(*light)._max);

        copy->setCorner(osg::Vec3());
        CHECK(boxOf(*light)._min == osg::Vec3(1.0f, 2.0f, 3.0f));
    }
}

TEST_CASE("area light: rays and cull find the quad below transforms", "[api][arealight]")
{
    const osg::ref_ptr<osg::MatrixTransform> root =
        new osg::MatrixTransform(osg::Matrix::translate(10.0, 0.0, 0.0));
    root->addChild(ceilingLight());

    const osg::ref_ptr<osgUtil::LineSegmentIntersector> segment =
        new osgUtil::LineSegmentIntersector(osg::Vec3d(12.0, 4.0, 0.0), osg::Vec3d(12.0, 4.0, 9.0));
    osgUtil::IntersectionVisitor picker(segment);
    root->accept(picker);
    REQUIRE(segment->containsIntersections());
    const osg::Vec3d hit = segment->getFirstIntersection().getWorldIntersectPoint();
    CHECK((hit - osg::Vec3d(12.0, 4.0, 3.0)).length() < 1e-5);

    const osg::ref_ptr<osgUtil::CullVisitor> cull = new osgUtil::CullVisitor;
    const osg::ref_ptr<osgUtil::StateGraph> states = new osgUtil::StateGraph;
    const osg::ref_ptr<osgUtil::RenderStage> stage = new osgUtil::RenderStage;
    cull->setStateGraph(states);
    cull->setRenderStage(stage);
    cull->pushViewport(new osg::Viewport(0, 0, 100, 100));
    cull->pushProjectionMatrix(new osg::RefMatrix(osg::Matrix::perspective(60.0, 1.0, 0.1, 100.0)));
    cull->pushModelViewMatrix(new osg::RefMatrix(osg::Matrix::lookAt(osg::Vec3d(12.0, 4.0, -10.0),
                                                                     osg::Vec3d(12.0, 4.0, 0.0),
                                                                     osg::Vec3d(0.0, 1.0, 0.0))),
                              osg::Transform::ABSOLUTE_RF);
    root->accept(*cull);
    cull->popModelViewMatrix();
    cull->popProjectionMatrix();
    cull->popViewport();
    osgUtil::Statistics statistics;
    stage->getStats(statistics);
    CHECK(statistics.numDrawables == 1);
}

TEST_CASE("area light: a node mask hides it", "[api][arealight]")
{
    const auto light = ceilingLight();
    light->setNodeMask(0);
    CHECK_FALSE(boxOf(*light).valid());
}

TEST_CASE("area light: OSG's optimizer leaves it where it is", "[api][arealight]")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osg::MatrixTransform> outer =
        new osg::MatrixTransform(osg::Matrix::translate(0.0, 0.0, 100.0));
    const osg::ref_ptr<osg::MatrixTransform> inner =
        new osg::MatrixTransform(osg::Matrix::rotate(osg::PI_2, 1.0, 0.0, 0.0));
    const osg::ref_ptr<osg::Geode> floor = new osg::Geode;
    floor->addDrawable(osg::createTexturedQuadGeometry(osg::Vec3(), osg::Vec3(1.0f, 0.0f, 0.0f),
                                                       osg::Vec3(0.0f, 1.0f, 0.0f)));
    outer->setDataVariance(osg::Object::STATIC); // as OSG's rot, scale and trans loaders set it
    inner->setDataVariance(osg::Object::STATIC);
    root->addChild(outer);
    outer->addChild(inner);
    inner->addChild(ceilingLight());
    inner->addChild(floor);

    LightBox before;
    root->accept(before);
    osgUtil::Optimizer().optimize(root);
    LightBox after;
    root->accept(after);
    CHECK((before.box._min - after.box._min).length() < 1e-4f);
    CHECK((before.box._max - after.box._max).length() < 1e-4f);
    CHECK((boxOf(*root)._min - osg::Vec3(0.0f, -3.0f, 100.0f)).length() < 1e-4f);
    CHECK((boxOf(*root)._max - osg::Vec3(3.0f, 0.0f, 106.0f)).length() < 1e-4f);
}

TEST_CASE("area light: GL objects can be released and resized at any time", "[api][arealight]")
{
    const auto light = ceilingLight();
    light->releaseGLObjects();
    light->resizeGLObjectBuffers(8);
    light->releaseGLObjects();
    light->setTwoSided(true);
    light->releaseGLObjects();
    CHECK(light->getGeometry()->getStateSet() != nullptr);
}
