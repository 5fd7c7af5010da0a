// VolumeMatchTest.cpp - osgVolume's tiles look as OpenGL draws them. Layer: tests.
// SPDX-License-Identifier: MIT
#include "MatchPictures.h"
#include "StateScenes.h"

#include "tests/VolumeTiles.h"

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// TestViewer's eye is 10 above the plane z = 0. The box is turned, and not a cube.
osg::Matrixd leaningBox()
{
    return osg::Matrixd::translate(-0.5, -0.5, -0.5) * osg::Matrixd::scale(4.0, 3.0, 5.0) *
           osg::Matrixd::rotate(0.6, osg::Vec3d(1, 0.4, 0.2));
}

/// Returns a tile before one square, as a VolumeScene draws them, with another square in it. Tiles
/// of RayTracedTechnique have none in them: OpenGL hides them wholly behind such a square.
osg::ref_ptr<osg::Node> sceneOf(const osg::ref_ptr<osgVolume::VolumeTile>& tile)
{
    const bool together =
        dynamic_cast<osgVolume::MultipassTechnique*>(tile->getVolumeTechnique()) != nullptr;
    osg::ref_ptr<osg::Group> root = together ? new osgVolume::VolumeScene : new osg::Group;
    root->addChild(placed(osg::Matrixd::translate(1.0, 0.0, -4.0),
                          unlit(square(4.0f, {0.8f, 0.3f, 0.3f, 1.0f}))));
    if (together)
        root->addChild(placed(osg::Matrixd::translate(-0.8, 0.5, 0.0),
                              unlit(square(0.8f, {0.2f, 0.7f, 0.3f, 1.0f}))));
    root->addChild(tile);
    return root;
}

/// Returns whether Whitted's picture of a tile is OSG's own: the mean difference of the pixels that
/// both cover.
bool looksAlike(const std::string& name, const osg::ref_ptr<osgVolume::VolumeTile>& tile,
                Statistics& statistics)
{
    MatchSetup setup;
    setup.samples = 3;
    setup.settings = [](RayTraceSettings& settings)
    { settings.setIntegrator(RayTraceSettings::WHITTED); };
    const osg::ref_ptr<osg::Node> scene = sceneOf(tile);
    const Comparison comparison = match(name, scene, setup, &statistics);
    CAPTURE(name, comparison.difference, comparison.both);
    CHECK(comparison.both > 1000);
    return comparison.difference < 2.0;
}

bool looksAlike(const std::string& name, const osg::ref_ptr<osgVolume::VolumeTile>& tile)
{
    Statistics statistics;
    const bool alike = looksAlike(name, tile, statistics);
    CHECK(statistics.conversion["converted.volume"] == 1);
    CHECK(statistics.conversion.count("rasterized.volume") == 0);
    return alike;
}

osgVolume::VolumeTechnique* multipass()
{
    return new osgVolume::MultipassTechnique;
}

} // namespace

TEST_CASE("volume match: a transfer function, and colours of the image's own", "[gl][coverage]")
{
    CHECK(looksAlike("volume-transfer",
                     tileOf(ballImage(32), blueToYellow(), multipass(), leaningBox())));
    const auto tile = tileOf(ballImage(24, GL_RGBA), nullptr, multipass(), leaningBox());
    addProperty(*tile, new osgVolume::TransparencyProperty(0.2f));
    CHECK(looksAlike("volume-rgba", tile));
}

TEST_CASE("volume match: values that are cut off, and other steps", "[gl][coverage]")
{
    const auto tile = tileOf(ballImage(32), blueToYellow(0.2f), multipass(), leaningBox());
    addProperty(*tile, new osgVolume::AlphaFuncProperty(0.4f));
    addProperty(*tile, new osgVolume::SampleRatioProperty(3.0f));
    CHECK(looksAlike("volume-cutoff", tile));
}

TEST_CASE("volume match: a tile that shows a part of its image", "[gl][coverage]")
{
    const auto tile = tileOf(ballImage(32), blueToYellow(), multipass(), leaningBox());
    tile->setLocator(new osgVolume::Locator(osg::Matrixd::translate(0.3, 0.1, 0.2) *
                                            osg::Matrixd::scale(0.6, 0.7, 0.7) * leaningBox()));
    CHECK(looksAlike("volume-part", tile));
}

TEST_CASE("volume match: gradients that a light lights", "[gl][coverage]")
{
    const auto tile = tileOf(ballImage(32), blueToYellow(), multipass(), leaningBox());
    addProperty(*tile, new osgVolume::LightingProperty);
    CHECK(looksAlike("volume-lit", tile));
}

TEST_CASE("volume match: samples of a ray", "[gl][coverage]")
{
    const auto tile =
        tileOf(ballImage(32), blueToYellow(0.1f), new osgVolume::RayTracedTechnique, leaningBox());
    addProperty(*tile, new osgVolume::SampleDensityProperty(0.01f));
    addProperty(*tile, new osgVolume::AlphaFuncProperty(0.004f));
    CHECK(looksAlike("volume-samples", tile));
}

TEST_CASE("volume match: what is left to OSG looks as OSG draws it", "[gl][coverage]")
{
    const auto tile = tileOf(ballImage(32), blueToYellow(), multipass(), leaningBox());
    addProperty(*tile, new osgVolume::MaximumIntensityProjectionProperty);
    Statistics statistics;
    CHECK(looksAlike("volume-projection", tile, statistics));
    CHECK(statistics.conversion["rasterized.volume"] == 1);
    CHECK(statistics.conversion.count("converted.volume") == 0);
}

TEST_CASE("volume match: isosurfaces", "[gl][coverage]")
{
    // osgVolume's shaders light by 0.1 + 0.9 n * l whatever the light is; the viewer's has 0.8.
    const auto looksAlikeInLight =
        [](const std::string& name, const osg::ref_ptr<osgVolume::VolumeTile>& tile)
    {
        MatchSetup setup;
        setup.samples = 3;
        setup.settings = [](RayTraceSettings& settings)
        { settings.setIntegrator(RayTraceSettings::WHITTED); };
        setup.view = [](TestViewer& view)
        { view.viewer.getLight()->setDiffuse(osg::Vec4(0.9f, 0.9f, 0.9f, 1.0f)); };
        Statistics statistics;
        const Comparison comparison = match(name, sceneOf(tile), setup, &statistics);
        CHECK(comparison.both > 1000);
        CHECK(statistics.conversion["converted.isosurface"] == 1);
        CHECK(statistics.conversion.count("rasterized.volume") == 0);
        return comparison.difference < 2.0;
    };
    // They also light in the space of the cube, where angles are those of a box that is a cube.
    const osg::Matrixd evenBox = osg::Matrixd::translate(-0.5, -0.5, -0.5) *
                                 osg::Matrixd::scale(5.0, 5.0, 5.0) *
                                 osg::Matrixd::rotate(0.6, osg::Vec3d(1, 0.4, 0.2));
    const osg::ref_ptr<osg::TransferFunction1D> opaque = new osg::TransferFunction1D;
    opaque->setColor(0.0f, osg::Vec4(0.1f, 0.2f, 0.9f, 1.0f));
    opaque->setColor(1.0f, osg::Vec4(1.0f, 0.9f, 0.1f, 1.0f));
    const auto white = tileOf(ballImage(32), nullptr, multipass(), evenBox);
    addProperty(*white, new osgVolume::IsoSurfaceProperty(0.2f));
    CHECK(looksAlikeInLight("iso-white", white));
    const auto colored = tileOf(ballImage(32), opaque, multipass(), evenBox);
    addProperty(*colored, new osgVolume::IsoSurfaceProperty(0.3f));
    CHECK(looksAlikeInLight("iso-transfer", colored));
    const auto sampled = tileOf(ballImage(32), opaque, new osgVolume::RayTracedTechnique, evenBox);
    addProperty(*sampled, new osgVolume::IsoSurfaceProperty(0.3f));
    addProperty(*sampled, new osgVolume::SampleDensityProperty(0.005f));
    CHECK(looksAlikeInLight("iso-samples", sampled));
}
