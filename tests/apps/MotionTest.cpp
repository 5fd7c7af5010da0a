// MotionTest.cpp - cameras that move, shutters and videos. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/FlyingBall.h"
#include "tests/apps/Program.h"

#include <cstdlib>

using Catch::Matchers::Contains;
using Names = std::vector<std::string>;

namespace
{

/// Writes a ball at x = -3 over a box around the origin; it flies to x = 3 within the second
/// second.
void writeBall(const TemporaryFolder& folder)
{
    writeBall(folder, {{0.0, -3.0}, {1.0, -3.0}, {2.0, 3.0}}, 12.0f);
}

/// Writes a path as osgviewer does: from x = -2 to 2 within 0.2 seconds, looking along +y.
void writePath(const std::string& file)
{
    const osg::ref_ptr<osg::AnimationPath> path = new osg::AnimationPath;
    const osg::Quat ahead(osg::PI_2, osg::Vec3d(1.0, 0.0, 0.0));
    path->insert(5.0, {osg::Vec3d(-2.0, -20.0, 0.0), ahead});
    path->insert(5.2, {osg::Vec3d(2.0, -20.0, 0.0), ahead});
    std::ofstream stream(file);
    path->write(stream);
}

} // namespace

TEST_CASE("osgraytrace --camera-path: the camera goes where it was recorded", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    writePath(folder / "way.path");
    REQUIRE(
        osgraytrace(folder, kQuickBall + "--camera-path way.path --fps 10 -o p%d.png").exitCode ==
        0);
    CHECK(folder.fileNames() == Names{"ball.osgt", "p0.png", "p1.png", "p2.png", "way.path"});
    REQUIRE(osgraytrace(folder, kQuickBall + "--eye 0 -20 0 --center 0 0 0 --up 0 0 1 -o still.png")
                .exitCode == 0);
    const double first = ballIn(folder / "p0.png").column, last = ballIn(folder / "p2.png").column;
    CHECK(first - last > 5.0);
    CHECK(ballIn(folder / "p1.png").column == Approx((first + last) / 2.0).margin(1.0));
    CHECK((contents(folder / "p1.png") == contents(folder / "still.png")));

    // Afterwards the path begins anew, as in osgviewer.
    REQUIRE(osgraytrace(folder, kQuickBall + "--camera-path way.path --at 0.3 -o x.png").exitCode ==
            0);
    CHECK((contents(folder / "x.png") == contents(folder / "p1.png")));

    std::ofstream(folder / "bad.path") << "0 0 0 0 0 0 0 1\n\n1 0 0 zero 0 0 0 1\n";
    const Outcome bad = osgraytrace(folder, kQuickBall + "--camera-path bad.path -o b.png");
    CHECK(bad.exitCode == 2);
    CHECK_THAT(bad.errors, Contains("cannot read bad.path: line 3 is not a time"));
    CHECK(osgraytrace(folder, kQuickBall + "--camera-path none.path -o b.png").exitCode == 2);
}

TEST_CASE("osgraytrace --parallel: a plan, and a view that is kept in a file", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    const std::string from = "--eye 0 -50 0 --center 0 0 0 --up 0 0 1 ";
    REQUIRE(osgraytrace(folder, kQuickBall + from + "--parallel 4 -o plan.png").exitCode == 0);
    // The picture is 16 wide in the model's units: the ball's middle is 5 from the left.
    CHECK(ballIn(folder / "plan.png").column == Approx(64.0 * 5.0 / 16.0 - 0.5).margin(0.51));
    CHECK(ballIn(folder / "plan.png").columns == 8);
    std::ofstream(folder / "kept.view") << from << "\n--parallel 4\n";
    REQUIRE(osgraytrace(folder, kQuickBall + "--camera kept.view -o kept.png").exitCode == 0);
    CHECK((contents(folder / "kept.png") == contents(folder / "plan.png")));
    CHECK(osgraytrace(folder, kQuickBall + "--parallel 4 --fovy 30 -o x.png").exitCode == 1);
    CHECK(osgraytrace(folder, kQuickBall + "--camera other -o x.png").exitCode == 1);
}

TEST_CASE("osgraytrace --turntable: the camera goes around the centre", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    REQUIRE(osgraytrace(folder, kQuickBall + "--turntable 8 -o t%d.png").exitCode == 0);
    CHECK(folder.fileNames().size() == 9);
    const SeenBall before = ballIn(folder / "t0.png"), behind = ballIn(folder / "t4.png");
    CHECK(before.column + behind.column == Approx(63.0).margin(1.0));
    CHECK(ballIn(folder / "t2.png").column == Approx(31.5).margin(1.0));
    CHECK(ballIn(folder / "t1.png").column < 31.0); // seen from the right, it is nearer
    REQUIRE(osgraytrace(folder, kQuickBall + "--turntable -8 --at 0.04 -o back.png").exitCode == 0);
    REQUIRE(osgraytrace(folder, kQuickBall + "--turntable 8 --frames 7 -o on%d.png").exitCode == 0);
    CHECK((contents(folder / "t7.png") == contents(folder / "on7.png")));
    CHECK(ballIn(folder / "back.png").column == Approx(ballIn(folder / "t7.png").column));
    REQUIRE(osgraytrace(folder, kQuickBall + "-o still.png").exitCode == 0);
    CHECK((contents(folder / "t0.png") == contents(folder / "still.png")));
}

TEST_CASE("osgraytrace --shutter: what moves is blurred, in parts of pictures as well", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    const std::string picture = "ball.osgt --size 64 16 ";
    REQUIRE(osgraytrace(folder, picture + "--passes 8 --at 1 --shutter 1 -o blur.png").exitCode ==
            0);
    REQUIRE(osgraytrace(folder, picture + "--passes 8 --shutter 1 -o rests.png").exitCode == 0);
    REQUIRE(osgraytrace(folder, picture + "--passes 8 -o sharp.png").exitCode == 0);
    const SeenBall sharp = ballIn(folder / "sharp.png"), blur = ballIn(folder / "blur.png");
    CHECK((contents(folder / "rests.png") == contents(folder / "sharp.png")));
    CHECK(blur.columns > 2 * sharp.columns);
    CHECK(blur.column == Approx(31.5).margin(2.0));

    const std::string open = picture + "--at 1 --shutter 1 --checkpoint ";
    REQUIRE(osgraytrace(folder, open + "a.exr --passes 0:3").exitCode == 0);
    REQUIRE(osgraytrace(folder, open + "b.exr --passes 3:8 --threads 1").exitCode == 0);
    REQUIRE(osgraytrace(folder, "--merge a.exr b.exr -o merged.png").exitCode == 0);
    CHECK((contents(folder / "merged.png") == contents(folder / "blur.png")));
    const Outcome longer =
        osgraytrace(folder, picture + "--at 1 --shutter 0.5 --checkpoint a.exr --passes 8");
    CHECK(longer.exitCode == 3);
    CHECK_THAT(longer.errors, Contains("shutter "));
}

TEST_CASE("osgraytrace: videos are made by ffmpeg, where it is", "[apps]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    const std::string video = kQuickBall + "--frames 0:3 -o film.mp4 ";
    const Outcome without =
        osgraytrace(folder, video, "timeout() { shift; PATH=/nowhere \"$@\"; };");
    CHECK(without.exitCode == 4);
    CHECK_THAT(without.errors, Contains("videos need ffmpeg, which is not installed"));
    if (std::system("command -v ffmpeg >/dev/null") != 0)
    {
        WARN("left out: there is no ffmpeg");
        return;
    }
    REQUIRE(osgraytrace(folder, video + "-o f%d.png").exitCode == 0);
    CHECK(folder.fileNames() ==
          Names{"ball.osgt", "f0.png", "f1.png", "f2.png", "f3.png", "film.mp4"});
    CHECK(contents(folder / "film.mp4").substr(4, 4) == "ftyp");
    const Outcome thin = osgraytrace(folder, "ball.osgt --size 1 1 --frames 0:1 -o thin.webm");
    CHECK(thin.exitCode == 4);
    CHECK_THAT(thin.errors, Contains("cannot write thin.webm"));
    CHECK_FALSE(std::filesystem::exists(folder / "thin.webm"));
}

TEST_CASE("osgraytrace: wrong usage of motion is named", "[apps][long]")
{
    const TemporaryFolder folder;
    writeBall(folder);
    writePath(folder / "way.path");
    const std::pair<const char*, const char*> wrong[] = {
        {"-o x.mp4", "a video needs --frames, --turntable or --camera-path"},
        {"--frames 0:2 -o x.mp4 -o y.webm", "one -o FILE is a video at most"},
        {"--frames 0:2 --skip-existing -o x.mp4", "--skip-existing excludes videos"},
        {"--turntable 0 -o x.png", "a turn has at least one frame"},
        {"--turntable 8 --camera-path way.path -o x.png", "--camera-path excludes --turntable"},
        {"--camera-path way.path --eye 0 0 0 -o x.png", "excludes"},
        {"--shutter -1 -o x.png", "--shutter"},
        {"--shutter 1 --context egl -o x.png", "--shutter excludes --context"},
        {"--aperture -1 -o x.png", "--aperture"},
    };
    for (const auto& [arguments, message] : wrong)
    {
        CAPTURE(arguments);
        const Outcome outcome = osgraytrace(folder, kQuickBall + arguments);
        CHECK(outcome.exitCode == 1);
        CHECK_THAT(outcome.errors, Contains(message));
    }
    CHECK(folder.fileNames() == Names{"ball.osgt", "way.path"});
}
