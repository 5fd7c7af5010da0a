// CaveSeamTest.cpp - the pictures of a CAVE's walls compared with rays from its eye. Layer: tests.
// SPDX-License-Identifier: MIT
#include "apps/cave/CaveView.h"
#include "tests/Catch.h"
#include "tests/api/Picks.h"
#include "tests/apps/Program.h"
#include "tests/apps/RunningProgram.h"

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <cmath>
#include <string>
#include <thread>
#include <vector>

using namespace osgRayTrace;
using namespace osgRayTrace::app;
using namespace osgRayTrace::test;

namespace
{

/// Returns a colour for each direction, which changes by a sixtieth from a pixel of a wall to the
/// next.
osg::Vec4 colorOf(const osg::Vec3d& d)
{
    return osg::Vec4(float(0.5 + 0.4 * std::sin(5.0 * d.x() + d.z())),
                     float(0.5 + 0.4 * std::sin(5.0 * d.y() + 0.5)),
                     float(0.5 + 0.4 * std::sin(5.0 * d.z())), 1.0f);
}

/// Returns an unlit coloured shell around the CAVE.
osg::ref_ptr<osg::Geometry> shell()
{
    constexpr int kRows = 60, kColumns = 120;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    osg::ref_ptr<osg::Vec4Array> colors = new osg::Vec4Array;
    osg::ref_ptr<osg::DrawElementsUInt> indices = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (int i = 0; i <= kRows; ++i)
        for (int j = 0; j <= kColumns; ++j)
        {
            const double theta = osg::PI * (i + 1e-3) / (kRows + 2e-3),
                         phi = 2.0 * osg::PI * j / kColumns;
            const osg::Vec3d d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                               std::cos(theta));
            vertices->push_back(d * 4000.0);
            colors->push_back(colorOf(d));
            if (i == kRows || j == kColumns) continue;
            const unsigned int a = i * (kColumns + 1) + j, b = a + kColumns + 1;
            for (const unsigned int index : {a, b, a + 1, a + 1, b, b + 1})
                indices->push_back(index);
        }
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    geometry->setVertexArray(vertices);
    geometry->setColorArray(colors, osg::Array::BIND_PER_VERTEX);
    geometry->addPrimitiveSet(indices);
    geometry->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    return geometry;
}

/// Returns the panorama: the colour that a ray from the eye in this direction meets.
osg::Vec3d seen(osg::Node& scene, const osg::Vec3d& eye, const osg::Vec3d& towards)
{
    osg::Vec3d direction = towards - eye;
    direction.normalize();
    const Picks picks = picksByRay(scene, {eye, eye + direction * 20000.0});
    REQUIRE(picks.size() == 1);
    const Pick& pick = picks.front();
    const auto& colors =
        static_cast<const osg::Vec4Array&>(*pick.drawable->asGeometry()->getColorArray());
    osg::Vec3d color;
    for (std::size_t k = 0; k < pick.indexList.size(); ++k)
    {
        const osg::Vec4& c = colors[pick.indexList[k]];
        color += osg::Vec3d(c.r(), c.g(), c.b()) * pick.ratioList[k];
    }
    return color;
}

osg::Vec3d pixel(const osg::Image& image, int x, int y)
{
    const osg::Vec4 color = image.getColor(x, y);
    return {color.r(), color.g(), color.b()};
}

std::string configuration()
{
    std::string text = contents(OSGRAYTRACE_TEST_SOURCE "/data/cave_cube.xml");
    const std::string size = "<SceneSize value=\"4000\"/>";
    text.replace(text.find(size), size.size(), ""); // models keep their size
    for (auto at = text.find("512"); at != std::string::npos; at = text.find("512"))
        text.replace(at, 3, "96");
    return text;
}

} // namespace

TEST_CASE("four walls stitched together are one panorama, without a seam")
{
    const TemporaryFolder folder;
    const osg::ref_ptr<osg::Geometry> geometry = shell();
    REQUIRE(osgDB::writeNodeFile(*geometry, folder / "shell.osgt"));
    std::ofstream(folder / "cube.xml") << configuration();
    const Outcome outcome = osgraytrace(
        folder,
        "--cave cube.xml --head 400 -500 300 25 10 5 --max-passes 16 --output wall.png shell.osgt");
    INFO(outcome.errors);
    REQUIRE(outcome.exitCode == 0);

    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->addChild(geometry);
    const osg::Vec3d eye(400, -500, 300);
    // The walls of the cube are given by their corners: bottom left, to the right and up, as seen
    // from within.
    struct Face
    {
        osg::Vec3d corner, right, up;
    };
    const Face faces[] = {{{-1500, -1500, -1500}, {0, 3000, 0}, {0, 0, 3000}},
                          {{-1500, 1500, -1500}, {3000, 0, 0}, {0, 0, 3000}},
                          {{1500, 1500, -1500}, {0, -3000, 0}, {0, 0, 3000}},
                          {{-1500, -1500, -1500}, {3000, 0, 0}, {0, 3000, 0}}};
    osg::ref_ptr<osg::Image> images[4];
    double largest = 0.0, sum = 0.0, edges = 0.0;
    int count = 0, edgeCount = 0;
    for (int w = 0; w < 4; ++w)
    {
        images[w] = osgDB::readRefImageFile(folder / ("wall-" + std::to_string(w) + ".png"));
        REQUIRE(images[w]);
        const int n = images[w]->s();
        REQUIRE(n == 96);
        REQUIRE(images[w]->t() == 96);
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
            {
                const osg::Vec3d at = faces[w].corner + faces[w].right * ((x + 0.5) / n) +
                                      faces[w].up * ((y + 0.5) / n);
                const osg::Vec3d error = pixel(*images[w], x, y) - seen(*scene, eye, at);
                const bool edge = x == 0 || y == 0 || x == n - 1 || y == n - 1;
                largest = std::max(
                    {largest, std::fabs(error.x()), std::fabs(error.y()), std::fabs(error.z())});
                sum += error.length();
                ++count;
                if (edge) edges += error.length();
                edgeCount += edge;
            }
    }
    INFO("largest " << largest * 255 << ", mean " << sum / count * 255 << ", at edges "
                    << edges / edgeCount * 255);
    CHECK(largest < 1.5 / 255.0);
    CHECK(sum / count < 0.6 / 255.0);
    CHECK(edges / edgeCount < 0.6 / 255.0);
}

TEST_CASE(
    "processes that show a wall each have the pixels of one that shows all, photons and edges")
{
    // There are two walls side by side, with one process each, as on the nodes of a cluster; one
    // process for both walls; and one wall as wide as both.
    const TemporaryFolder folder;
    const auto wall = [](int number, int pixels, int width, int centre)
    {
        const std::string name = " name=\"" + std::to_string(number) + "\"";
        const std::string size = " width=\"" + std::to_string(pixels) + "\" height=\"48\"";
        return "<WindowConfig><Window" + name + size + "/></WindowConfig><ChannelConfig><Channel" +
               name + size + " windowIndex=\"" + std::to_string(number) +
               "\"/></ChannelConfig><ScreenConfig><Screen" + name + " width=\"" +
               std::to_string(width) + "\" height=\"3000\" originX=\"" + std::to_string(centre) +
               "\" originY=\"1500\" originZ=\"0\"/></ScreenConfig>";
    };
    const std::string rest =
        "<Near value=\"50\"/><Far value=\"100000\"/><SceneSize value=\"9000\"/>";
    std::ofstream(folder / "left.xml") << wall(0, 24, 1500, -750) << rest;
    std::ofstream(folder / "right.xml") << wall(0, 24, 1500, 750) << rest;
    std::ofstream(folder / "both.xml") << wall(0, 24, 1500, -750) << wall(1, 24, 1500, 750) << rest;
    std::ofstream(folder / "whole.xml") << wall(0, 48, 3000, 0) << rest;
    const auto pictures = [&](const std::string& name, int count)
    {
        const Outcome outcome = osgraytrace(
            folder, "--cave " + name +
                        ".xml --head 100 -200 50 0 0 0 --integrator ppm --photons 20000" +
                        " --seed 7 --photon-guiding false --max-passes 6 --output " + name +
                        ".png " + dataFile("cornell_box_glass.osgt"));
        INFO(name << ": " << outcome.errors);
        REQUIRE(outcome.exitCode == 0);
        std::vector<osg::ref_ptr<osg::Image>> images;
        for (int i = 0; i < count; ++i)
        {
            const std::string file = count > 1 || osgDB::fileExists(folder / (name + "-0.png"))
                                         ? name + "-" + std::to_string(i)
                                         : name;
            images.push_back(osgDB::readRefImageFile(folder / (file + ".png")));
            REQUIRE(images.back());
        }
        return images;
    };
    const osg::ref_ptr<osg::Image> alone[] = {pictures("left", 1)[0], pictures("right", 1)[0]};
    const auto together = pictures("both", 2);
    const auto whole = pictures("whole", 1)[0];
    constexpr int n = 24, height = 48;
    REQUIRE((whole->s() == 2 * n && whole->t() == height));
    for (std::size_t w = 0; w < 2; ++w)
    {
        REQUIRE((alone[w]->s() == n && alone[w]->t() == height));
        REQUIRE((together[w]->s() == n && together[w]->t() == height));
        int different = 0, lit = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < n; ++x)
            {
                different += alone[w]->getColor(x, y) != together[w]->getColor(x, y);
                lit += pixel(*together[w], x, y).length() > 0.2;
            }
        CAPTURE(w, lit);
        CHECK(different == 0);
        CHECK(lit > n * height / 4);
    }
    // Along the edge the walls have, on either side, the values of the wide wall, except for the
    // noise of a pixel's own samples: 4 standard errors, a false alarm in 16,000 choices of the
    // seed for each side.
    for (int w = 0; w < 2; ++w)
    {
        double sum = 0.0, squares = 0.0;
        int count = 0;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < 4; ++x)
            {
                const int column = w == 0 ? n - 1 - x : x;
                const double difference =
                    (pixel(*alone[w], column, y) - pixel(*whole, column + w * n, y)) *
                    osg::Vec3d(1.0, 1.0, 1.0) / 3.0;
                sum += difference;
                squares += difference * difference;
                ++count;
            }
        const double mean = sum / count;
        const double standardError = std::sqrt((squares / count - mean * mean) / count);
        CAPTURE(w, mean * 255, standardError * 255);
        CHECK(std::fabs(mean) <= 4.0 * standardError);
        CHECK(standardError < 2.0 / 255.0);
    }
}

TEST_CASE("a wall that the head is behind has no picture, and is named")
{
    const TemporaryFolder folder;
    REQUIRE(osgDB::writeNodeFile(*shell(), folder / "shell.osgt"));
    std::ofstream(folder / "cube.xml") << configuration();
    // The head is beyond the left wall, which is the first one.
    const Outcome outcome = osgraytrace(
        folder, "--cave cube.xml --head -2000 0 0 0 0 0 --max-passes 1 --output w.png shell.osgt");
    INFO(outcome.errors);
    CHECK(outcome.exitCode == 0);
    CHECK(outcome.errors.find("no picture of wall 0") != std::string::npos);
    CHECK_FALSE(osgDB::fileExists(folder / "w-0.png"));
    for (const char* other : {"w-1.png", "w-2.png", "w-3.png"})
        CHECK(osgDB::fileExists(folder / other));
}

TEST_CASE("a signal ends the viewer's pictures, which are written")
{
    for (int milliseconds = 500; milliseconds < 40000; milliseconds *= 2)
    {
        const TemporaryFolder folder;
        REQUIRE(osgDB::writeNodeFile(*shell(), folder / "shell.osgt"));
        std::ofstream(folder / "cube.xml") << configuration();
        RunningProgram program(folder / ".",
                               {OSGRAYTRACE_TEST_PROGRAM, "--cave", "cube.xml", "--max-passes",
                                "16777216", "--output", "w.png", "shell.osgt"});
        REQUIRE(program.handles(SIGTERM));
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        program.signal(SIGTERM);
        CHECK(program.wait() == 143);
        if (!osgDB::fileExists(folder / "w-0.png")) continue; // the program had not begun yet
        CHECK(program.printed().find("osgraytraceviewer: SIGTERM: pictures of ") !=
              std::string::npos);
        for (const char* file : {"w-0.png", "w-1.png", "w-2.png", "w-3.png"})
            CHECK(osgDB::readRefImageFile(folder / file));
        return;
    }
    FAIL("no picture was begun within 40 s");
}

TEST_CASE("the viewer refuses what is no CAVE")
{
    const TemporaryFolder folder;
    std::ofstream(folder / "bad.xml")
        << "<WindowConfig>\n<Window name=\"0\" width=\"wide\"/></WindowConfig>"
           "<ChannelConfig><Channel name=\"0\"/></ChannelConfig>"
           "<ScreenConfig><Screen name=\"0\"/></ScreenConfig>";
    const std::string model = dataFile("furnace.osgt");
    const Outcome bad = osgraytrace(folder, "--cave bad.xml --output o.png " + model);
    CHECK(bad.exitCode == 2);
    CHECK(bad.errors.find("bad.xml:2: <Window>: width=\"wide\" is no number") != std::string::npos);
    CHECK(osgraytrace(folder, "--cave none.xml --output o.png " + model).exitCode == 2);
    CHECK(osgraytrace(folder, "--head 0 0 0 0 0 0 " + model).exitCode == 1);
    CHECK(osgraytrace(folder, "--cave " + dataFile("cave_hmd.xml") +
                                  " --head-path none --output o.png " + model)
              .exitCode == 2);
    CHECK(osgraytrace(folder, "--cave " + dataFile("cave_hmd.xml") +
                                  " --max-passes 1 --output nowhere/o.png " + model)
              .exitCode == 4);
}
