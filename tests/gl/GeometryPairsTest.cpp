// GeometryPairsTest.cpp - primitives, arrays and shapes, traced and rasterized. Layer: tests.
// SPDX-License-Identifier: MIT
#include "PicturePair.h"
#include "tests/Catch.h"

#include <osg/PrimitiveRestartIndex>
#include <osgUtil/Tessellator>

#include <cmath>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

PicturePair checkSame(const std::string& name, const SceneMaker& makeScene, int frames = 3)
{
    return test::checkSame(name, makeScene, lookDown, frames);
}

osg::ref_ptr<osg::MatrixTransform> at(double x, double y, osg::Node* node)
{
    return test::at(osg::Matrix::translate(x, y, 0.0), node);
}

/// Returns alternating points of a band along an arc, each with a colour of its own.
template <class Positions> osg::ref_ptr<osg::Geometry> band(int count, double scale = 1.0)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<Positions> positions = new Positions;
    osg::ref_ptr<osg::Vec4ubArray> colors = new osg::Vec4ubArray;
    for (int i = 0; i < count; ++i)
    {
        const double angle = 0.25 * (i / 2), radius = scale * (i % 2 ? 0.6 : 0.3);
        typename Positions::ElementDataType p;
        using Number = std::decay_t<decltype(p[0])>;
        p[0] = static_cast<Number>(radius * std::cos(angle));
        p[1] = static_cast<Number>(radius * std::sin(angle));
        if (Positions::ElementDataType::num_components > 2)
            p[2] = static_cast<Number>(0.1 * scale * (i % 3));
        positions->push_back(p);
        colors->push_back(osg::Vec4ub(static_cast<unsigned char>(255 - 20 * i),
                                      static_cast<unsigned char>(20 * i), 100, 255));
    }
    geometry->setVertexArray(positions);
    geometry->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return geometry;
}

osg::ref_ptr<osg::Geometry> bandOf(GLenum mode)
{
    const auto geometry = band<osg::Vec3Array>(12);
    geometry->addPrimitiveSet(new osg::DrawArrays(mode, 0, 12));
    return geometry;
}

template <class Positions> osg::ref_ptr<osg::Node> bandOfType(double scale)
{
    const auto geometry = band<Positions>(12, scale);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLE_STRIP, 0, 12));
    return test::at(osg::Matrix::scale(1.0 / scale, 1.0 / scale, 1.0 / scale), geometry.get());
}

} // namespace

TEST_CASE("pairs: primitives of all modes", "[gl]")
{
    checkSame("modes",
              []
              {
                  osg::ref_ptr<osg::Group> root = new osg::Group;
                  const GLenum modes[] = {GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_TRIANGLE_FAN,
                                          GL_QUADS, GL_QUAD_STRIP};
                  for (int i = 0; i < 5; ++i)
                      root->addChild(
                          at(1.4 * (i % 3) - 2.1, 1.4 * (i / 3) - 1.2, bandOf(modes[i]).get()));
                  return root;
              });
}

TEST_CASE("pairs: strips that restart, at any index and at the largest", "[gl]")
{
    const PicturePair pair = checkSame(
        "restart",
        []
        {
            osg::ref_ptr<osg::Group> root = new osg::Group;
            const unsigned short indices[] = {0, 1, 2, 3, 4, 99, 6, 7, 8, 9, 99, 10, 11};
            const auto strips = band<osg::Vec3Array>(12);
            osg::ref_ptr<osg::DrawElementsUShort> set =
                new osg::DrawElementsUShort(GL_TRIANGLE_STRIP, 13, indices);
            strips->addPrimitiveSet(set);
            struct NoBox : osg::Drawable::ComputeBoundingBoxCallback
            {
                osg::BoundingBox computeBound(const osg::Drawable&) const override
                {
                    return {-1, -1, -1, 1, 1, 1};
                }
            };
            strips->setComputeBoundingBoxCallback(new NoBox); // OSG's callback would read vertex 99
            strips->setUseDisplayList(false);
            strips->setUseVertexBufferObjects(true);
            osg::StateSet* state = strips->getOrCreateStateSet();
            state->setMode(GL_PRIMITIVE_RESTART, osg::StateAttribute::ON);
            state->setAttribute(new osg::PrimitiveRestartIndex(99));
            root->addChild(at(osg::Matrix::scale(3, 3, 3), strips.get()));
            return root;
        });
    CHECK(pair.count("skipped.index-out-of-range") == 0);
}

TEST_CASE("pairs: a concave polygon looks as OSG's tessellator makes it", "[gl]")
{
    bool tessellated = true; // the rasterized scene is made first
    checkSame(
        "concave",
        [&]
        {
            // The outlines are an arrow, a comb and one that leads to a hole and back; the fan of
            // each is wrong.
            const std::vector<std::vector<osg::Vec2>> outlines = {
                {{0.5f, 0.0f}, {1.0f, 1.0f}, {0.5f, 0.6f}, {0.0f, 1.0f}},
                {{0, 0},
                 {1, 0},
                 {1, 1},
                 {0.8f, 1},
                 {0.8f, 0.3f},
                 {0.6f, 0.3f},
                 {0.6f, 1},
                 {0.4f, 1},
                 {0.4f, 0.3f},
                 {0.2f, 0.3f},
                 {0.2f, 1},
                 {0, 1}},
                {{0, 0},
                 {1, 0},
                 {1, 1},
                 {0, 1},
                 {0, 0},
                 {0.3f, 0.3f},
                 {0.3f, 0.7f},
                 {0.7f, 0.7f},
                 {0.7f, 0.3f},
                 {0.3f, 0.3f}}};
            osg::ref_ptr<osg::Group> root = new osg::Group;
            for (std::size_t i = 0; i < outlines.size(); ++i)
            {
                osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
                osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
                for (const osg::Vec2& p : outlines[i])
                    vertices->push_back(osg::Vec3(p, 0.2f * p.x()));
                geometry->setVertexArray(vertices);
                const osg::Vec4 color(0.9f, 0.6f, 0.2f, 1.0f);
                geometry->setColorArray(new osg::Vec4Array(1, &color), osg::Array::BIND_OVERALL);
                const osg::Vec3 normal(0.0f, 0.0f, 1.0f);
                geometry->setNormalArray(new osg::Vec3Array(1, &normal), osg::Array::BIND_OVERALL);
                geometry->addPrimitiveSet(
                    new osg::DrawArrays(GL_POLYGON, 0, static_cast<int>(outlines[i].size())));
                if (tessellated)
                {
                    osg::ref_ptr<osgUtil::Tessellator> tessellator = new osgUtil::Tessellator;
                    tessellator->setTessellationType(osgUtil::Tessellator::TESS_TYPE_GEOMETRY);
                    tessellator->setWindingType(osgUtil::Tessellator::TESS_WINDING_ODD);
                    tessellator->retessellatePolygons(*geometry);
                }
                root->addChild(at(osg::Matrix::scale(1.6, 1.6, 1.0) *
                                      osg::Matrix::translate(1.8 * double(i) - 2.7, -0.8, 0.0),
                                  geometry.get()));
            }
            tessellated = false;
            return root;
        });
}

TEST_CASE("pairs: positions of all types", "[gl]")
{
    checkSame("types",
              []
              {
                  osg::ref_ptr<osg::Group> root = new osg::Group;
                  const osg::ref_ptr<osg::Node> bands[] = {
                      bandOfType<osg::Vec2Array>(1.0),     bandOfType<osg::Vec3Array>(1.0),
                      bandOfType<osg::Vec3dArray>(1.0),    bandOfType<osg::Vec2dArray>(1.0),
                      bandOfType<osg::Vec3sArray>(3000.0), bandOfType<osg::Vec3iArray>(3000.0),
                      bandOfType<osg::Vec2sArray>(3000.0), bandOfType<osg::Vec2iArray>(3000.0)};
                  for (int i = 0; i < 8; ++i)
                      root->addChild(at(1.4 * (i % 4) - 2.1, 1.4 * (i / 4) - 1.2, bands[i].get()));
                  return root;
              });
}

TEST_CASE("pairs: shapes, composite ones too", "[gl]")
{
    checkSame("shapes",
              []
              {
                  osg::ref_ptr<osg::Group> root = new osg::Group;
                  osg::ref_ptr<osg::HeightField> field = new osg::HeightField;
                  field->allocate(5, 5);
                  field->setOrigin(osg::Vec3(-0.5f, -0.5f, 0.0f));
                  field->setXInterval(0.25f);
                  field->setYInterval(0.25f);
                  for (unsigned int i = 0; i < 25; ++i)
                      field->setHeight(i % 5, i / 5, 0.05f * float(i * 7 % 5));
                  osg::ref_ptr<osg::CompositeShape> composite = new osg::CompositeShape;
                  composite->addChild(new osg::Box(osg::Vec3(-0.2f, 0, 0), 0.4f));
                  composite->addChild(new osg::Sphere(osg::Vec3(0.2f, 0, 0.2f), 0.3f));
                  osg::Shape* shapes[] = {new osg::Sphere(osg::Vec3(), 0.5f),
                                          new osg::Box(osg::Vec3(), 0.7f, 0.4f, 0.9f),
                                          new osg::Cone(osg::Vec3(), 0.4f, 0.9f),
                                          new osg::Cylinder(osg::Vec3(), 0.3f, 0.8f),
                                          new osg::Capsule(osg::Vec3(), 0.25f, 0.6f),
                                          field.get(),
                                          composite.get()};
                  for (int i = 0; i < 7; ++i)
                  {
                      osg::ref_ptr<osg::TessellationHints> hints = new osg::TessellationHints;
                      hints->setDetailRatio(2.0f);
                      osg::ref_ptr<osg::ShapeDrawable> drawable =
                          new osg::ShapeDrawable(shapes[i], hints);
                      drawable->setColor(osg::Vec4(0.3f + 0.1f * i, 0.9f - 0.1f * i, 0.5f, 1.0f));
                      root->addChild(at(1.4 * (i % 4) - 2.1, 1.4 * (i / 4) - 1.0, drawable.get()));
                  }
                  return root;
              });
}

TEST_CASE("pairs: one geometry in many places, mirrored and uneven", "[gl]")
{
    checkSame("shared",
              []
              {
                  osg::ref_ptr<osg::Group> root = new osg::Group;
                  osg::ref_ptr<osg::ShapeDrawable> cone =
                      new osg::ShapeDrawable(new osg::Cone(osg::Vec3(), 0.4f, 1.0f));
                  cone->setColor(osg::Vec4(0.8f, 0.7f, 0.2f, 1.0f));
                  const auto pair = at(osg::Matrix::rotate(0.7, osg::Vec3d(1, 0, 0)), cone.get());
                  for (int i = 0; i < 8; ++i)
                      root->addChild(at(
                          osg::Matrix::scale(i % 2 ? -1.0 : 1.0, 0.6 + 0.1 * i, 1.3 - 0.1 * i) *
                              osg::Matrix::rotate(0.4 * i, osg::Vec3d(0, 1, 0.5)) *
                              osg::Matrix::translate(1.4 * (i % 4) - 2.1, 1.4 * (i / 4) - 1.0, 0.0),
                          pair.get()));
                  return root;
              });
}

TEST_CASE("pairs: what a transform flattens", "[gl]")
{
    checkSame(
        "flattened",
        []
        {
            osg::ref_ptr<osg::Group> root = new osg::Group;
            osg::ref_ptr<osg::ShapeDrawable> cone =
                new osg::ShapeDrawable(new osg::Cone(osg::Vec3(0.1f, 0.0f, 0.3f), 0.6f, 1.2f));
            cone->setColor(osg::Vec4(0.8f, 0.7f, 0.2f, 1.0f));
            cone->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
            osg::Matrix shadow; // on the plane z = 0, along (-1, -0.5, -1)
            shadow(2, 0) = -1.0;
            shadow(2, 1) = -0.5;
            shadow(2, 2) = 0.0;
            const osg::Matrix all[] = {osg::Matrix::scale(0, 1, 1), osg::Matrix::scale(1, 0, 1),
                                       osg::Matrix::scale(-1, 1, 0), shadow};
            for (int i = 0; i < 4; ++i)
                root->addChild(
                    at(all[i] * osg::Matrix::rotate(0.3, osg::Vec3d(0, 1, 0.5)) *
                           osg::Matrix::translate(1.8 * (i % 2) - 0.9, 1.8 * (i / 2) - 0.9, 0.0),
                       cone.get()));
            root->addChild(at(osg::Matrix::scale(1, 0, 0), cone.get())); // nothing is seen
            return root;
        });
}
