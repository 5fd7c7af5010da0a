// VolumeFuzzTest.cpp - random tiles of osgVolume converted, built and rendered. Layer: tests.
// SPDX-License-Identifier: MIT
#include "FuzzSeeds.h"
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/VolumeTiles.h"
#include "tests/bridge/Graphs.h"

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/RenderSession.h"

#include <osgRayTrace/Medium>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/Notify>

#include <cmath>
#include <cstring>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSize = 8;
constexpr int kSeeds = 400;

/// Returns an image of any size, format and contents.
osg::ref_ptr<osg::Image> randomImage(Dice& dice)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    if (dice.oneIn(20)) return image;
    const GLenum formats[] = {GL_LUMINANCE, GL_ALPHA, GL_RGBA, GL_LUMINANCE_ALPHA, GL_RGB, GL_RED};
    const GLenum types[] = {GL_UNSIGNED_BYTE, GL_FLOAT, GL_SHORT, GL_UNSIGNED_SHORT};
    const auto side = [&] { return dice.oneIn(3) ? 1 : 1 + dice.below(20); };
    image->allocateImage(side(), side(), side(), dice.oneOf(formats), dice.oneOf(types));
    const bool strange = dice.oneIn(3);
    for (unsigned int i = 0; i + 3 < image->getTotalSizeInBytes(); i += 4)
    {
        // Any bits may be NaN, infinite or huge as floats.
        const auto value = static_cast<float>(dice.unit());
        uint32_t bits = strange ? dice.bits() : 0;
        if (!strange) std::memcpy(&bits, &value, sizeof bits);
        std::memcpy(image->data() + i, &bits, sizeof bits);
    }
    return image;
}

osg::Matrixd randomLocator(Dice& dice)
{
    osg::Matrixd matrix =
        osg::Matrixd::translate(-0.5, -0.5, -0.5) *
        osg::Matrixd::scale(dice.strange(4.0, 12), dice.strange(4.0, 12), dice.strange(4.0, 12)) *
        osg::Matrixd::rotate(dice.between(0.0, 6.0), osg::Vec3d(1, 2, 3));
    if (dice.oneIn(6)) matrix(0, 1) += dice.strange(2.0, 4);
    return matrix * osg::Matrixd::translate(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0), 0.0);
}

float strangeValue(Dice& dice)
{
    return static_cast<float>(dice.strange(1.0, 4));
}

osg::ref_ptr<osgVolume::VolumeTile> randomTile(Dice& dice)
{
    osg::ref_ptr<osg::TransferFunction1D> transfer;
    if (dice.oneIn(2))
    {
        transfer = new osg::TransferFunction1D;
        if (!dice.oneIn(8))
            for (int i = 1 + dice.below(4); i > 0; --i)
                transfer->setColor(static_cast<float>(dice.between(-1.0, 2.0)),
                                   osg::Vec4(strangeValue(dice), strangeValue(dice),
                                             strangeValue(dice), strangeValue(dice)));
    }
    osg::ref_ptr<osgVolume::VolumeTechnique> technique = new osgVolume::MultipassTechnique;
    if (dice.oneIn(3)) technique = new osgVolume::RayTracedTechnique;
    osg::ref_ptr<osgVolume::VolumeTile> tile =
        tileOf(randomImage(dice), transfer, technique, randomLocator(dice));
    if (dice.oneIn(3)) tile->setLocator(new osgVolume::Locator(randomLocator(dice)));
    if (dice.oneIn(6)) tile->setLocator(nullptr);
    if (dice.oneIn(3)) addProperty(*tile, new osgVolume::AlphaFuncProperty(strangeValue(dice)));
    if (dice.oneIn(3)) addProperty(*tile, new osgVolume::TransparencyProperty(strangeValue(dice)));
    if (dice.oneIn(3)) addProperty(*tile, new osgVolume::SampleRatioProperty(strangeValue(dice)));
    if (dice.oneIn(3)) addProperty(*tile, new osgVolume::SampleDensityProperty(strangeValue(dice)));
    if (dice.oneIn(3)) addProperty(*tile, new osgVolume::LightingProperty);
    if (dice.oneIn(4)) addProperty(*tile, new osgVolume::IsoSurfaceProperty(strangeValue(dice)));
    if (dice.oneIn(2))
    {
        const osg::ref_ptr<osgRayTrace::Medium> medium = new osgRayTrace::Medium;
        const auto scale = static_cast<float>(std::pow(10.0, dice.between(-3.0, 6.0)));
        medium->setScattering(osg::Vec3(strangeValue(dice), 1.0f, 0.5f) * scale);
        medium->setAbsorption(osg::Vec3(0.1f, strangeValue(dice), 0.5f) * scale);
        if (dice.oneIn(3)) medium->setEmission(osg::Vec3(1.0f, strangeValue(dice), 0.5f));
        medium->setAnisotropy(strangeValue(dice));
        const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
        material->setInterior(medium);
        tile->getOrCreateStateSet()->setAttribute(material);
    }
    return tile;
}

} // namespace

TEST_CASE("fuzz: random volumes are traced without an invalid value", "[fuzz]")
{
    osg::setNotifyLevel(osg::ALWAYS);
    const auto workers = std::make_shared<Workers>(1);
    uint64_t converted = 0;
    forEachSeed(
        kSeeds,
        [&](uint32_t seed)
        {
            Dice dice(seed);
            const osg::ref_ptr<osg::Group> root = new osg::Group;
            root->addChild(triangleGeometry());
            const int tiles = dice.oneIn(10) ? 20 : 1 + dice.below(3);
            for (int i = 0; i < tiles; ++i)
                root->addChild(randomTile(dice));
            const ConversionResult result = convertGraph(root);
            REQUIRE(result.scene->volumes.size() <= kMostVolumes);
            converted += result.scene->volumes.size();
            const auto traced = TracedScene::build(result.scene, workers);
            for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
            {
                RenderOptions options;
                options.integrator = kind;
                const engine::test::Picture picture = engine::test::render(
                    traced,
                    engine::test::perspectiveView({0.2, -6, 1}, {0, 0, 0}, {0, 0, 1}, 40.0, kSize,
                                                  kSize),
                    options, 1, 1);
                CAPTURE(seed, int(kind));
                CHECK(picture.progress.droppedSamples == 0);
                for (const float value : picture.rgba)
                    REQUIRE(std::isfinite(value));
            }
        });
    CHECK(converted > 0);
}
