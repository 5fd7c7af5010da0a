// MediaTest.cpp - Medium, MediumVolume, interiors and fog as a medium. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/materials/MediumConversion.h"
#include "osgRayTrace/bridge/changes/GraphHash.h"
#include "osgRayTrace/scene/FogMedium.h"
#include "osgRayTrace/scene/SceneTraits.h"

#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/bridge/Graphs.h"
#include "tests/bridge/LiveGraph.h"

#include <osgRayTrace/MediumVolume>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/Fog>
#include <osg/ShapeDrawable>

#include <cmath>
#include <limits>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::test;

namespace
{

using ApiMedium = osgRayTrace::Medium;

osg::ref_ptr<ApiMedium> hazeMedium()
{
    const osg::ref_ptr<ApiMedium> medium = new ApiMedium;
    medium->setAbsorption({0.1f, 0.2f, 0.3f});
    medium->setScattering({1.0f, 2.0f, 3.0f});
    medium->setEmission({0.5f, 0.25f, 0.125f});
    medium->setAnisotropy(-0.5f);
    medium->setPriority(7);
    return medium;
}

/// Returns what a closed mesh holds; negative if its fronts are inside.
double volumeOf(const Mesh& mesh)
{
    double sum = 0.0;
    for (const UVec3& t : mesh.triangles)
    {
        const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
        sum += double(glm::dot(a, glm::cross(b, c))) / 6.0;
    }
    return sum;
}

} // namespace

TEST_CASE("medium: coefficients from colours, and values that are refused", "[bridge]")
{
    const osg::ref_ptr<ApiMedium> medium = new ApiMedium;
    medium->setAttenuation({0.5f, 0.25f, 1.0f}, 2.0f);
    CHECK(medium->getAbsorption().x() == Approx(std::log(2.0) / 2.0));
    CHECK(medium->getAbsorption().y() == Approx(std::log(4.0) / 2.0));
    CHECK(medium->getAbsorption().z() == 0.0f);
    medium->setAbsorption({2.0f, 2.0f, 2.0f});
    // Diffuse reflectances 1 - 2 sqrt(1 - a) integral of mu H(mu) of half-spaces of albedo 0.5, 0.9
    // and 0.99 [Chandrasekhar60].
    medium->setMultiscatterColor({0.14635f, 0.4779f, 0.79453f});
    CHECK(medium->getScattering().x() / 2.0f == Approx(0.5).margin(0.006));
    CHECK(medium->getScattering().y() / 2.0f == Approx(0.9).margin(0.002));
    CHECK(medium->getScattering().z() / 2.0f == Approx(0.99).margin(0.001));
    for (int c = 0; c < 3; ++c)
        CHECK(medium->getAbsorption()[c] + medium->getScattering()[c] == Approx(2.0));
    medium->setMultiscatterColor({0.0f, 1.0f, 2.0f});
    CHECK(medium->getScattering().x() == Approx(0.0).margin(1e-4));
    CHECK(medium->getAbsorption().y() == Approx(0.0).margin(1e-4));
    medium->setAnisotropy(2.0f);
    CHECK(medium->getAnisotropy() == 0.999f);
    medium->setAnisotropy(std::numeric_limits<float>::quiet_NaN());
    CHECK(medium->getAnisotropy() == 0.999f);
    medium->setScattering({-1.0f, 1.0f, std::numeric_limits<float>::infinity()});
    CHECK(medium->getScattering().x() == 0.0f);
    CHECK(medium->getScattering().y() == 1.0f);
    CHECK(medium->compare(*medium) == 0);
    CHECK(medium->compare(*hazeMedium()) == -hazeMedium()->compare(*medium));
}

TEST_CASE("medium: bodies that are open are named", "[bridge]")
{
    float metallic = 0.0f;
    const auto openBodies =
        [&](const osg::ref_ptr<osg::ShapeDrawable>& drawable, float transmission)
    {
        const osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
        physical->setMetallic(metallic);
        physical->setTransmission(transmission);
        physical->setInterior(hazeMedium());
        drawable->getOrCreateStateSet()->setAttribute(physical);
        const ConversionResult result = convertGraph(drawable);
        const auto found = result.counts.find("warned.open-body");
        return found == result.counts.end() ? uint64_t(0) : found->second;
    };
    const osg::Vec3 place(3.0f, -2.0f, 7.0f);
    for (const osg::ref_ptr<osg::Shape>& shape : std::vector<osg::ref_ptr<osg::Shape>>{
             new osg::Box(place, 2.0f), new osg::Sphere(place, 1.0f),
             new osg::Cylinder(place, 1.0f, 2.0f), new osg::Cone(place, 1.0f, 2.0f),
             new osg::Capsule(place, 1.0f, 2.0f)})
    {
        CAPTURE(shape->className());
        CHECK(openBodies(new osg::ShapeDrawable(shape), 1.0f) == 0);
    }
    const osg::ref_ptr<osg::TessellationHints> noTop = new osg::TessellationHints;
    noTop->setCreateTop(false);
    const osg::ref_ptr<osg::Shape> cylinder = new osg::Cylinder(place, 1.0f, 2.0f);
    CHECK(openBodies(new osg::ShapeDrawable(cylinder, noTop), 1.0f) == 1);
    CHECK(openBodies(new osg::ShapeDrawable(cylinder, noTop), 0.0f) == 0);
    metallic = 1.0f;
    CHECK(openBodies(new osg::ShapeDrawable(cylinder, noTop), 1.0f) == 0);
}

TEST_CASE("medium: droplets have a size, which counts with their phase function alone", "[bridge]")
{
    const osg::ref_ptr<ApiMedium> medium = hazeMedium();
    CHECK(medium->getPhase() == ApiMedium::HENYEY_GREENSTEIN);
    medium->setDropletSize(20.0f);
    CHECK(engine::mediumOf(*medium).dropletSize == 0.0f);
    medium->setPhase(ApiMedium::DROPLETS);
    CHECK(engine::mediumOf(*medium).dropletSize == 20.0f);
    CHECK(medium->compare(*hazeMedium()) != 0);
    medium->setDropletSize(0.5f);
    CHECK(medium->getDropletSize() == 5.0f);
    medium->setDropletSize(1e9f);
    CHECK(medium->getDropletSize() == 50.0f);
    medium->setDropletSize(std::numeric_limits<float>::quiet_NaN());
    CHECK(medium->getDropletSize() == 50.0f);
    const osg::ref_ptr<ApiMedium> copy = new ApiMedium(*medium);
    CHECK(copy->compare(*medium) == 0);
}

TEST_CASE("medium: the interior of a material, in place of its attenuation", "[bridge]")
{
    const osg::ref_ptr<PhysicalMaterial> physical = new PhysicalMaterial;
    physical->setTransmission(1.0f);
    physical->setAttenuationDistance(1.0f);
    physical->setAttenuationColor({0.5f, 0.5f, 0.5f});
    physical->setInterior(hazeMedium());
    const osg::ref_ptr<osg::Geometry> geometry = triangleGeometry();
    geometry->getOrCreateStateSet()->setAttribute(physical);
    const ConversionResult result = convertGraph(geometry);
    const Material& material = soleMaterial(result);
    REQUIRE(material.detail);
    const engine::Medium& interior = material.detail->interior;
    CHECK(interior.sigmaA == Vec3(0.1f, 0.2f, 0.3f));
    CHECK(interior.sigmaS == Vec3(1.0f, 2.0f, 3.0f));
    CHECK(interior.emission == Vec3(0.5f, 0.25f, 0.125f));
    CHECK(interior.anisotropy == -0.5f);
    CHECK(interior.priority == 7);
    CHECK_FALSE(isInterface(material));
    CHECK(sceneTraits(*result.scene).scattering);
    physical->setIor(1.0f);
    CHECK(isInterface(soleMaterial(convertGraph(geometry))));
    physical->setThinWalled(true);
    CHECK_FALSE(sceneTraits(*convertGraph(geometry).scene).media);
    const osg::ref_ptr<PhysicalMaterial> copy =
        osg::clone(physical.get(), osg::CopyOp::SHALLOW_COPY);
    CHECK(copy->getInterior() == physical->getInterior());
    CHECK(copy->compare(*physical) == 0);
    const osg::ref_ptr<PhysicalMaterial> deep =
        osg::clone(physical.get(), osg::CopyOp::DEEP_COPY_ALL);
    CHECK(deep->getInterior() != physical->getInterior());
    CHECK(deep->compare(*physical) == 0);
    deep->getInterior()->setPriority(8);
    CHECK(deep->compare(*physical) != 0);
}

TEST_CASE("medium volume: the first one with a medium fills the scene", "[bridge]")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    CHECK_FALSE(convertGraph(root).scene->atmosphere);
    const osg::ref_ptr<MediumVolume> empty = new MediumVolume;
    root->addChild(empty);
    const osg::ref_ptr<MediumVolume> volume = new MediumVolume(hazeMedium());
    volume->setRadius(3.0f);
    root->addChild(placed(osg::Matrixd::scale(5, 5, 5) * osg::Matrixd::translate(1, 2, 3), volume));
    root->addChild(new MediumVolume(hazeMedium()));
    const ConversionResult result = convertGraph(root);
    REQUIRE(result.scene->atmosphere);
    CHECK(result.scene->atmosphere->medium.sigmaS == Vec3(1.0f, 2.0f, 3.0f));
    CHECK(result.scene->atmosphere->centre == Vec3(1, 2, 3));
    CHECK(result.scene->atmosphere->radius == 3.0f);
    CHECK(countOf(result, "skipped.medium-volume") == 2);
    CHECK_FALSE(result.scene->displayReferred);
    volume->setRadius(-1.0f);
    CHECK(volume->getRadius() == 0.0f);
    volume->setRadius(std::numeric_limits<float>::quiet_NaN());
    CHECK(volume->getRadius() == 0.0f);
}

TEST_CASE("medium volume: a layer has its height and its up from the node's place", "[bridge]")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    const osg::ref_ptr<MediumVolume> volume = new MediumVolume(hazeMedium());
    CHECK(volume->getScaleHeight() == 1.0f);
    volume->setScaleHeight(2.5f);
    root->addChild(
        placed(osg::Matrixd::scale(5, 5, 5) * osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0)) *
                   osg::Matrixd::translate(1, 2, 3),
               volume));
    CHECK(convertGraph(root).scene->atmosphere->scaleHeight == 0.0f);
    volume->setShape(MediumVolume::LAYER);
    const ConversionResult result = convertGraph(root);
    REQUIRE(result.scene->atmosphere);
    CHECK(result.scene->atmosphere->centre == Vec3(1, 2, 3));
    CHECK(result.scene->atmosphere->scaleHeight == 2.5f);
    const Vec3 up = result.scene->atmosphere->up;
    CHECK(glm::length(up - Vec3(0, -1, 0)) < 1e-6f);
    for (const float bad : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()})
        volume->setScaleHeight(bad);
    CHECK(volume->getScaleHeight() == 2.5f);
    const osg::ref_ptr<MediumVolume> copy = osg::clone(volume.get());
    CHECK(copy->getShape() == MediumVolume::LAYER);
    CHECK(copy->getScaleHeight() == 2.5f);
}

TEST_CASE("medium volume: a box is a closed boundary that is not seen", "[bridge]")
{
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(triangleGeometry());
    const osg::ref_ptr<MediumVolume> volume = new MediumVolume(hazeMedium());
    volume->setShape(MediumVolume::BOX);
    volume->setBox({-1, -2, -3, 1, 2, 3});
    CHECK(volume->getBound().radius() == Approx(std::sqrt(14.0)));
    const osg::ref_ptr<osg::StateSet> above = root->getOrCreateStateSet();
    above->setAttribute(new PhysicalMaterial, osg::StateAttribute::OVERRIDE);
    above->setMode(GL_BLEND, osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE);
    root->addChild(placed(osg::Matrixd::rotate(0.5, osg::Vec3d(0, 1, 0)), volume));
    root->addChild(placed(osg::Matrixd::translate(9, 0, 0), volume));
    const ConversionResult result = convertGraph(root);
    CHECK_FALSE(result.scene->atmosphere);
    CHECK(countOf(result, "skipped.medium-volume") == 0);
    CHECK(countOf(result, "warned.open-body") == 0);
    std::size_t boxes = 0;
    for (const Instance& instance : result.scene->instances)
    {
        const engine::Material& material = result.scene->materials[instance.material];
        if (!engine::isInterface(material)) continue;
        ++boxes;
        CHECK(material.detail->interior.sigmaS == Vec3(1.0f, 2.0f, 3.0f));
        const Mesh& mesh = *result.scene->meshes[instance.mesh];
        CHECK(mesh.triangles.size() == 12);
        CHECK(volumeOf(mesh) == Approx(48.0));
    }
    CHECK(boxes == 2);
    volume->setBox({0, 0, 0, 1, 1, 0});
    CHECK(countOf(convertGraph(root), "skipped.medium-volume") == 2);
    volume->setBox({0, 0, 0, 1, 1, std::numeric_limits<float>::infinity()});
    CHECK(volume->getBox().zMax() == 0.0f);
}

TEST_CASE("medium volume: a box has its own medium, and that of the scene around it", "[bridge]")
{
    // A lamp of radiance 1 behind 7 of haze and 3 of what is in the box.
    const osg::ref_ptr<osg::Geometry> lamp = osg::createTexturedQuadGeometry(
        osg::Vec3(10, -5, -5), osg::Vec3(0, 0, 10), osg::Vec3(0, 10, 0));
    const osg::ref_ptr<PhysicalMaterial> shining = new PhysicalMaterial;
    shining->setBaseColor({0.0f, 0.0f, 0.0f});
    shining->setEmission({1.0f, 1.0f, 1.0f});
    lamp->getOrCreateStateSet()->setAttribute(shining);
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(lamp);
    const auto add = [&](const osg::Vec3& absorption)
    {
        const osg::ref_ptr<ApiMedium> medium = new ApiMedium;
        medium->setAbsorption(absorption);
        const osg::ref_ptr<MediumVolume> volume = new MediumVolume(medium);
        root->addChild(volume);
        return volume;
    };
    add({0.1f, 0.2f, 0.0f})->setRadius(100.0f);
    const osg::ref_ptr<MediumVolume> box = add({0.3f, 0.0f, 0.2f});
    box->setShape(MediumVolume::BOX);
    box->setBox({2, -1, -1, 5, 1, 1});
    const ConversionResult result = convertGraph(root);
    const auto traced = TracedScene::build(result.scene, std::make_shared<Workers>(1), nullptr);
    const View view =
        engine::test::perspectiveView({0.0, 0.1, 0.2}, {1.0, 0.1, 0.2}, {0, 0, 1}, 0.1, 4, 4);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Vec3 seen =
            engine::test::render(traced, view, engine::test::optionsOf(kind), 1).mean();
        CAPTURE(int(kind), seen.x, seen.y, seen.z);
        CHECK(seen.x == Approx(std::exp(-0.1 * 7 - 0.3 * 3)).epsilon(1e-4));
        CHECK(seen.y == Approx(std::exp(-0.2 * 7)).epsilon(1e-4));
        CHECK(seen.z == Approx(std::exp(-0.2 * 3)).epsilon(1e-4));
    }
}

TEST_CASE("medium volume: edits are seen", "[bridge]")
{
    LiveGraph graph;
    const osg::ref_ptr<MediumVolume> volume = new MediumVolume(hazeMedium());
    graph.root->addChild(volume);
    LiveView view(graph.root.get());
    view.image();
    const auto edit = [&](const char* what, const std::function<void()>& change)
    {
        INFO(what);
        change();
        const std::vector<float> before = view.lastImage();
        CHECK(wrongPixels(view, *graph.root) <= kRoundedPixels);
        CHECK(differentPixels(view.lastImage(), before) > kRoundedPixels);
    };
    edit("absorption", [&] { volume->getMedium()->setAbsorption({0.02f, 0.01f, 0.0f}); });
    edit("scattering", [&] { volume->getMedium()->setScattering({0.02f, 0.01f, 0.0f}); });
    edit("droplets", [&] { volume->getMedium()->setPhase(ApiMedium::DROPLETS); });
    edit("droplet size", [&] { volume->getMedium()->setDropletSize(30.0f); });
    edit("emission", [&] { volume->getMedium()->setEmission({0.0f, 0.1f, 0.0f}); });
    edit("radius", [&] { volume->setRadius(1.0f); });
    edit("layer", [&] { volume->setShape(MediumVolume::LAYER); });
    edit("scale height", [&] { volume->setScaleHeight(0.2f); });
    edit("box",
         [&]
         {
             volume->setBox({0.11f, 0.07f, 0.13f, 1.03f, 0.97f, 1.21f}); // in no surface's plane
             volume->setShape(MediumVolume::BOX);
         });
    edit("corners", [&] { volume->setBox({0.11f, 0.07f, 0.13f, 2.03f, 0.57f, 1.21f}); });
    edit("scattering in the box", [&] { volume->getMedium()->setScattering({0.0f, 1.0f, 0.5f}); });
    edit("absorption in the box", [&] { volume->getMedium()->setAbsorption({1.0f, 0.0f, 0.0f}); });
    const osg::ref_ptr<ApiMedium> other = new ApiMedium(*volume->getMedium());
    other->setScattering({2.0f, 0.0f, 0.0f});
    edit("medium", [&] { volume->setMedium(other); });
    edit("everywhere", [&] { volume->setShape(MediumVolume::EVERYWHERE); });
    edit("none", [&] { graph.root->removeChild(volume); });
}

TEST_CASE("subsurface: edits of colour, radius and weight are patched, and begin a new image",
          "[bridge]")
{
    LiveGraph graph;
    const osg::ref_ptr<PhysicalMaterial> wax = new PhysicalMaterial;
    wax->setBaseColor({0.9f, 0.6f, 0.4f});
    wax->setSubsurfaceRadius({0.3f, 0.2f, 0.1f});
    const osg::ref_ptr<osg::ShapeDrawable> ball =
        new osg::ShapeDrawable(new osg::Sphere({1.0f, 0.5f, 0.6f}, 0.6f));
    ball->getOrCreateStateSet()->setAttribute(wax);
    graph.root->addChild(ball);
    LiveView view(graph.root.get());
    view.image();
    view.image();
    REQUIRE(view.passes() == 2);
    CHECK_FALSE(sceneTraits(*view.scene()).subsurface);
    const auto edit = [&](const char* what, const std::function<void()>& change)
    {
        INFO(what);
        const Statistics before = view.statistics();
        const std::vector<float> last = view.lastImage();
        change();
        view.update();
        const std::vector<float> image = view.image();
        CHECK(view.passes() == 1);
        CHECK(view.statistics().patches == before.patches + 1);
        CHECK(view.statistics().conversions == before.conversions);
        CHECK(differentPixels(image, last) > kRoundedPixels);
        const int different = differentPixels(image, freshImage(*graph.root, 1));
        CHECK(different >= 0);
        CHECK(different <= kRoundedPixels);
        view.image();
        CHECK(view.passes() == 2);
    };
    edit("whole", [&] { wax->setSubsurface(1.0f); });
    CHECK(sceneTraits(*view.scene()).subsurface);
    edit("colour", [&] { wax->setBaseColor({0.5f, 0.6f, 0.9f}); });
    edit("radius", [&] { wax->setSubsurfaceRadius({0.3f, 0.2f, 0.4f}); });
    edit("weight", [&] { wax->setSubsurface(0.5f); });
    edit("none", [&] { wax->setSubsurface(0.0f); });
    edit("again", [&] { wax->setSubsurface(0.75f); });
}

TEST_CASE("fog as a medium: the setting, and the equal half distances of all modes", "[bridge]")
{
    Fog fog;
    fog.color = Vec3(0.25f, 0.5f, 1.0f);
    fog.density = 0.5f;
    fog.start = 1.0f;
    fog.end = 3.0f;
    fog.mode = FogMode::Exponential;
    CHECK(mediumOf(fog).sigmaS.y == Approx(0.25));
    CHECK(mediumOf(fog).sigmaA.y == Approx(0.25));
    CHECK(mediumOf(fog).sigmaA.z == 0.0f);
    fog.mode = FogMode::ExponentialSquared;
    CHECK(mediumOf(fog).sigmaS.z == Approx(std::sqrt(std::log(2.0)) * 0.5));
    fog.mode = FogMode::Linear;
    CHECK(mediumOf(fog).sigmaS.z == Approx(std::log(2.0) / 2.0));
    for (const FogMode mode : {FogMode::Linear, FogMode::ExponentialSquared, FogMode::Exponential})
    {
        fog.mode = mode;
        const double half = std::log(2.0) / double(mediumOf(fog).sigmaS.z);
        CHECK(fogShare(fog, float(half)) == Approx(0.5).margin(1e-5));
    }

    const osg::ref_ptr<osg::Geometry> geometry = triangleGeometry();
    osg::ref_ptr<osg::Fog> source = new osg::Fog;
    source->setMode(osg::Fog::EXP);
    source->setDensity(0.5f);
    geometry->getOrCreateStateSet()->setAttributeAndModes(source);
    SceneConverter converter;
    ConversionInput input = inputFor(geometry);
    const SceneTraits depth = sceneTraits(*converter.convert(input).scene);
    CHECK(depth.fog);
    CHECK_FALSE(depth.media);
    input.fogUse = FogUse::Medium;
    const SceneTraits medium = sceneTraits(*converter.convert(input).scene);
    CHECK_FALSE(medium.fog);
    CHECK(medium.media);
    input.fogUse = FogUse::Off;
    const SceneTraits none = sceneTraits(*converter.convert(input).scene);
    CHECK_FALSE(none.fog);
    CHECK_FALSE(none.media);
}
