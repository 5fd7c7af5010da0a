// NodePairsTest.cpp - nodes that choose, place, clip and turn, traced and rasterized. Layer: tests.
// SPDX-License-Identifier: MIT
#include "PicturePair.h"
#include "tests/Catch.h"
#include "tests/plugins/TemporaryFolder.h"

#include <osg/AutoTransform>
#include <osg/Billboard>
#include <osg/BlendFunc>
#include <osg/ClipNode>
#include <osg/LOD>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osg/PositionAttitudeTransform>
#include <osg/ProxyNode>
#include <osg/Sequence>
#include <osg/Switch>
#include <osgDB/DatabasePager>
#include <osgDB/FileUtils>
#include <osgDB/WriteFile>
#include <osgFX/Cartoon>
#include <osgSim/DOFTransform>
#include <osgSim/MultiSwitch>
#include <osgTerrain/Layer>
#include <osgTerrain/Terrain>
#include <osgTerrain/TerrainTile>
#include <osgText/Text3D>

#include <OpenThreads/Thread>

#include <cmath>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

const osg::Vec4 kRed(0.9f, 0.2f, 0.1f, 1.0f), kGreen(0.2f, 0.8f, 0.3f, 1.0f),
    kBlue(0.3f, 0.4f, 0.9f, 1.0f), kGrey(0.6f, 0.6f, 0.6f, 1.0f);

void lookAskew(TestViewer& view)
{
    normalize(view);
    view.look(osg::Vec3d(3.0, -6.0, 5.0), osg::Vec3d(0.2, 0.1, 0.0), osg::Vec3d(0.2, 0.0, 1.0));
}

osg::ref_ptr<osg::MatrixTransform> at(double x, double y, double z, osg::Node* node)
{
    return test::at(osg::Matrix::translate(x, y, z), node);
}

osg::ref_ptr<osg::ShapeDrawable> box(const osg::Vec4& color, float size = 1.0f)
{
    osg::ref_ptr<osg::ShapeDrawable> drawable =
        new osg::ShapeDrawable(new osg::Box(osg::Vec3(), size));
    drawable->setColor(color);
    return drawable;
}

/// Returns a sign in the plane y = 0 that faces -y, as billboards do; a dark corner shows which way
/// is up.
osg::ref_ptr<osg::Geometry> sign(const osg::Vec4& color)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    const float x[] = {-0.5f, 0.5f, 0.5f, -0.5f, 0.1f, 0.4f, 0.4f, 0.1f};
    const float z[] = {0.0f, 0.0f, 1.0f, 1.0f, 0.6f, 0.6f, 0.9f, 0.9f};
    for (int i = 0; i < 8; ++i)
    {
        vertices->push_back(osg::Vec3(x[i], i < 4 ? 0.0f : -0.02f, z[i]));
        colors->push_back(i < 4 ? color : osg::Vec4(0.1f, 0.1f, 0.1f, 1.0f));
    }
    geometry->setVertexArray(vertices);
    geometry->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, 8));
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return geometry;
}

osg::ref_ptr<osg::Group> group(const std::vector<osg::ref_ptr<osg::Node>>& children)
{
    osg::ref_ptr<osg::Group> made = new osg::Group;
    for (const auto& child : children)
        made->addChild(child.get());
    return made;
}

PicturePair checkSame(const std::string& name, const SceneMaker& makeScene)
{
    return test::checkSame(name, makeScene, lookAskew);
}

osg::ref_ptr<osg::ClipPlane> plane(unsigned int number, double x, double y, double z, double w)
{
    return new osg::ClipPlane(number, x, y, z, w);
}

} // namespace

TEST_CASE("pairs: clip planes cut what their states switch on", "[gl]")
{
    const PicturePair pair =
        checkSame("clip-node",
                  []
                  {
                      osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
                      clip->addClipPlane(plane(0, 1.0, 0.3, 0.0, 0.2));
                      clip->addClipPlane(plane(3, 0.0, -0.2, -1.0, 0.45));
                      clip->addChild(sphere(osg::Vec3(), 1.0f, kRed));
                      clip->addChild(at(0.0, 1.7, 0.0, box(kGreen).get()));
                      clip->addChild(at(-2.6, 0.0, 0.0, box(kBlue).get())); // clipped away
                      const auto turned = at(osg::Matrix::rotate(0.4, osg::Vec3d(0.3, 1.0, 0.2)) *
                                                 osg::Matrix::scale(1.2, 1.0, 0.9) *
                                                 osg::Matrix::translate(0.3, 0.0, 0.2),
                                             clip.get());
                      return group({turned, at(-1.0, -1.5, 0.0, box(kGrey).get())});
                  });
    CHECK(pair.count("not-traced.clipped-away") == 1);
}

TEST_CASE("pairs: a clip plane in eye space", "[gl]")
{
    checkSame("clip-eye",
              []
              {
                  osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
                  clip->setReferenceFrame(osg::ClipNode::ABSOLUTE_RF);
                  clip->addClipPlane(plane(1, 0.6, 1.0, 0.0, 0.2));
                  clip->addChild(sphere(osg::Vec3(), 1.5f, kRed));
                  return group({clip});
              });
}

TEST_CASE("pairs: instances of one geometry, some of them cut", "[gl]")
{
    const PicturePair pair =
        checkSame("clip-instances",
                  []
                  {
                      osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
                      clip->addClipPlane(plane(0, 1.0, 0.0, 0.0, 0.1));
                      const auto ball = sphere(osg::Vec3(), 0.5f, kBlue);
                      for (int i = -2; i <= 2; ++i)
                          clip->addChild(at(osg::Matrix::scale(i == 1 ? -1.0 : 1.0, 1.3, 0.8) *
                                                osg::Matrix::translate(i, 0.4 * i, 0.0),
                                            ball.get()));
                      return group({clip});
                  });
    CHECK(pair.count("not-traced.clipped-away") == 2);
}

TEST_CASE("pairs: billboards turn to the view", "[gl]")
{
    const auto make = [](osg::Billboard::Mode mode, const osg::Vec3& axis, const osg::Vec3& normal)
    {
        return [=]() -> osg::ref_ptr<osg::Node>
        {
            osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
            billboard->setMode(mode);
            billboard->setAxis(axis);
            billboard->setNormal(normal);
            billboard->addDrawable(sign(kRed), osg::Vec3(-1.2f, 0.0f, 0.0f));
            billboard->addDrawable(sign(kGreen), osg::Vec3(0.6f, 0.8f, 0.3f));
            billboard->addDrawable(sign(kBlue), osg::Vec3(1.0f, -1.2f, -0.5f));
            return group(
                {at(osg::Matrix::rotate(0.5, osg::Vec3d(1.0, 0.4, 0.1)), billboard.get())});
        };
    };
    const osg::Vec3 z(0, 0, 1), back(0, -1, 0);
    checkSame("billboard-axial", make(osg::Billboard::AXIAL_ROT, z, back));
    checkSame("billboard-eye", make(osg::Billboard::POINT_ROT_EYE, z, back));
    checkSame("billboard-world", make(osg::Billboard::POINT_ROT_WORLD, z, back));
}

// Drawables that OSG draws are where the billboard puts them.
TEST_CASE("pairs: billboards of which OSG draws a part", "[gl]")
{
    checkSame("billboard-rasterized",
              []
              {
                  osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
                  osg::ref_ptr<osg::Geometry> bright = sign(kGreen);
                  bright->getOrCreateStateSet()->setAttributeAndModes(
                      new osg::BlendFunc(GL_ONE, GL_ONE));
                  billboard->addDrawable(sign(kRed), osg::Vec3(-1.2f, 0.0f, 0.0f));
                  billboard->addDrawable(bright.get(), osg::Vec3(0.6f, 0.8f, 0.3f));
                  return group({billboard});
              });
}

// The view of the picture is not the first one that the scene was converted for.
TEST_CASE("pairs: billboards follow a view that moves", "[gl]")
{
    checkSame(
        "billboard-moved",
        []
        {
            osg::ref_ptr<osg::Billboard> billboard = new osg::Billboard;
            billboard->setMode(osg::Billboard::POINT_ROT_EYE);
            billboard->addDrawable(sign(kRed), osg::Vec3(-1.2f, 0.0f, 0.0f));
            billboard->addDrawable(sign(kGreen), osg::Vec3(0.6f, 0.8f, 0.3f));
            return group({billboard});
        },
        [](TestViewer& view)
        {
            view.look(osg::Vec3d(-6.0, 2.0, 1.0));
            view.viewer.realize();
            view.viewer.frame(0.0);
            lookAskew(view);
        });
}

TEST_CASE("pairs: AutoTransform turns and scales for the view", "[gl]")
{
    checkSame("auto-transform",
              []
              {
                  osg::ref_ptr<osg::Group> root = new osg::Group;
                  const osg::AutoTransform::AutoRotateMode modes[] = {
                      osg::AutoTransform::ROTATE_TO_SCREEN, osg::AutoTransform::ROTATE_TO_CAMERA,
                      osg::AutoTransform::ROTATE_TO_AXIS};
                  for (int i = 0; i < 3; ++i)
                  {
                      osg::ref_ptr<osg::AutoTransform> turning = new osg::AutoTransform;
                      turning->setPosition(osg::Vec3d(1.2 * i - 1.2, 0.3 * i, 0.0));
                      turning->setAutoRotateMode(modes[i]);
                      // Signs that turn to the screen lie on their backs: their x points right and
                      // their y up.
                      turning->addChild(i == 2 ? static_cast<osg::Node*>(sign(kRed).get())
                                               : at(osg::Matrix::rotate(-1.4, osg::Vec3d(1, 0, 0)),
                                                    sign(kGreen).get())
                                                     .get());
                      root->addChild(turning);
                  }
                  osg::ref_ptr<osg::AutoTransform> scaled = new osg::AutoTransform;
                  scaled->setPosition(osg::Vec3d(0.0, -1.0, -1.0));
                  scaled->setAutoScaleToScreen(true);
                  // The limits of the scale make the box 60 pixels wide in the traced picture, and
                  // four times as many in the large one.
                  scaled->addChild(at(osg::Matrix::scale(1, 1, 1), box(kBlue, 1.0f).get()));
                  scaled->setMinimumScale(0.8);
                  scaled->setMaximumScale(0.9);
                  root->addChild(scaled);
                  return root;
              });
}

TEST_CASE("pairs: AutoTransform keeps a size in pixels", "[gl]")
{
    const auto make = [](double pixels)
    {
        osg::ref_ptr<osg::AutoTransform> scaled = new osg::AutoTransform;
        scaled->setAutoScaleToScreen(true);
        scaled->setPosition(osg::Vec3d(0.5, 0.5, 0.0));
        scaled->addChild(at(osg::Matrix::scale(pixels, pixels, pixels), box(kBlue).get()));
        return group({scaled});
    };
    // The rasterized picture is four times as large as the traced one.
    bool large = true;
    checkSame("auto-scale",
              [&]
              {
                  const auto scene = make(large ? 400.0 : 100.0);
                  large = false;
                  return scene;
              });
}

TEST_CASE("pairs: a transform with a frame of its own follows the eye", "[gl]")
{
    checkSame(
        "absolute",
        []
        {
            osg::ref_ptr<osg::MatrixTransform> cockpit =
                at(osg::Matrix::rotate(0.3, osg::Vec3d(1, 1, 0)) *
                       osg::Matrix::translate(1.0, -0.8, -5.0),
                   box(kRed).get());
            cockpit->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
            return group({at(100.0, 0.0, 0.0, cockpit.get()), sphere(osg::Vec3(), 1.0f, kGreen)});
        });
}

TEST_CASE("pairs: levels of detail, by distance and by size in pixels", "[gl]")
{
    checkSame("lod",
              []
              {
                  osg::ref_ptr<osg::Group> root = new osg::Group;
                  for (int i = 0; i < 2; ++i)
                  {
                      osg::ref_ptr<osg::LOD> lod = new osg::LOD;
                      const bool pixels = i == 1;
                      lod->setRangeMode(pixels ? osg::LOD::PIXEL_SIZE_ON_SCREEN
                                               : osg::LOD::DISTANCE_FROM_EYE_POINT);
                      // The pictures differ in size: the boxes are 12 and 48 pixels wide in one, 60
                      // and 240 in the other.
                      lod->addChild(box(kRed, 0.9f), 0.0f, pixels ? 20.0f : 4.0f);
                      lod->addChild(sphere(osg::Vec3(), 0.7f, kGreen), pixels ? 20.0f : 4.0f,
                                    pixels ? 1e6f : 30.0f);
                      root->addChild(at(1.6 * i - 0.8, 0.0, 0.0, lod.get()));
                  }
                  return root;
              });
}

TEST_CASE("pairs: switches, sequences and joints", "[gl]")
{
    checkSame("switches",
              []
              {
                  osg::ref_ptr<osg::Switch> choice = new osg::Switch;
                  choice->addChild(box(kRed), false);
                  choice->addChild(sphere(osg::Vec3(), 0.6f, kGreen), true);
                  osg::ref_ptr<osgSim::MultiSwitch> multi = new osgSim::MultiSwitch;
                  multi->addChild(box(kRed));
                  multi->addChild(sphere(osg::Vec3(), 0.5f, kBlue));
                  multi->setSingleChildOn(0, 1);
                  osg::ref_ptr<osg::Sequence> sequence = new osg::Sequence;
                  sequence->addChild(box(kGrey), 10.0);
                  sequence->addChild(box(kRed), 10.0);
                  sequence->setMode(osg::Sequence::START);
                  osg::ref_ptr<osgSim::DOFTransform> joint = new osgSim::DOFTransform;
                  joint->setCurrentHPR(osg::Vec3(0.3f, 0.4f, 0.1f));
                  joint->setCurrentScale(osg::Vec3(1.0f, 0.5f, 1.4f));
                  joint->addChild(box(kGreen));
                  return group({at(-1.6, 0.0, 0.0, choice.get()), multi,
                                at(1.5, 0.0, 0.0, sequence.get()), at(0.0, 1.6, 0.0, joint.get())});
              });
}

TEST_CASE("pairs: pages and proxies are loaded for the view", "[gl]")
{
    const TemporaryFolder folder;
    const std::string near = folder / "near.osgt", proxied = folder / "proxied.osgt";
    osgDB::writeNodeFile(*group({sphere(osg::Vec3(), 0.9f, kGreen)}), near);
    osgDB::writeNodeFile(*group({box(kBlue)}), proxied);
    checkSame(
        "paged",
        [&]
        {
            osg::ref_ptr<osg::PagedLOD> paged = new osg::PagedLOD;
            paged->setCenter(osg::Vec3());
            paged->setRadius(1.0f);
            paged->addChild(box(kRed), 20.0f, 1e6f); // visible until the near one is loaded
            paged->setFileName(1, near);
            paged->setRange(1, 0.0f, 20.0f);
            osg::ref_ptr<osg::ProxyNode> proxy = new osg::ProxyNode;
            proxy->setFileName(0, proxied);
            proxy->setCenterMode(osg::ProxyNode::USER_DEFINED_CENTER);
            proxy->setCenter(osg::Vec3());
            proxy->setRadius(1.0f);
            return group({at(-0.9, 0.0, 0.0, paged.get()), at(1.2, 0.0, 0.0, proxy.get())});
        },
        [](TestViewer& view)
        {
            lookAskew(view);
            view.viewer.realize();
            // The test does not look at a clock: it waits until the pager has had nothing to do for
            // some frames.
            for (int quiet = 0; quiet < 20; ++quiet)
            {
                view.viewer.frame(0.0);
                OpenThreads::Thread::microSleep(5000);
                if (view.viewer.getDatabasePager()->requiresUpdateSceneGraph() ||
                    view.viewer.getDatabasePager()->getRequestsInProgress())
                    quiet = 0;
            }
        });
}

TEST_CASE("pairs: a tile of a terrain", "[gl]")
{
    checkSame("terrain",
              []
              {
                  osg::ref_ptr<osg::HeightField> field = new osg::HeightField;
                  field->allocate(17, 17);
                  field->setOrigin(osg::Vec3(-2.0f, -2.0f, 0.0f));
                  field->setXInterval(0.25f);
                  field->setYInterval(0.25f);
                  for (unsigned int c = 0; c < 17; ++c)
                      for (unsigned int r = 0; r < 17; ++r)
                          field->setHeight(c, r, 0.4f * std::sin(0.8f * c) * std::cos(0.6f * r));
                  osg::ref_ptr<osg::Image> image = new osg::Image;
                  image->allocateImage(64, 64, 1, GL_RGB, GL_UNSIGNED_BYTE);
                  for (int y = 0; y < 64; ++y)
                      for (int x = 0; x < 64; ++x)
                      {
                          image->data(x, y)[0] = static_cast<unsigned char>(4 * x);
                          image->data(x, y)[1] = static_cast<unsigned char>(4 * y);
                          image->data(x, y)[2] = 80;
                      }
                  osg::ref_ptr<osgTerrain::Locator> locator = new osgTerrain::Locator;
                  locator->setCoordinateSystemType(osgTerrain::Locator::PROJECTED);
                  locator->setTransformAsExtents(-2.0, -2.0, 2.0, 2.0);
                  osg::ref_ptr<osgTerrain::HeightFieldLayer> heights =
                      new osgTerrain::HeightFieldLayer(field.get());
                  heights->setLocator(locator.get());
                  osg::ref_ptr<osgTerrain::ImageLayer> colors =
                      new osgTerrain::ImageLayer(image.get());
                  colors->setLocator(locator.get());
                  osg::ref_ptr<osgTerrain::TerrainTile> tile = new osgTerrain::TerrainTile;
                  tile->setLocator(locator.get());
                  tile->setElevationLayer(heights.get());
                  tile->setColorLayer(0, colors.get());
                  osg::ref_ptr<osgTerrain::Terrain> terrain = new osgTerrain::Terrain;
                  terrain->addChild(tile);
                  return terrain;
              });
}

TEST_CASE("pairs: effects and solid text are drawn as before", "[gl]")
{
    // The font is OSG's own. Other fonts may have faces that overlap, and then the test has no
    // text.
    const bool hasFont = !osgDB::findDataFile("fonts/arial.ttf").empty();
    const PicturePair pair =
        checkSame("effects",
                  [hasFont]
                  {
                      osg::ref_ptr<osgFX::Cartoon> cartoon = new osgFX::Cartoon;
                      cartoon->addChild(sphere(osg::Vec3(), 0.8f, kRed));
                      osg::ref_ptr<osgText::Text3D> text = new osgText::Text3D;
                      text->setCharacterSize(0.9f, 0.3f);
                      if (hasFont) text->setFont("fonts/arial.ttf");
                      text->setText(hasFont ? "AB" : "");
                      text->setColor(kGreen);
                      osg::ref_ptr<osg::Group> lit = group({text});
                      return group({at(-0.8, 0.0, 0.0, cartoon.get()),
                                    at(osg::Matrix::rotate(1.5, osg::Vec3d(1, 0, 0)) *
                                           osg::Matrix::translate(0.6, 0.0, 0.0),
                                       lit.get()),
                                    at(0.0, 1.5, -1.0, box(kGrey, 2.0f).get())});
                  });
    CHECK(pair.count("rasterized.effect") == 1);
    CHECK(pair.count("not-traced.text") == 1);
}
