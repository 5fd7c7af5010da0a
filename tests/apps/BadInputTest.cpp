// BadInputTest.cpp - osgraytrace refuses what it cannot do with one clear line, the right exit
// code, and no file.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/apps/Program.h"

#include <osg/Geometry>
#include <osg/Group>
#include <osgDB/WriteFile>

#include <sys/stat.h>
#include <unistd.h>

#include <limits>

using Catch::Matchers::Contains;

namespace
{

const std::string kBox = dataFile("cornell_box.osgt");
const std::string kQuick = " --size 8 8 --passes 1";

void write(const std::string& file, const std::string& text)
{
    std::ofstream(file, std::ios::binary) << text;
}

/// Checks that the program prints one line, which begins with its name, and leaves no file in the
/// folder.
void refuses(int exitCode, const std::string& arguments, const std::string& message)
{
    CAPTURE(arguments);
    const TemporaryFolder folder;
    const Outcome outcome = osgraytrace(folder, arguments);
    CHECK(outcome.exitCode == exitCode);
    CHECK_THAT(outcome.errors, Contains(message));
    CHECK(outcome.errors.find("osgraytrace: ") == 0);
    CHECK(std::count(outcome.errors.begin(), outcome.errors.end(), '\n') == 1);
    CHECK(outcome.output.empty());
    CHECK(folder.fileNames().empty());
}

osg::ref_ptr<osg::Geometry> triangle(float x)
{
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    vertices->push_back(osg::Vec3(x, 0.0f, 0.0f));
    vertices->push_back(osg::Vec3(1.0f, 0.0f, 0.0f));
    vertices->push_back(osg::Vec3(0.0f, 0.0f, 1.0f));
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices.get());
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    return geometry;
}

} // namespace

TEST_CASE("osgraytrace: wrong usage ends with 1", "[apps][long]")
{
    refuses(1, "", "no MODEL");
    refuses(1, kBox, "no -o FILE");
    refuses(1, kBox + " -o", "--output");
    refuses(1, kBox + " -o x.tiff", "ends in none of .exr, .png, .jpg");
    refuses(1, kBox + " -o x", "ends in none of .exr, .png, .jpg");
    refuses(1, kBox + " -o x.png --unknown", "--unknown");
    refuses(1, kBox + " -o x.png --size 8", "--size");
    refuses(1, kBox + " -o x.png --size 0 8", "--size");
    refuses(1, kBox + " -o x.png --size -8 8", "--size");
    refuses(1, kBox + " -o x.png --size 100000 100000", "2^28");
    refuses(1, kBox + " -o x.png --size 8.5 8", "--size");
    refuses(1, kBox + " -o x.png --integrator fast",
            "auto, whitted, path, ppm, sppm, photon-caustics, debug");
    refuses(1, kBox + " -o x.png --light-sampling grid",
            "random, uniform-jitter, stratified, sobol");
    refuses(1, kBox + " -o x.png --light-samples 0", "1 .. 4096");
    refuses(1, kBox + " -o x.png --passes 0", "'0'");
    refuses(1, kBox + " -o x.png --passes many", "'many'");
    refuses(1, kBox + " -o x.png --seed -1", "'-1'");
    refuses(1, kBox + " -o x.png --threads 1.5", "'1.5'");
    refuses(1, kBox + " -o x.png --time 0", "--time");
    refuses(1, kBox + " -o x.png --error -1", "--error");
    refuses(1, kBox + " -o x.png --error nan", "--error");
    refuses(1, kBox + " -o x.png --eye 1 2", "--eye");
    refuses(1, kBox + " -o x.png --eye 1 2 inf", "--eye");
    refuses(1, kBox + " -o x.png --eye 1 2 3 --center 1 2 3", "same point");
    refuses(1, kBox + " -o x.png --eye 0 0 0 --center 0 0 1 --up 0 0 1", "--up");
    refuses(1, kBox + " -o x.png --fovy 180", "--fovy");
    refuses(1, kBox + " -o x.exr --aov depth,smell", "'smell'");
    refuses(1, kBox + " -o x.png --aov depth", "-o FILE.exr");
    refuses(1, kBox + " -o x.png --context glx", "none, osmesa, egl");
}

TEST_CASE("osgraytrace: what cannot be loaded ends with 2", "[apps]")
{
    refuses(2, "missing.osgt -o x.png", "cannot load missing.osgt: there is no such file");
    refuses(2, kBox + " missing.osgt -o x.png", "cannot load missing.osgt");
    refuses(2, kBox + " -o x.png --reference missing.exr", "cannot load missing.exr");
}

TEST_CASE("osgraytrace: what has no end ends with 2, and nobody waits for it", "[apps]")
{
    const TemporaryFolder pipes;
    for (const char* name : {"m.osgt", "m.json"})
        REQUIRE(mkfifo((pipes / name).c_str(), 0600) == 0);
    refuses(2, pipes / "m.osgt" + " -o x.png", "m.osgt: is a pipe");
    refuses(2, kBox + " -o x.png --materials " + pipes / "m.json", "m.json: is a pipe");
    refuses(2, kBox + " -o x.png --materials /dev/zero", "/dev/zero: is a device");
}

TEST_CASE("osgraytrace: a model that is cut short ends with 2, wherever it was cut", "[apps]")
{
    const std::string whole = contents(OSGRAYTRACE_TEST_SOURCE "/data/cornell_box.osgt");
    REQUIRE(whole.size() > 20000);
    const TemporaryFolder folder;
    // The lengths end within the header, in a name in quotes, in a number, and between blocks.
    for (const size_t length : {size_t(0), size_t(30), whole.find("Cornell") + 3, size_t(5001),
                                size_t(17000), whole.rfind('}') - 1})
    {
        CAPTURE(length);
        write(folder / "cut.osgt", whole.substr(0, length));
        const Outcome outcome = osgraytrace(folder, "cut.osgt -o x.png" + kQuick);
        CHECK(outcome.exitCode == 2);
        CHECK_THAT(outcome.errors, Contains("osgraytrace: cannot load cut.osgt: it is cut short"));
        CHECK(folder.fileNames() == std::vector<std::string>{"cut.osgt"});
    }
}

TEST_CASE("osgraytrace: a reference of another kind or size is refused before rendering", "[apps]")
{
    const TemporaryFolder folder;
    REQUIRE(osgraytrace(folder, kBox + " -o r.exr -o r.png" + kQuick).exitCode == 0);
    const Outcome noRadiance = osgraytrace(folder, kBox + " -o x.png --reference r.png" + kQuick);
    CHECK(noRadiance.exitCode == 2);
    CHECK_THAT(noRadiance.errors, Contains("no linear radiance"));
    const Outcome otherSize = osgraytrace(folder, kBox + " -o x.png --reference r.exr --size 9 8");
    CHECK(otherSize.exitCode == 1);
    CHECK_THAT(otherSize.errors, Contains("--size 8 8"));
}

TEST_CASE("osgraytrace: an empty scene ends with 3 and leaves the old picture alone", "[apps]")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Group> empty = new osg::Group;
    osgDB::writeNodeFile(*empty, folder / "empty.osgt");
    write(folder / "x.png", "old");
    const Outcome outcome = osgraytrace(folder, "empty.osgt -o x.png" + kQuick);
    CHECK(outcome.exitCode == 3);
    CHECK_THAT(outcome.errors, Contains("no triangles"));
    CHECK(contents(folder / "x.png") == "old");
    CHECK(folder.fileNames() == std::vector<std::string>{"empty.osgt", "x.png"});
}

TEST_CASE("osgraytrace: vertices that are not numbers are left out and counted", "[apps]")
{
    const TemporaryFolder folder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(triangle(nan));
    osgDB::writeNodeFile(*scene, folder / "bad.osgb");
    CHECK(osgraytrace(folder, "bad.osgb -o x.png" + kQuick).exitCode == 3);

    scene->addChild(triangle(0.0f));
    osgDB::writeNodeFile(*scene, folder / "half.osgb");
    const Outcome outcome = osgraytrace(
        folder, "half.osgb -o x.png --stats s.json --eye 0 -5 0 --center 0 0 0" + kQuick);
    CHECK(outcome.exitCode == 0);
    CHECK_THAT(contents(folder / "s.json"),
               Contains("\"triangles\": 1,") && Contains("\"droppedSamples\": 0,"));
    CHECK_THAT(contents(folder / "s.json"), Contains("\"skipped."));
}

TEST_CASE("osgraytrace: what cannot be written ends with 4", "[apps]")
{
    refuses(4, kBox + " -o missing/x.png" + kQuick, "there is no folder");
    refuses(4, kBox + " -o x.png --stats missing/s.json" + kQuick, "there is no folder");

    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "x.png");
    const Outcome outcome = osgraytrace(folder, kBox + " -o x.png" + kQuick);
    CHECK(outcome.exitCode == 4);
    CHECK_THAT(outcome.errors, Contains("it is a folder"));

    if (geteuid() == 0) return; // root may write everywhere
    std::filesystem::create_directory(folder / "closed");
    std::filesystem::permissions(folder / "closed", std::filesystem::perms::owner_read);
    CHECK(osgraytrace(folder, kBox + " -o closed/x.png" + kQuick).exitCode == 4);
}

TEST_CASE("osgraytrace: a write that fails midway leaves nothing and the old picture", "[apps]")
{
    const TemporaryFolder folder;
    write(folder / "x.exr", "old");
    write(folder / "x.png", "old");
    // No file may grow beyond 1 KiB; the signal for this is ignored.
    for (const std::string picture : {"x.exr", "x.png"})
    {
        CAPTURE(picture);
        const Outcome outcome =
            osgraytrace(folder, kBox + " --passes 1 --size 200 200 -o " + picture,
                        "trap '' XFSZ && ulimit -f 1 &&");
        CHECK(outcome.exitCode == 4);
        CHECK_THAT(outcome.errors, Contains("osgraytrace: cannot write " + picture));
        CHECK(contents(folder / picture) == "old");
    }
    CHECK(folder.fileNames() == std::vector<std::string>{"x.exr", "x.png"});
}
