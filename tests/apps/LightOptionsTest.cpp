// LightOptionsTest.cpp - a sky, a sun and the headlight, as options of osgraytrace.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"

#include "osgPlugins/exr/ExrImage.h"

#include <osg/Geode>
#include <osg/Geometry>
#include <osg/Material>
#include <osgDB/WriteFile>

using Catch::Matchers::Contains;
using namespace osgRayTrace;

namespace
{

/// Writes a white square through the origin. Its normal is up: +z.
void writeSquare(const std::string& file, const osg::Vec3& u = osg::Vec3(18.0f, 0.0f, 0.0f),
                 const osg::Vec3& v = osg::Vec3(0.0f, 18.0f, 0.0f))
{
    osg::ref_ptr<osg::Geode> square = new osg::Geode;
    osg::ref_ptr<osg::Geometry> geometry = osg::createTexturedQuadGeometry((u + v) * -0.5f, u, v);
    square->addDrawable(geometry.get());
    osg::ref_ptr<osg::Material> white = new osg::Material;
    white->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    white->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    square->getOrCreateStateSet()->setAttribute(white.get());
    REQUIRE(osgDB::writeNodeFile(*square, file));
}

/// Writes a sky of radiance 2 towards +y, and 1 towards -y.
void writeSky(const std::string& file)
{
    engine::ExrImage sky;
    sky.width = 8;
    sky.height = 4;
    for (const char* name : {"R", "G", "B"})
    {
        engine::ExrChannel channel{name, false, std::vector<float>(32)};
        for (std::size_t i = 0; i < 32; ++i)
            channel.values[i] = i % 8 >= 2 && i % 8 < 6 ? 2.0f : 1.0f;
        sky.channels.push_back(channel);
    }
    REQUIRE(engine::writeExr(file, sky).empty());
}

const std::string kFromAbove = " --eye 0 0 9 --center 0 0 0 --up 0 1 0";

/// Returns the mean red radiance of the picture in linear colours.
double radiance(const TemporaryFolder& folder, const std::string& options,
                const std::string& view = kFromAbove)
{
    const Outcome outcome = osgraytrace(
        folder, "square.osgt -o out.exr --size 16 16 --color-rule linear " + options + view);
    INFO(outcome.errors);
    REQUIRE(outcome.exitCode == 0);
    engine::ExrImage image;
    REQUIRE(engine::readExr(folder / "out.exr", image).empty());
    for (const engine::ExrChannel& channel : image.channels)
    {
        if (channel.name != "R") continue;
        double sum = 0.0;
        for (const float value : channel.values)
            sum += value;
        return sum / double(channel.values.size());
    }
    return -1.0;
}

} // namespace

TEST_CASE("light options: the sun lights by the sine of its elevation", "[apps]")
{
    const TemporaryFolder folder;
    writeSquare(folder / "square.osgt");
    const double above = radiance(folder, "--passes 1 --sun 77 90");
    CHECK(above > 0.1);
    CHECK(radiance(folder, "--passes 1 --sun 77 30") == Approx(0.5 * above).epsilon(1e-4));
    CHECK(radiance(folder, "--passes 1 --sun 200 -30") == 0.0);
    // With a context, too.
    const std::string east = "--passes 1 --sun 90 30 --context osmesa",
                      none = "--passes 1 --sun 90 30";
    CHECK(radiance(folder, east) == Approx(radiance(folder, none)).epsilon(1e-4));
}

TEST_CASE("light options: a square shines as the sky above it does", "[apps][statistics]")
{
    const TemporaryFolder folder;
    writeSquare(folder / "square.osgt");
    writeSky(folder / "sky.exr");
    // The halves of the sky light a horizontal square alike: (2 + 1) / 2, and the square is white.
    // One pass has 256 pixels, whose deviation is below 1: 16 passes leave 0.016, 4 sigma.
    const std::string path = "--integrator path --passes 16 --environment sky.exr ";
    CHECK(radiance(folder, path) == Approx(1.5).margin(0.063));
    CHECK(radiance(folder, path + "--environment-strength 0.1") == Approx(0.15).margin(0.0063));
}

TEST_CASE("light options: the sky turns anticlockwise, the sun's azimuth is a compass's", "[apps]")
{
    const TemporaryFolder folder;
    writeSquare(folder / "square.osgt");
    writeSky(folder / "sky.exr");
    const auto seen = [&](const std::string& turn, const std::string& towards)
    {
        return radiance(folder, "--passes 1 --environment sky.exr --environment-turn " + turn,
                        " --eye 0 0 1 --up 0 0 1 --fovy 1 --center " + towards);
    };
    CHECK(seen("0", "0 1 2") == Approx(2.0));
    CHECK(seen("0", "0 -1 2") == Approx(1.0));
    CHECK(seen("60", "-1 0.577 2") == Approx(2.0)); // +y turned by 60 degrees
    CHECK(seen("180", "0 -1 2") == Approx(2.0));

    writeSquare(folder / "square.osgt", osg::Vec3(0.0f, 18.0f, 0.0f), osg::Vec3(0.0f, 0.0f, 18.0f));
    const std::string fromEast = " --eye 9 0 0 --center 0 0 0 --up 0 0 1";
    CHECK(radiance(folder, "--passes 1 --sun 90 10", fromEast) > 0.1);
    CHECK(radiance(folder, "--passes 1 --sun 270 10", fromEast) == 0.0);
}

TEST_CASE("light options: added lights replace the headlight unless it is asked for", "[apps]")
{
    const TemporaryFolder folder;
    writeSquare(folder / "square.osgt");
    const double head = radiance(folder, "--passes 1");
    const double sun = radiance(folder, "--passes 1 --sun 0 30");
    CHECK(head > 0.1);
    CHECK(radiance(folder, "--passes 1 --headlight off") == 0.0);
    CHECK(radiance(folder, "--passes 1 --headlight on") == head);
    CHECK(radiance(folder, "--passes 1 --sun 0 30 --headlight off") == sun);
    CHECK(sun < head);
    writeSky(folder / "sky.exr");
    const std::string sky = "--passes 16 --integrator path --environment sky.exr";
    CHECK(radiance(folder, sky) < radiance(folder, sky + " --headlight on") - 0.1);
}

TEST_CASE("light options: skies that cannot be read are refused", "[apps]")
{
    const TemporaryFolder folder;
    writeSquare(folder / "square.osgt");
    const Outcome outcome =
        osgraytrace(folder, "square.osgt -o out.exr --size 8 8 --environment missing.hdr");
    CHECK(outcome.exitCode == 2);
    CHECK_THAT(outcome.errors, Contains("missing.hdr"));
    CHECK(osgraytrace(folder, "square.osgt -o out.exr --environment-turn 3").exitCode == 1);
    CHECK(osgraytrace(folder, "square.osgt -o out.exr --sun 0 91").exitCode == 1);
    CHECK(osgraytrace(folder, "square.osgt -o out.exr --headlight maybe").exitCode == 1);
}

TEST_CASE("light options: a variable's light shines once, whoever reads it", "[apps]")
{
    const TemporaryFolder folder;
    writeSquare(folder / "square.osgt");
    const std::string sun = "env OSGRAYTRACE_SUN=77:30 ";
    const std::string options = " --passes 1 --size 16 16 --color-rule linear" + kFromAbove;
    REQUIRE(osgraytrace(folder, "square.osgt -o a.png" + options, sun).exitCode == 0);
    REQUIRE(osgraytrace(folder, "square.osgt.raytrace -o b.png" + options, sun).exitCode == 0);
    REQUIRE(osgraytrace(folder, "square.osgt -o c.png" + options + " --sun 77 30").exitCode == 0);
    CHECK((contents(folder / "a.png") == contents(folder / "b.png")));
    CHECK((contents(folder / "a.png") == contents(folder / "c.png")));
}
