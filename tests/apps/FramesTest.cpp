// FramesTest.cpp - animations as numbered files, and models at a time. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"
#include "tests/apps/RunningProgram.h"

#include <osg/AnimationPath>
#include <osg/MatrixTransform>
#include <osg/ShapeDrawable>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

using Catch::Matchers::Contains;
using Names = std::vector<std::string>;

namespace
{

const std::string kQuick = "ball.osgt --size 64 16 --passes 2 ";

/// Writes a ball that flies from x = -6 to 6 within two seconds over a box that stands.
void writeBall(const TemporaryFolder& folder)
{
    osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    path->setLoopMode(osg::AnimationPath::NO_LOOPING);
    path->insert(0.0, osg::AnimationPath::ControlPoint({-6.0, 0.0, 0.0}));
    path->insert(2.0, osg::AnimationPath::ControlPoint({6.0, 0.0, 0.0}));
    osg::ref_ptr<osg::MatrixTransform> ball = new osg::MatrixTransform;
    ball->setUpdateCallback(new osg::AnimationPathCallback(path));
    ball->addChild(new osg::ShapeDrawable(new osg::Sphere(osg::Vec3(), 1.0f)));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(ball);
    root->addChild(new osg::ShapeDrawable(new osg::Box({0.0f, 0.0f, -2.0f}, 12.0f, 1.0f, 1.0f)));
    REQUIRE(osgDB::writeNodeFile(*root, folder / "ball.osgt"));
}

/// Returns the mean column of what is brighter than the background in the upper half, where the
/// ball is.
double columnOfBall(const std::string& file)
{
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(file);
    REQUIRE(picture);
    double sum = 0.0;
    int count = 0;
    for (int y = picture->t() / 2; y < picture->t(); ++y)
        for (int x = 0; x < picture->s(); ++x)
            if (picture->getColor(static_cast<unsigned>(x), static_cast<unsigned>(y)).r() > 0.4f)
            {
                sum += x;
                ++count;
            }
    REQUIRE(count > 0);
    return sum / count;
}

} // namespace

TEST_CASE("osgraytrace --at: a model is shown at a time", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    for (const char* time : {"0", "1", "2", "7"})
        REQUIRE(osgraytrace(folder, kQuick + "--at " + time + " -o " + time + ".png").exitCode ==
                0);
    REQUIRE(osgraytrace(folder, kQuick + "-o none.png").exitCode == 0);
    CHECK((contents(folder / "none.png") == contents(folder / "0.png")));
    CHECK((contents(folder / "7.png") == contents(folder / "2.png"))); // the path has ended
    const double first = columnOfBall(folder / "0.png"), last = columnOfBall(folder / "2.png");
    CHECK(columnOfBall(folder / "1.png") == Approx((first + last) / 2.0).margin(0.5));
    CHECK(last - first > 10.0);
}

TEST_CASE("osgraytrace --frames: each frame is the picture of its time", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    const Outcome outcome = osgraytrace(
        folder, kQuick + "--frames 0:2 --fps 2 -o f.%03d.png -o f%d.exr --stats s%2d.json");
    CHECK(outcome.exitCode == 1); // %2d would leave blanks in names
    CHECK(folder.fileNames() == Names{"ball.osgt"});

    const std::string frames = "--frames 0:2 --fps 2 -o f.%03d.png -o f%d.exr --stats s%d.json";
    const Outcome done = osgraytrace(folder, kQuick + frames);
    REQUIRE(done.exitCode == 0);
    CHECK_THAT(done.output, Contains("frame 0: whitted, 2 passes") && Contains("frame 2: "));
    CHECK(folder.fileNames() == Names{"ball.osgt", "f.000.png", "f.001.png", "f.002.png", "f0.exr",
                                      "f1.exr", "f2.exr", "s0.json", "s1.json", "s2.json"});

    REQUIRE(osgraytrace(folder, kQuick + "--at 0.5 -o at.exr").exitCode == 0);
    CHECK((contents(folder / "f1.exr") == contents(folder / "at.exr")));
    CHECK((contents(folder / "f1.exr") != contents(folder / "f0.exr")));
    REQUIRE(osgraytrace(folder, kQuick + "--frames 2 --fps 2 -o alone%d.exr").exitCode == 0);
    CHECK((contents(folder / "f2.exr") == contents(folder / "alone2.exr")));
}

TEST_CASE("osgraytrace --frames: frames whose files are there are left out on request", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    std::ofstream(folder / "f0.png") << "kept";
    std::ofstream(folder / "f1.png") << "half of a frame";
    std::ofstream(folder / "s0.json") << "kept";
    const std::string frames = kQuick + "--frames 0:2 -o f%d.png --stats s%d.json ";
    const Outcome outcome = osgraytrace(folder, frames + "--skip-existing");
    REQUIRE(outcome.exitCode == 0);
    CHECK(contents(folder / "f0.png") == "kept");
    CHECK(contents(folder / "s0.json") == "kept");
    CHECK(contents(folder / "f1.png") != "half of a frame");
    CHECK_THAT(outcome.output,
               !Contains("frame 0") && Contains("frame 1: ") && Contains("frame 2"));
    REQUIRE(osgraytrace(folder, frames).exitCode == 0);
    CHECK(contents(folder / "f0.png") != "kept");
}

TEST_CASE("osgraytrace --frames: wrong usage is named", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    const std::pair<const char*, const char*> wrong[] = {
        {"--frames 0:2 -o x.png", "x.png: --frames needs one place for the number"},
        {"--frames 0:2 -o %d%d.png", "%d%d.png: --frames needs one place"},
        {"--frames 0:2 -o %s.png", "%s.png: --frames needs one place"},
        {"--frames 0:2 -o %0d.png", "%0d.png: --frames needs one place"},
        {"--frames 0:2 -o x%d.png --stats s.json", "s.json: --frames needs one place"},
        {"--frames 2:0 -o x%d.png", "2:0: is not FIRST:LAST"},
        {"--frames -1:2 -o x%d.png", "--frames"},
        {"--frames 0:99999999 -o x%d.png", "is not FIRST:LAST"},
        {"--frames 0: -o x%d.png", "0:: is not FIRST:LAST"},
        {"--frames 0:2 --report", "--frames needs an -o FILE"},
        {"--frames 0:2 --at 1 -o x%d.png", "--at"},
        {"--frames 0:2 --fps 0 -o x%d.png", "'0' is not a number above 0"},
        {"--fps 2 -o x.png", "--fps"},
        {"--skip-existing -o x.png", "--skip-existing"},
        {"--frames 0:2 --reference r.exr -o x%d.png", "--frames excludes --reference"},
        {"--at -1 -o x.png", "--at"},
    };
    for (const auto& [arguments, message] : wrong)
    {
        CAPTURE(arguments);
        const Outcome outcome = osgraytrace(folder, kQuick + arguments);
        CHECK(outcome.exitCode == 1);
        CHECK_THAT(outcome.errors, Contains(message));
    }
    const Outcome jpeg = osgraytrace(folder, "ball.osgt --size 70000 1 --frames 0:1 -o x%d.jpg");
    CHECK(jpeg.exitCode == 4);
    CHECK(folder.fileNames() == Names{"ball.osgt"});
}

TEST_CASE("osgraytrace --frames: a signal leaves whole frames only", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    RunningProgram program(folder / ".",
                           {OSGRAYTRACE_TEST_PROGRAM, "ball.osgt", "--size", "64", "16", "--frames",
                            "0:1000000", "--passes", "2000", "-o", "x%d.png"});
    REQUIRE(program.prints("frame 0: "));
    program.signal(SIGTERM); // long before the next frame is done
    CHECK(program.wait() == 143);
    CHECK(folder.fileNames() == Names{"ball.osgt", "x0.png"});
    CHECK_THAT(program.printed(), Contains("osgraytrace: SIGTERM"));
}
