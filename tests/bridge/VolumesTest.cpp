// VolumesTest.cpp - osgVolume's tiles become volumes. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/media/VolumeSample.h"
#include "osgRayTrace/scene/SceneTraits.h"

#include "tests/Catch.h"
#include "tests/VolumeTiles.h"
#include "tests/bridge/Graphs.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/Medium>
#include <osgRayTrace/MediumVolume>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/LightSource>

#include <limits>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

osg::ref_ptr<osgVolume::VolumeTile> ballTile(osg::Image* image = nullptr)
{
    return tileOf(image ? image : ballImage(8).get(), blueToYellow(),
                  new osgVolume::MultipassTechnique, osg::Matrixd::scale(2.0, 3.0, 4.0));
}

osg::ref_ptr<osg::Group> groupWith(osg::Node* tile)
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    root->addChild(tile);
    return root;
}

} // namespace

TEST_CASE("volume tiles: place, voxels and properties", "[bridge][volumes]")
{
    const osg::ref_ptr<osgVolume::VolumeTile> tile = ballTile();
    addProperty(*tile, new osgVolume::TransparencyProperty(0.7f));
    addProperty(*tile, new osgVolume::AlphaFuncProperty(0.3f));
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    const osg::ref_ptr<osgVolume::VolumeScene> together = new osgVolume::VolumeScene;
    together->addChild(placed(osg::Matrixd::translate(1, 2, 3), tile));
    root->addChild(together);
    const ConversionResult result = convertGraph(root);
    CHECK(countOf(result, "converted.volume") == 1);
    REQUIRE(result.scene->volumes.size() == 1);
    const Volume& volume = result.scene->volumes[0];
    CHECK(volume.law == VolumeLaw::Cells);
    CHECK(volume.transparency == 0.7f);
    CHECK(volume.cutoff == 0.3f);
    CHECK(volume.image->channels == 1);
    CHECK(volume.image->bytes.size() == 512);
    const Vec3d origin = result.scene->origin;
    const Vec3 middle(Vec3d(2.0, 3.5, 5.0) - origin);
    const Vec3 found = transformPoint(volume.imageFromEngine, middle);
    for (int k = 0; k < 3; ++k)
        CHECK(found[k] == Approx(0.5).epsilon(1e-5));
    // The middle of the ball has a value of 0.8, which the function makes yellow.
    const VolumePoint point = volumePoint(volume, found);
    CHECK(point.opacity == Approx(0.4).margin(0.01));
    CHECK(point.color.x > 0.85f);
    const SceneTraits traits = sceneTraits(*result.scene);
    CHECK(traits.volumes);
    CHECK(traits.media);
    CHECK_FALSE(traits.scattering);
}

TEST_CASE("volume tiles: the interior of a material in the tile's state is a density",
          "[bridge][volumes]")
{
    const osg::ref_ptr<osgVolume::VolumeTile> tile = ballTile();
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    const osg::ref_ptr<osgRayTrace::Medium> medium = new osgRayTrace::Medium;
    medium->setScattering({1.0f, 2.0f, 3.0f});
    material->setInterior(medium);
    tile->getOrCreateStateSet()->setAttribute(material);
    const ConversionResult result = convertGraph(groupWith(tile));
    REQUIRE(result.scene->volumes.size() == 1);
    CHECK(result.scene->volumes[0].law == VolumeLaw::Density);
    CHECK(result.scene->volumes[0].medium.sigmaS == Vec3(1.0f, 2.0f, 3.0f));
    CHECK_FALSE(result.scene->displayReferred);
    CHECK(sceneTraits(*result.scene).scattering);
}

TEST_CASE("volume tiles: smoke without surfaces is lit by all lights", "[bridge][volumes]")
{
    const osg::ref_ptr<osgVolume::VolumeTile> tile = ballTile();
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(tile);
    root->addChild(new osg::LightSource);
    // A tile that glows has no use for lights.
    CHECK(convertGraph(root).scene->lights.empty());
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    const osg::ref_ptr<osgRayTrace::Medium> medium = new osgRayTrace::Medium;
    medium->setScattering({1.0f, 2.0f, 3.0f});
    material->setInterior(medium);
    tile->getOrCreateStateSet()->setAttribute(material);
    CHECK(convertGraph(root).scene->lights.size() == 1);
    // The boundary of a box of haze is no surface, and the haze is lit as the smoke is.
    const osg::ref_ptr<MediumVolume> box = new MediumVolume(medium);
    box->setShape(MediumVolume::BOX);
    root->addChild(box);
    CHECK(convertGraph(root).scene->lights.size() == 1);
    root->removeChild(tile);
    CHECK(convertGraph(root).scene->lights.size() == 1);
    root->addChild(tile);
    // A surface that has not enabled the light decides for the smoke, too.
    root->addChild(triangleGeometry());
    root->getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::OFF);
    CHECK(convertGraph(root).scene->lights.empty());
}

TEST_CASE("volume tiles: the last surface beside smoke goes", "[bridge][volumes]")
{
    const osg::ref_ptr<osgVolume::VolumeTile> tile = ballTile();
    const osg::ref_ptr<PhysicalMaterial> material = new PhysicalMaterial;
    const osg::ref_ptr<osgRayTrace::Medium> medium = new osgRayTrace::Medium;
    medium->setScattering({1.0f, 2.0f, 3.0f});
    material->setInterior(medium);
    tile->getOrCreateStateSet()->setAttribute(material);
    const osg::ref_ptr<osg::LightSource> lamp = new osg::LightSource;
    lamp->getLight()->setLightNum(3); // which no surface has enabled
    const osg::ref_ptr<osg::Geometry> surface = triangleGeometry();
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(tile);
    root->addChild(lamp);
    root->addChild(surface);
    LiveView view(root);
    view.update();
    const std::size_t before = view.scene()->lights.size();
    root->removeChild(surface);
    view.update();
    LiveView fresh(root);
    fresh.update();
    CHECK(view.scene()->lights.size() == before + 1);
    CHECK(fresh.scene()->lights.size() == before + 1);
}

TEST_CASE("volume tiles: what cannot be traced is left to OSG by name", "[bridge][volumes]")
{
    using Edit = std::function<void(osgVolume::VolumeTile&)>;
    const Edit edits[] = {
        [](osgVolume::VolumeTile& t)
        { addProperty(t, new osgVolume::MaximumIntensityProjectionProperty); },
        [](osgVolume::VolumeTile& t) { t.setVolumeTechnique(nullptr); },
        [](osgVolume::VolumeTile& t) { t.addChild(triangleGeometry()); },
        [](osgVolume::VolumeTile& t) { t.setLayer(new osgVolume::CompositeLayer); },
    };
    for (const Edit& edit : edits)
    {
        const osg::ref_ptr<osgVolume::VolumeTile> tile = ballTile();
        edit(*tile);
        ConversionInput input = inputFor(groupWith(tile));
        const osg::ref_ptr<osg::Group> root = groupWith(tile);
        input = inputFor(root);
        CHECK(countOf(SceneConverter().convert(input), "not-traced.volume") == 1);
        input.rasterizesRest = true;
        const ConversionResult viewed = SceneConverter().convert(input);
        CHECK(countOf(viewed, "rasterized.volume") == 1);
        CHECK(viewed.scene->volumes.empty());
    }
}

TEST_CASE("volume tiles: those without an image or a place are skipped", "[bridge][volumes]")
{
    const osg::ref_ptr<osg::Image> compressed = ballImage(4);
    compressed->setPixelFormat(GL_COMPRESSED_RGBA_S3TC_DXT1_EXT);
    for (osg::Image* image : {new osg::Image, compressed.get()})
    {
        const ConversionResult result = convertGraph(groupWith(ballTile(image)));
        CHECK(countOf(result, "skipped.volume") == 1);
        CHECK(result.scene->volumes.empty());
    }
    const osg::ref_ptr<osgVolume::VolumeTile> flat = ballTile();
    flat->getLocator()->setTransform(osg::Matrixd::scale(1.0, 0.0, 1.0));
    CHECK(countOf(convertGraph(groupWith(flat)), "skipped.volume") == 1);

    const osg::ref_ptr<osg::Image> damaged = new osg::Image;
    damaged->allocateImage(2, 2, 2, GL_LUMINANCE, GL_FLOAT);
    auto* values = reinterpret_cast<float*>(damaged->data());
    std::fill(values, values + 8, 0.5f);
    values[3] = std::numeric_limits<float>::quiet_NaN();
    values[5] = std::numeric_limits<float>::infinity();
    const ConversionResult repaired = convertGraph(groupWith(ballTile(damaged)));
    CHECK(countOf(repaired, "repaired.voxel") == 2);
    REQUIRE(repaired.scene->volumes.size() == 1);
    CHECK(repaired.scene->volumes[0].image->floats[3] == 0.0f);
}

TEST_CASE("volume tiles: edits are seen, and convert no voxels again without need",
          "[bridge][volumes]")
{
    const osg::ref_ptr<osg::Image> image = ballImage(8);
    const osg::ref_ptr<osgVolume::VolumeTile> tile = ballTile(image);
    const osg::ref_ptr<osg::Group> root = groupWith(tile);
    LiveView view(root);
    view.update();
    REQUIRE(view.scene()->volumes.size() == 1);
    auto voxels = view.scene()->volumes[0].image;
    const auto mesh = view.scene()->meshes.front();
    Stamp changed = view.scene()->volumes[0].changed;
    const auto sees = [&](bool newVoxels)
    {
        view.update();
        const Volume& volume = view.scene()->volumes.at(0);
        CHECK(volume.changed > changed);
        CHECK((volume.image != voxels) == newVoxels);
        CHECK(view.scene()->meshes.front() == mesh);
        voxels = volume.image;
        changed = volume.changed;
    };
    tile->getLocator()->setTransform(osg::Matrixd::scale(2.0, 3.0, 5.0));
    sees(false);
    auto* property = static_cast<osgVolume::CompositeProperty*>(tile->getLayer()->getProperty());
    static_cast<osgVolume::TransferFunctionProperty*>(property->getProperty(0))
        ->setTransferFunction(blueToYellow(0.9f));
    sees(false);
    addProperty(*tile, new osgVolume::TransparencyProperty(0.5f));
    sees(false);
    image->data(3, 3, 3)[0] = 77;
    image->dirty();
    sees(true);
    view.update();
    CHECK(view.scene()->volumes[0].changed == changed);
}
