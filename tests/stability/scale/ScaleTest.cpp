// ScaleTest.cpp - the same scene as small as an atom and as large as the solar system. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/stability/scale/ScaledScene.h"

#include <osg/LightSource>

#include <cmath>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

const Recipe kWhitted{RayTraceSettings::WHITTED, 4, 8};
const Recipe kPath{RayTraceSettings::PATH, 5, 8};

struct Comparison
{
    double relativeMse = HUGE_VAL;
    double depth = HUGE_VAL;    ///< largest difference of window depths
    double distance = HUGE_VAL; ///< largest relative difference of distances
    double position = HUGE_VAL; ///< largest difference of positions before placement
};

/// Compares the pictures, and checks that distances are finite if the reference hits something.
Comparison compare(const Picture& picture, const Picture& reference, double scale)
{
    Comparison c;
    c.relativeMse = relativeMse(picture, reference);
    if (picture.distance.size() != reference.distance.size()) return c;
    c.depth = c.distance = c.position = 0.0;
    for (std::size_t i = 0; i < reference.distance.size(); ++i)
    {
        const double near = std::abs(double(picture.depth[i]) - reference.depth[i]);
        c.depth = std::max(c.depth, near);
        if (std::isinf(reference.distance[i]) && std::isinf(picture.distance[i])) continue;
        const double t = picture.distance[i] / scale;
        c.distance = std::max(
            c.distance, std::isfinite(t) ? std::abs(t / reference.distance[i] - 1.0) : HUGE_VAL);
        for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
            c.position =
                std::max(c.position, std::abs(picture.position[k] / scale - reference.position[k]));
    }
    return c;
}

void checkSame(const Picture& picture, const Picture& reference, double scale)
{
    CHECK(picture.statistics.ok);
    CHECK(picture.statistics.message.empty());
    CHECK(picture.statistics.droppedSamples == 0);
    CHECK(picture.statistics.triangles == reference.statistics.triangles);
    CHECK(allFinite(picture.rgba));
    const Comparison c = compare(picture, reference, scale);
    CHECK(c.relativeMse <= 1e-8);
    CHECK(c.depth <= 1e-6);
    CHECK(c.distance <= 1e-5);
    CHECK(c.position <= 1e-5);
}

using MakeScene = osg::ref_ptr<osg::Group> (*)(const Placement&);

void checkScales(MakeScene makeScene, const Recipe& recipe, bool attenuated,
                 const std::vector<double>& scales)
{
    Placement unit;
    unit.attenuated = attenuated;
    const Picture reference = pictureOf(*makeScene(unit), unit, recipe);
    REQUIRE(reference.statistics.ok);
    for (const double scale : scales)
    {
        for (const Storage storage : {Storage::Local, Storage::Float, Storage::Double})
        {
            CAPTURE(scale, int(storage));
            const Placement placement{scale, osg::Vec3d(), storage, attenuated};
            checkSame(pictureOf(*makeScene(placement), placement, recipe), reference, scale);
        }
    }
}

uint64_t skippedThings(const Picture& picture)
{
    uint64_t sum = 0;
    for (const auto& [what, count] : picture.statistics.conversion)
        if (what.rfind("skipped.", 0) == 0) sum += count;
    return sum;
}

/// Returns the relative mean squared error without the worst pixel. Points on a lamp are chosen by
/// angle where it is wide, and else by area: at the limit, rounding decides.
double relativeMseOfOthers(Picture picture, const Picture& reference)
{
    if (picture.rgba.size() != reference.rgba.size()) return HUGE_VAL;
    std::size_t worst = 0;
    double largest = -1.0;
    for (std::size_t i = 0; i < reference.rgba.size(); ++i)
    {
        const double difference = std::abs(double(picture.rgba[i]) - reference.rgba[i]) /
                                  std::max(double(reference.rgba[i]), 0.01);
        if (!(difference > largest)) continue;
        largest = difference;
        worst = i / 4 * 4;
    }
    for (std::size_t k = worst; k < worst + 4; ++k)
        picture.rgba[k] = reference.rgba[k];
    return relativeMse(picture, reference);
}

} // namespace

TEST_CASE("stability 3: OpenGL lights and materials look the same at any scale", "[stability]")
{
    checkScales(classicScene, kWhitted, true, {1e-6, 1e-12, 1e6, 1e12});
    checkScales(classicScene, kPath, true, {1e-12, 1e12});
}

TEST_CASE("stability 3: area lights, metal and glass look the same at any scale", "[stability]")
{
    checkScales(physicalScene, kPath, true, {1e-6, 1e-12, 1e6, 1e12});
}

TEST_CASE("stability 4: scales of 1e-20 and 1e18 look the same", "[stability]")
{
    // The coefficients of attenuation are floats, and 1e40 is not a float.
    checkScales(classicScene, kWhitted, false, {1e-20, 1e18});
    checkScales(physicalScene, kPath, false, {1e-20, 1e18});
}

TEST_CASE("stability 4: at the end of the floats a picture is right or refused", "[stability]")
{
    Placement unit;
    unit.attenuated = false;
    const Picture reference = pictureOf(*physicalScene(unit), unit, kPath);
    for (const double scale : {1e-300, 1e-200, 1e-60, 1e-40, 1e-37, 1e-30, 1e30, 1e37, 1e40, 1e200})
    {
        for (const Storage storage : {Storage::Local, Storage::Float, Storage::Double})
        {
            CAPTURE(scale, int(storage));
            const Placement placement{scale, osg::Vec3d(), storage, false};
            const Picture picture = pictureOf(*physicalScene(placement), placement, kPath);
            CHECK(allFinite(picture.rgba));
            CHECK(picture.statistics.droppedSamples == 0);
            const bool same = relativeMseOfOthers(picture, reference) <= 1e-8;
            const bool refused = !picture.statistics.ok && !picture.statistics.message.empty();
            // An area light consists of floats, and so do the vertices of Storage::Float: beyond
            // 1e38 they are not what the test wrote.
            const bool storable = storage == Storage::Local || (scale > 1e-38 && scale < 1e38);
            CHECK((same || refused || (!storable && skippedThings(picture) > 0)));
        }
    }
}

TEST_CASE("stability 4: a light that is far from a small scene lights it evenly", "[stability]")
{
    // The sun is a point light at 1.5e11 from a scene of 1e-12: it must look like a light of the
    // same direction without a place.
    Placement small;
    small.scale = 1e-12;
    const auto litBy = [&](const osg::Vec4& position)
    {
        const osg::ref_ptr<osg::Group> scene = classicScene(small);
        const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
        source->getLight()->setLightNum(4);
        source->getLight()->setPosition(position);
        source->getLight()->setDiffuse(osg::Vec4(0.5f, 0.5f, 0.5f, 1.0f));
        scene->addChild(source);
        scene->getOrCreateStateSet()->setMode(GL_LIGHT4, osg::StateAttribute::ON);
        return pictureOf(*scene, small, kWhitted);
    };
    const Picture directional = litBy(osg::Vec4(-0.5f, -0.25f, 1.0f, 0.0f));
    const Picture point = litBy(osg::Vec4(-0.75e11f, -0.375e11f, 1.5e11f, 1.0f));
    const Picture without = pictureOf(*classicScene(small), small, kWhitted);
    CHECK(point.statistics.droppedSamples == 0);
    CHECK(relativeMse(point, directional) <= 1e-8);
    CHECK(relativeMse(without, directional) > 1e-2);
}
