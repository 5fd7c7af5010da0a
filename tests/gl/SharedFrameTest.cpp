// SharedFrameTest.cpp - what else a scene does to the frame that shows its picture. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"

#include <osg/ClearNode>
#include <osg/GLExtensions>
#include <osg/MatrixTransform>
#include <osg/Sampler>
#include <osg/Texture2D>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

const osg::Vec4 kGreen(0.0f, 1.0f, 0.0f, 1.0f);
constexpr int kSize = 64;

bool isGreenInTheMiddle(const osg::Image& picture)
{
    return pixel(picture, kSize / 2, kSize / 2) == osg::Vec4(0, 255, 0, 255);
}

} // namespace

TEST_CASE("shared frame: a sampler that OSG leaves bound is not that of the picture", "[gl]")
{
    osg::ref_ptr<osg::Image> white = new osg::Image;
    white->allocateImage(8, 8, 1, GL_RGBA, GL_UNSIGNED_BYTE);
    std::memset(white->data(), 255, white->getTotalSizeInBytes());
    osg::ref_ptr<osg::Sampler> sampler = new osg::Sampler;
    sampler->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
    osg::ref_ptr<osg::MatrixTransform> aside =
        new osg::MatrixTransform(osg::Matrix::translate(2.0, 0.0, 1.0));
    osg::ref_ptr<osg::Geometry> drawn = unlitSquare(0.5f, osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    osg::StateSet& state = *drawn->getOrCreateStateSet();
    for (unsigned int unit = 0; unit < 2; ++unit)
    {
        state.setTextureAttributeAndModes(unit, new osg::Texture2D(white.get()));
        state.setTextureAttribute(unit, sampler.get());
    }
    aside->addChild(drawn.get());
    RayTracedScene::setHint(aside.get(), RayTracedScene::RASTERIZE);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(unlitSquare(2.0f, kGreen));
    root->addChild(aside.get());
    TestViewer viewer(kSize, kSize, tracedScene(root.get()));
    const osg::ref_ptr<osg::Image> picture = viewer.frames(3);
    osg::State& current = *viewer.camera().getGraphicsContext()->getState();
    REQUIRE(current.get<osg::GLExtensions>()->glBindSampler);
    CHECK(isGreenInTheMiddle(*picture));
}

TEST_CASE("shared frame: a ClearNode that clears nothing leaves a cleared depth", "[gl]")
{
    osg::ref_ptr<osg::ClearNode> clear = new osg::ClearNode;
    clear->setRequiresClear(false);
    osg::ref_ptr<osg::MatrixTransform> moves = new osg::MatrixTransform;
    moves->addChild(unlitSquare(2.0f, kGreen));
    clear->addChild(moves.get());
    TestViewer viewer(kSize, kSize, tracedScene(clear.get()));
    CHECK(isGreenInTheMiddle(*viewer.frames(2)));
    const float before = viewer.depth(kSize / 2, kSize / 2);
    moves->setMatrix(osg::Matrix::translate(0.0, 0.0, -5.0));
    viewer.frames(2);
    CHECK(viewer.depth(kSize / 2, kSize / 2) > before);
}
