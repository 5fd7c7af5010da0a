// CaveTest.cpp - CalVR's configurations: what is read from them. Layer: tests.
// SPDX-License-Identifier: MIT
#include "apps/cave/CaveView.h"
#include "apps/cave/HeadPath.h"
#include "apps/common/Failure.h"
#include "tests/Catch.h"
#include "tests/CommaLocale.h"
#include "tests/plugins/TemporaryFolder.h"

#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

using namespace osgRayTrace::app;

namespace
{

std::string written(const TemporaryFolder& folder, const std::string& name, const std::string& text)
{
    const std::string file = folder / name;
    std::ofstream(file) << text;
    return file;
}

/// Returns the error that reading the text throws, or an empty string if it throws none.
std::string errorOf(const std::string& text)
{
    const TemporaryFolder folder;
    try
    {
        caveSetup(CaveFile(written(folder, "c.xml", text), "me"));
    }
    catch (const Failure& failure)
    {
        CHECK(failure.code() == kCannotLoad);
        return failure.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

const char* const kOne = "<WindowConfig><Window name=\"0\"/></WindowConfig>\n"
                         "<ChannelConfig><Channel name=\"0\"/></ChannelConfig>\n"
                         "<ScreenConfig><Screen name=\"0\"/></ScreenConfig>\n";

CaveSetup setupOf(const std::string& text, const std::string& host = "me")
{
    const TemporaryFolder folder;
    return caveSetup(CaveFile(written(folder, "c.xml", text), host));
}

} // namespace

TEST_CASE("a configuration without values has CalVR's defaults")
{
    const CaveSetup setup = setupOf(kOne);
    REQUIRE(setup.windows.size() == 1);
    REQUIRE(setup.walls.size() == 1);
    CHECK(setup.windows[0].width == 600);
    CHECK(setup.windows[0].height == 400);
    CHECK(setup.walls[0].width == 600);
    CHECK(setup.walls[0].screenHeight == 400.0);
    CHECK(setup.walls[0].stereo == CaveStereo::None);
    CHECK(setup.separation == 64.0);
    CHECK(setup.nearPlane == 10.0);
    CHECK(setup.farPlane == 1e7);
}

TEST_CASE("what is no well-formed XML is read as CalVR reads it")
{
    const CaveSetup setup =
        setupOf("<?xml version=\"1.0\"?><!-- a < b -->\n"
                "<Near value='20'/><Near value=\"30\"/>\n"
                "<WindowConfig><Window name=\"0\"width=\"700\"left=\"5\"/></WindowConfig>\n"
                "<WindowConfig><Window name=\"0\" height=\"300\" width=\"1\"/></WindowConfig>\n" +
                std::string(kOne));
    CHECK(setup.nearPlane == 20.0); // the first element counts
    CHECK(setup.windows[0].width == 700);
    CHECK(setup.windows[0].left == 5);
    CHECK(setup.windows[0].height == 300); // from the first element that has it
}

TEST_CASE("blocks for hosts go to the end of what is around them")
{
    const std::string text =
        "<LOCAL host=\"you,me,her\"><Near value=\"1\"/><Far value=\"100\"/></LOCAL>\n"
        "<LOCAL host=\"mel\"><Far value=\"5\"/></LOCAL>\n"
        "<GLOBAL><Near value=\"2\"/><LOCAL host=\"me\"><Stereo "
        "separation=\"60\"/></LOCAL></GLOBAL>\n" +
        std::string(kOne) + "<Far value=\"50\"/>";
    CHECK(setupOf(text).nearPlane == 2.0); // GLOBAL is unwrapped first
    CHECK(setupOf(text).farPlane == 50.0); // plain elements win
    CHECK(setupOf(text).separation == 60.0);
    CHECK(setupOf(text, "m").separation == 64.0);
    CHECK(setupOf(text, "me,her").separation == 64.0);
}

TEST_CASE("included files come after the one that names them")
{
    const TemporaryFolder folder;
    written(folder, "more.xml", "<Near value=\"7\"/><Far value=\"70\"/>");
    const std::string file = written(
        folder, "c.xml", std::string(kOne) + "<INCLUDE> more.xml\n</INCLUDE><Near value=\"9\"/>");
    const CaveSetup setup = caveSetup(CaveFile(file, "me"));
    CHECK(setup.nearPlane == 9.0);
    CHECK(setup.farPlane == 70.0);
    written(folder, "more.xml", "<INCLUDE>more.xml</INCLUDE>");
    CHECK_THROWS_AS(CaveFile(file, "me"), Failure);
    CHECK_THROWS_WITH(CaveFile(file, "me"), Catch::Contains("too many files"));

    const auto chainOf = [&folder](int files)
    {
        std::string text = kOne;
        for (int i = files - 1; i >= 0; --i)
        {
            const std::string name = std::to_string(i) + ".xml";
            written(folder, name, text);
            text = "<INCLUDE>" + name + "</INCLUDE>";
        }
        return folder / "0.xml";
    };
    CHECK_NOTHROW(CaveFile(chainOf(64), "me"));
    CHECK_THROWS_WITH(CaveFile(chainOf(65), "me"), Catch::Contains("too many files"));
}

TEST_CASE("lists end at the first gap and at their cap")
{
    const std::string windows =
        "<WindowConfig><Window name=\"0\"/><Window name=\"1\"/><Window name=\"3\"/></WindowConfig>"
        "<ChannelConfig><Channel name=\"0\"/><Channel name=\"1\" "
        "windowIndex=\"1\"/></ChannelConfig>"
        "<ScreenConfig><Screen name=\"0\" channelIndex=\"1\"/><Screen name=\"1\"/></ScreenConfig>";
    CHECK(setupOf(windows).windows.size() == 2);
    CHECK(setupOf(windows).walls[0].window == 1);
    CHECK(setupOf("<NumScreens value=\"1\"/>" + windows).walls.size() == 1);
}

TEST_CASE("what is wrong is named with its line")
{
    const auto check = [](const std::string& text, const std::string& line, const std::string& what)
    {
        const std::string error = errorOf(text);
        INFO(text << "\ngives: " << error);
        CHECK(contains(error, line));
        CHECK(contains(error, what));
    };
    const std::string one = kOne;
    check(one + "<Near value=\"ten\"/>", ":4:", "<Near>: value=\"ten\" is no number");
    check(one + "<Near value=\"1e999\"/>", ":4:", "is no number");
    check(one + "\n<Near value=\"1\"", ":5:", "<Near has no >");
    check(one + "<A>\n<B>\n</A>", ":6:", "</A> ends <B> of line 5");
    check(one + "<A>\n", ":4:", "<A> has no end");
    check(one + "</A>", ":4:", "</A> has no beginning");
    check(one + "<Near value=\"1>\n<Far/>", ":4:", "the value of value has no end");
    check(one + "<Near value=1/>", ":4:", "value is not quoted");
    check(one + "<Near value/>", ":4:", "value has no value");
    check(one + "<!-- ", ":4:", "comment has no end");
    check(one + "<>", ":4:", "without a name");
    check(one + "<INCLUDE>none.xml</INCLUDE>", ":4:", "there is no file none.xml");
    check("<ChannelConfig><Channel name=\"0\" stereoMode=\"LENTICULAR\"/></ChannelConfig>" + one,
          ":1:", "stereoMode=\"LENTICULAR\" is not supported");
    check("<ChannelConfig><Channel name=\"0\" width=\"0\"/></ChannelConfig>" + one,
          ":1:", "<Channel>: width=\"0\" is not from 1 to");
    for (const std::string side : {"width", "height"})
    {
        const std::string large = "name=\"0\" " + side + "=\"32769\"/>";
        const std::string refusal = side + "=\"32769\" is not from 1 to 32768";
        check("<WindowConfig><Window " + large + "</WindowConfig>" + one, ":1:", refusal);
        check("<ChannelConfig><Channel " + large + "</ChannelConfig>" + one, ":1:", refusal);
    }
    check("<ChannelConfig><Channel name=\"0\" windowIndex=\"4\"/></ChannelConfig>" + one, "c.xml",
          "channel 0 is in window 4, which does not exist");
    check("<Near value=\"5\"/><Far value=\"5\"/>" + one, "c.xml", "no depth range");
    check("", "c.xml", "there is no WindowConfig.Window");
    check("<ScreenConfig><Screen name=\"0\" width=\"-1\"/></ScreenConfig>" + one, "c.xml",
          "screen 0 has no area");
    std::string deep;
    for (int i = 0; i < 100000; ++i)
        deep += "<A>";
    check(deep, ":1:", "too deep");
    CHECK_THROWS_AS(CaveFile("/nowhere/c.xml", "me"), Failure);
}

TEST_CASE("what has no end, or no measure, is refused")
{
    const TemporaryFolder folder;
    const auto fileError = [](const std::string& file)
    {
        try
        {
            CaveFile(file, "me");
        }
        catch (const Failure& failure)
        {
            CHECK(failure.code() == kCannotLoad);
            return std::string(failure.what());
        }
        return std::string();
    };
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK(contains(fileError("/dev/zero"), "cannot read /dev/zero: is a device"));
    CHECK(contains(fileError(folder / "pipe"), "pipe: is a pipe"));
    CHECK(contains(fileError(folder / "."), "is a directory"));
    CHECK(contains(fileError(written(folder, "c.xml", "<INCLUDE>pipe</INCLUDE>")),
                   "pipe: is a pipe"));
    CHECK_THROWS_AS(HeadPath::read("/dev/zero"), Failure);
    CHECK_THROWS_AS(HeadPath::read(folder / "pipe"), Failure);
    CHECK_THROWS_AS(HeadPath::read(folder / "."), Failure);
    std::filesystem::create_symlink(folder / "c.xml", folder / "link.xml");
    written(folder, "c.xml", kOne);
    CHECK(fileError(folder / "link.xml") == "");

    const std::string blanks(kMostCaveBytes, ' ');
    CHECK(fileError(written(folder, "full.xml", blanks)) == "");
    CHECK(contains(fileError(written(folder, "more.xml", blanks + " ")),
                   "has more than 4194304 bytes"));
    CHECK(contains(fileError(written(folder, "both.xml", "<INCLUDE>full.xml</INCLUDE>")),
                   "with the files before it there are more than 4194304 bytes"));
}

TEST_CASE("elements, windows and pixels are bounded, and all that is within costs little")
{
    std::string text = kOne;
    for (int i = 0; i < 12000; ++i) // blocks that are unwrapped one by one
        text += "<LOCAL host=\"me\"><A/></LOCAL><LOCAL/>\n";
    CHECK(errorOf(text) == "");
    for (int i = 0; i < 12000; ++i)
        text += "<A/>\n";
    CHECK(contains(errorOf(text), "there are more than 50000 elements and attributes"));

    std::string attributes = "<A";
    for (int i = 0; i < 60000; ++i)
        attributes += " a=\"\"";
    CHECK(contains(errorOf(attributes + "/>" + kOne), "more than 50000 elements and attributes"));

    std::string windows = "<NumWindows value=\"100000\"/><WindowConfig>";
    for (int i = 0; i < 257; ++i)
        windows += "<Window name=\"" + std::to_string(i) + "\"/>";
    CHECK(contains(errorOf(windows + "</WindowConfig>" + kOne),
                   "there are more than 256 of WindowConfig.Window"));

    const std::string large = "<WindowConfig><Window name=\"0\" width=\"32768\" "
                              "height=\"8192\"/></WindowConfig>";
    CHECK(errorOf(large + kOne) == "");
    CHECK(contains(errorOf("<WindowConfig><Window name=\"1\"/></WindowConfig>" + large + kOne),
                   "all windows together have 268675456 pixels, more than 268435456"));
    CHECK(contains(errorOf("<ChannelConfig><Channel name=\"0\" width=\"32768\" "
                           "height=\"32768\"/></ChannelConfig>" +
                           std::string(kOne)),
                   "all channels together have 1073741824 pixels"));
}

TEST_CASE("a configuration with any bytes damaged is read or refused")
{
    const std::string whole =
        setupOf(kOne).walls.empty() ? "" : kOne + std::string("<Near value=\"5\"/>");
    std::mt19937 random(1);
    int refused = 0;
    for (int i = 0; i < 2000; ++i)
    {
        std::string text = whole;
        for (int k = 0; k < 3; ++k)
            text[random() % text.size()] = "<>/\"= \0A9-"[random() % 10];
        refused += !errorOf(text.substr(0, random() % (text.size() + 1))).empty();
    }
    CHECK(refused > 1000);
}

TEST_CASE("our configurations are a cube around the head and a pair of eyes")
{
    const CaveSetup cube = caveSetup(CaveFile(OSGRAYTRACE_TEST_SOURCE "/data/cave_cube.xml", "me"));
    REQUIRE(cube.walls.size() == 4);
    for (const CaveWall& wall : cube.walls)
    {
        CHECK(wall.screen.position.length() == Approx(1500.0));
        // Each wall faces the middle of the cube.
        const osg::Vec3d forward =
            osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), wall.screen.matrix());
        CHECK((forward * 1500.0 - wall.screen.position).length() < 1e-9);
        CHECK(caveView(cube, wall, CaveEye::Centre, cube.head.matrix()));
    }
    const CaveSetup pair = caveSetup(CaveFile(OSGRAYTRACE_TEST_SOURCE "/data/cave_hmd.xml", "me"));
    REQUIRE(pair.walls.size() == 2);
    CHECK(pair.walls[0].eye == CaveEye::Left);
    CHECK(pair.walls[1].eye == CaveEye::Right);
    // A turn of the head turns the picture, and the frustum stays.
    const osg::Matrixd head = CavePose{{1, 2, 3}, 40.0, 20.0, -10.0}.matrix();
    for (const CaveWall& wall : pair.walls)
    {
        const auto before = caveView(pair, wall, wall.eye, pair.head.matrix());
        const auto after = caveView(pair, wall, wall.eye, head);
        REQUIRE(before);
        REQUIRE(after);
        for (int i = 0; i < 16; ++i)
            CHECK(after->projection.ptr()[i] == Approx(before->projection.ptr()[i]).margin(1e-9));
        const osg::Vec3d ahead = osg::Vec3d(0, 5000, 0) * head;
        CHECK((after->view.preMult(ahead) -
               osg::Vec3d(wall.eye == CaveEye::Left ? 32 : -32, 0, -5000))
                  .length() < 1e-6);
    }
}

TEST_CASE("numbers have a point in any locale")
{
    const CommaLocale commas;
    const TemporaryFolder folder;
    const HeadPath path =
        HeadPath::read(written(folder, "p", "0.5 1.25 +2.5 -3e2 0 0 0\n1.5 1 2 3 0 0 0\n"));
    CHECK(path.end() == 1.5);
    CHECK((path.at(0.0).position - osg::Vec3d(1.25, 2.5, -300.0)).length() == 0.0);
    CHECK(setupOf("<Near value=\" 12.5 \"/>" + std::string(kOne)).nearPlane == 12.5);
    CHECK(errorOf("<Near value=\"12,5\"/>" + std::string(kOne)) != "");
}

TEST_CASE("a head path is read, mixed linearly, and refused by line")
{
    const TemporaryFolder folder;
    const HeadPath path = HeadPath::read(written(
        folder, "p", "# seconds x y z h p r\n0 0 0 0 0 0 0\n\n2 10 20 30 90 0 -4 # there\n"));
    CHECK(path.end() == 2.0);
    CHECK((path.at(1.0).position - osg::Vec3d(5, 10, 15)).length() < 1e-12);
    CHECK(path.at(0.5).h == Approx(22.5));
    CHECK(path.at(-1.0).position.length() == 0.0);
    CHECK(path.at(9.0).r == -4.0);
    for (const char* bad : {"0 1 2 3 4 5\n", "0 0 0 0 0 0 0 0\n", "\n\n", "0 a 0 0 0 0 0\n",
                            "word\n", "1 0 0 0 0 0 0\n1 0 0 0 0 0 0\n"})
        CHECK_THROWS_AS(HeadPath::read(written(folder, "q", bad)), Failure);
    CHECK_THROWS_AS(HeadPath::read(folder / "none"), Failure);
}
