// BackdropTest.cpp - a ground that shows shadows, and what stands behind pictures.
// SPDX-License-Identifier: MIT
#include "apps/common/Backdrop.h"
#include "apps/common/Failure.h"
#include "osgPlugins/exr/ExrImage.h"
#include "tests/Catch.h"
#include "tests/apps/Program.h"

#include <osg/Geode>
#include <osg/Geometry>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

using namespace osgRayTrace;
using namespace osgRayTrace::app;
using Catch::Matchers::Contains;

namespace
{

/// Writes a square of side 2 at z = 1. Its shadow on z = 0 is beside it if the sun is in the east,
/// 45 degrees high: from x = -2 to -1 as seen from above, and below it from -1 to 0.
void writeSquare(const std::string& file)
{
    osg::ref_ptr<osg::Geode> square = new osg::Geode;
    square->addDrawable(osg::createTexturedQuadGeometry({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}));
    REQUIRE(osgDB::writeNodeFile(*square, file));
}

const std::string kView = " --size 60 60 --passes 4 --eye 0 0 9 --center 0 0 0 --up 0 1 0 "
                          "--parallel 6 ";
const std::string kEast = " --sun 90 45 ";

/// Returns the column of a place along x.
int columnOf(double x)
{
    return static_cast<int>((x + 3.0) * 10.0);
}

osg::ref_ptr<osg::Image> rendered(const TemporaryFolder& folder, const std::string& arguments,
                                  const std::string& file, const std::string& prefix = "")
{
    const Outcome outcome = osgraytrace(folder, arguments + kView + "-o " + file, prefix);
    INFO(outcome.errors);
    REQUIRE(outcome.exitCode == 0);
    osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(folder / file);
    REQUIRE(image);
    return image;
}

} // namespace

TEST_CASE("backdrop: the ground's shadow is alpha in EXR and in transparent PNG", "[apps]")
{
    const TemporaryFolder folder;
    writeSquare(folder / "s.osgt");
    const std::string plain = "s.osgt --ground 0" + kEast;
    for (const std::string& file : {"out.exr", "out.png"})
    {
        const auto image = rendered(folder, plain + "--background transparent ", file);
        CAPTURE(file);
        CHECK(image->getColor(columnOf(-1.5), 30) == osg::Vec4(0, 0, 0, 1));
        CHECK(image->getColor(columnOf(-2.5), 30) == osg::Vec4(0, 0, 0, 0));
        CHECK(image->getColor(columnOf(1.5), 30) == osg::Vec4(0, 0, 0, 0));
        CHECK(image->getColor(columnOf(0.0), 30).a() == 1.0f);
        CHECK(image->getColor(columnOf(0.0), 30).r() > 0.1f);
    }
    CHECK(rendered(folder, "s.osgt" + kEast + "--background transparent ", "no.png")
              ->getColor(columnOf(-1.5), 30)
              .a() == 0.0f);
    // The pseudo-loader, the environment, and a ground that finds the model.
    for (const auto& [arguments, prefix] :
         {std::pair<std::string, std::string>("'s.osgt.(ground=0,sun=90:45).raytrace' ", ""),
          {"s.osgt ", "OSGRAYTRACE_GROUND=0 OSGRAYTRACE_SUN=90:45"}})
    {
        const auto image = rendered(folder, arguments, "out.exr", prefix);
        CHECK(image->getColor(columnOf(-1.5), 30).a() == 1.0f);
        CHECK(image->getColor(columnOf(-2.5), 30).a() == 0.0f);
    }
    const auto touching = rendered(folder, "s.osgt --ground auto" + kEast, "out.exr");
    CHECK(touching->getColor(columnOf(-1.5), 30).a() == 0.0f);
    const Outcome headlight = osgraytrace(folder, "s.osgt --ground auto -o x.png" + kView);
    CHECK(headlight.exitCode == 0);
    CHECK_THAT(headlight.errors, Contains("the ground shows nothing"));
    CHECK(osgraytrace(folder, "s.osgt --ground low -o x.png").exitCode == 1);
}

TEST_CASE("backdrop: gradients and images stand behind models and their shadows", "[apps]")
{
    const TemporaryFolder folder;
    writeSquare(folder / "s.osgt");
    const std::string plain = "s.osgt --ground 0" + kEast;
    const auto gradient = rendered(folder, plain + "--background ff0000:#0000ff ", "out.png");
    const auto isNear = [](osg::Vec4 a, osg::Vec4 b)
    { return (osg::Vec3(a.r(), a.g(), a.b()) - osg::Vec3(b.r(), b.g(), b.b())).length() < 0.02; };
    CHECK(isNear(gradient->getColor(3, 59), osg::Vec4(1, 0, 0, 1)));
    CHECK(isNear(gradient->getColor(3, 0), osg::Vec4(0, 0, 1, 1)));
    CHECK(isNear(gradient->getColor(3, 30), osg::Vec4(0.5f, 0, 0.5f, 1)));
    CHECK(isNear(gradient->getColor(columnOf(-1.5), 30), osg::Vec4(0, 0, 0, 1)));

    // A crop has its part of the gradient.
    const Outcome cropped = osgraytrace(
        folder, plain + "--background ff0000:0000ff --crop 0 50 9 10" + kView + "-o crop.png");
    INFO(cropped.errors);
    REQUIRE(cropped.exitCode == 0);
    const auto crop = osgDB::readRefImageFile(folder / "crop.png");
    REQUIRE(crop);
    CHECK(isNear(crop->getColor(3, 0), gradient->getColor(3, 0)));
    CHECK(isNear(crop->getColor(3, 9), gradient->getColor(3, 9)));

    // An image twice as wide as the picture loses its left and its right quarter.
    osg::ref_ptr<osg::Image> wide = new osg::Image;
    wide->allocateImage(40, 20, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 40; ++x)
            wide->setColor(x < 10 || x >= 30 ? osg::Vec4(1, 0, 0, 1) : osg::Vec4(0, 1, 0, 1), x, y);
    REQUIRE(osgDB::writeImageFile(*wide, folder / "wide.png"));
    const auto shown = rendered(folder, plain + "--background wide.png ", "out.png");
    CHECK(isNear(shown->getColor(2, 30), osg::Vec4(0, 1, 0, 1)));
    CHECK(isNear(shown->getColor(57, 30), osg::Vec4(0, 1, 0, 1)));
    CHECK(isNear(shown->getColor(columnOf(-1.5), 30), osg::Vec4(0, 0, 0, 1)));
}

TEST_CASE("backdrop: what it cannot be is refused", "[apps]")
{
    CHECK_FALSE(readBackdrop("").wanted);
    CHECK(readBackdrop("white:#102030").bottom == osg::Vec4(16, 32, 48, 255) / 255.0f);
    CHECK_THROWS_AS(readBackdrop("#12345"), Failure);
    CHECK_THROWS_AS(readBackdrop("purple"), Failure);
    CHECK_THROWS_AS(readBackdrop("/"), Failure);
}
