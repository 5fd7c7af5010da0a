// SceneExtentTest.cpp - the unit of length that a scene is converted to.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/bridge/Graphs.h"

#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"

#include <osgRayTrace/AreaLight>

#include <cmath>
#include <limits>

using namespace osgRayTrace::engine;

namespace
{

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

osg::ref_ptr<osg::Group> scaledTriangle(double scale)
{
    return placed(osg::Matrixd::scale(scale, scale, scale), triangleGeometry());
}

double largestCoordinateOf(const Scene& scene)
{
    double largest = 0.0;
    for (const Instance& instance : scene.instances)
        for (Vec3 p : scene.meshes.at(instance.mesh)->positions)
        {
            if (instance.placed) p = transformPoint(instance.engineFromLocal, p);
            for (int k = 0; k < 3; ++k)
                largest = std::max(largest, double(std::fabs(p[k])));
        }
    return largest;
}

} // namespace

TEST_CASE("stability 3: scenes of ordinary size keep their unit and share their arrays", "[bridge]")
{
    for (const double scale : {0x1p-15, 1e-4, 1.0, 1e6, 1e9})
        CHECK(convertGraph(scaledTriangle(scale)).scene->unit == 1.0);

    const osg::ref_ptr<osg::Geometry> geometry = triangleGeometry();
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(geometry);
    const ConversionResult result = convertGraph(root);
    CHECK(result.scene->unit == 1.0);
    CHECK(static_cast<const void*>(soleMesh(result).positions.data()) ==
          geometry->getVertexArray()->getDataPointer());
}

TEST_CASE("stability 3: small and large scenes get a power of two", "[bridge]")
{
    for (const double scale : {1e-100, 1e-20, 1e-12, 1e-6, 1e10, 1e12, 1e18, 1e100})
    {
        CAPTURE(scale);
        const auto scene = convertGraph(scaledTriangle(scale)).scene;
        CHECK(std::exp2(std::ilogb(scene->unit)) == scene->unit);
        const double extent = largestCoordinateOf(*scene);
        CHECK(extent * scene->unit == Approx(scale));
        CHECK(extent >= (scale < 1.0 ? 1.0 : 0x1p31));
        CHECK(extent < (scale < 1.0 ? 2.0 : 0x1p32));
    }
}

TEST_CASE("stability 3: the unit is that of the distance to the origin, not of the float bounds",
          "[bridge]")
{
    // The corners are closer together than the floats at this place.
    const osg::ref_ptr<osg::Vec3dArray> vertices = new osg::Vec3dArray;
    const osg::Vec3d place(6378137.0, 0.0, 0.0);
    const double size = 0x1p-24;
    for (const osg::Vec3d& p :
         {osg::Vec3d(), osg::Vec3d(size, 0.0, 0.0), osg::Vec3d(0.0, size, 0.0)})
        vertices->push_back(place + p);
    const osg::ref_ptr<osg::Geometry> geometry = triangleGeometry();
    geometry->setVertexArray(vertices);
    ConversionInput input = inputFor(geometry);
    input.eye = input.origin = place;
    SceneConverter converter;
    CHECK(converter.convert(input).scene->unit == 0x1p-24);
}

TEST_CASE("stability 3: the lights go with the unit", "[bridge]")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(scaledTriangle(0x1p-40));
    root->addChild(new osgRayTrace::AreaLight({0.0f, 0.0f, 0x1p-40f}, {0x1p-42f, 0.0f, 0.0f},
                                              {0.0f, 0x1p-42f, 0.0f}, {1.0f, 2.0f, 3.0f}));
    ConversionInput input = inputFor(root);
    const osg::ref_ptr<osg::Light> light = new osg::Light;
    light->setLightNum(0);
    light->setPosition({0x1p-41f, 0.0f, 0x1p-40f, 1.0f});
    light->setLinearAttenuation(0x1p40f);
    light->setQuadraticAttenuation(0x1p80f);
    input.viewLight = light;
    for (const bool eyeSpace : {false, true})
    {
        input.viewLightInEyeSpace = eyeSpace;
        SceneConverter converter;
        const auto scene = converter.convert(input).scene;
        REQUIRE(scene->unit == 0x1p-40);
        REQUIRE(scene->lights.size() == 2);
        const Light& area = scene->lights[0];
        CHECK(area.corner == Vec3(0.0f, 0.0f, 1.0f));
        CHECK(area.edgeU == Vec3(0.25f, 0.0f, 0.0f));
        CHECK(area.radiance == Vec3(1.0f, 2.0f, 3.0f));
        const Light& point = scene->lights[1];
        // The session, which has the camera's matrix, places lights of eye space.
        CHECK(point.position ==
              (eyeSpace ? Vec3(0x1p-41f, 0.0f, 0x1p-40f) : Vec3(0.5f, 0.0f, 1.0f)));
        CHECK(point.attenuationLinear == 1.0f);
        CHECK(point.attenuationQuadratic == 1.0f);
    }
}

TEST_CASE("stability 3: shared geometry has a mesh of about 1, whoever scales it", "[bridge]")
{
    for (const double inVertices : {0x1p-60, 0x1p-40, 0x1p-20, 1.0, 0x1p20})
    {
        const double inTransform = 0x1p-40 / inVertices;
        CAPTURE(inVertices);
        const osg::ref_ptr<osg::Geometry> geometry = triangleGeometry();
        auto& vertices = static_cast<osg::Vec3Array&>(*geometry->getVertexArray());
        for (osg::Vec3& vertex : vertices)
            vertex *= static_cast<float>(inVertices);
        const auto scale = osg::Matrixd::scale(inTransform, inTransform, inTransform);
        const osg::ref_ptr<osg::Group> root = new osg::Group;
        root->addChild(placed(scale, geometry));
        root->addChild(placed(scale * osg::Matrixd::translate(0x1p-40, 0.0, 0.0), geometry));
        const auto scene = convertGraph(root).scene;
        CHECK(scene->unit == 0x1p-39);
        REQUIRE(scene->instances.size() == 2);
        CHECK(scene->instances[0].placed);
        CHECK(scene->meshes.size() == 1);
        CHECK(largestCoordinateOf(*scene) == 1.0);
    }
}

TEST_CASE("stability 13: a few wild vertices do not change the unit", "[bridge]")
{
    for (const float wild : {1e17f, 1e30f, -3e38f, kNaN, kInfinity})
    {
        for (const double scale : {1.0, 0x1p-40})
        {
            CAPTURE(wild, scale);
            const osg::ref_ptr<osg::Geometry> geometry =
                curveGeometry(12, new osg::DrawArrays(GL_TRIANGLES, 0, 12));
            auto& vertices = static_cast<osg::Vec3Array&>(*geometry->getVertexArray());
            vertices[4].y() = wild;
            const auto root = placed(osg::Matrixd::scale(scale, scale, scale), geometry);
            // The largest coordinate is 121.
            CHECK(convertGraph(root).scene->unit == (scale == 1.0 ? 1.0 : 64.0 * scale));
        }
    }
}

TEST_CASE("stability 2: coarse floats are told from fine ones", "[bridge]")
{
    const auto isCoarse = [](double size, double place)
    {
        const VertexBounds bounds{Vec3d(place, 0.0, 0.0), Vec3d(place + size, size, size), 8};
        return areCoarseInFloat(bounds);
    };
    CHECK_FALSE(isCoarse(1.0, 0.0));
    CHECK_FALSE(isCoarse(1.0, 1e3));
    CHECK(isCoarse(1.0, 1e5));
    CHECK(isCoarse(10.0, 6.4e6));
    CHECK(isCoarse(1e-6, 1.0));
    CHECK_FALSE(isCoarse(1e4, 6.4e6));
    CHECK_FALSE(isCoarse(0.0, 6.4e6)); // a single point cannot be traced
}

TEST_CASE("a change of the unit gives all parts new stamps", "[bridge]")
{
    const osg::ref_ptr<osg::MatrixTransform> root = placed(osg::Matrixd(), triangleGeometry());
    SceneConverter converter;
    const auto before = converter.convert(inputFor(root)).scene;
    root->setMatrix(osg::Matrixd::scale(1e-12, 1e-12, 1e-12));
    const auto after = converter.convert(inputFor(root)).scene;
    CHECK(after->unit != before->unit);
    CHECK(after->meshes[0] != before->meshes[0]);
    CHECK(after->meshes[0]->changed == after->changed);
    CHECK(converter.convert(inputFor(root)).scene == after);

    // The world is twice as large, and so is the unit: all parts stay the same, but the scene
    // changes.
    root->setMatrix(osg::Matrixd::scale(2e-12, 2e-12, 2e-12));
    const auto doubled = converter.convert(inputFor(root)).scene;
    CHECK(doubled->unit == 2.0 * after->unit);
    CHECK(doubled->meshes[0] == after->meshes[0]);
    CHECK(doubled != after);
}

TEST_CASE("a light that moves in a small scene has moved", "[bridge]")
{
    for (const double scale : {1.0, 1e-12, 1e12})
    {
        const auto conditionsWith = [scale](double x)
        {
            ViewingConditions conditions;
            conditions.eye = osg::Vec3d(0.0, -3.0, 0.0) * scale;
            const osg::ref_ptr<osg::Light> light = new osg::Light;
            light->setPosition(osg::Vec4d(x * scale, scale, scale, 1.0));
            conditions.light = light;
            return conditions;
        };
        CAPTURE(scale);
        const auto isSame = [&](double x, bool inEyeSpace)
        {
            ViewingConditions before = conditionsWith(1.0), now = conditionsWith(x);
            before.lightInEyeSpace = now.lightInEyeSpace = inEyeSpace;
            CHECK(convertAlike(before, now) == (inEyeSpace || x < 1.001));
            return keepSame(before, now);
        };
        for (const bool inEyeSpace : {false, true})
        {
            CHECK(isSame(1.0 + 1e-6, inEyeSpace));
            CHECK_FALSE(isSame(1.001, inEyeSpace));
        }
    }
}
