// ModelPairsTest.cpp - all of OSG's sample models, traced and rasterized. Set OSG_FILE_PATH to
// OpenSceneGraph's sample models. Layer: tests.
// SPDX-License-Identifier: MIT
#include "PicturePair.h"
#include "tests/Catch.h"

#include <osgDB/FileUtils>
#include <osgDB/ReadFile>
#include <osgGA/TrackballManipulator>

#include <iostream>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

/// Sets osgviewer's home view.
void goHome(TestViewer& view)
{
    view.camera().setComputeNearFarMode(osg::Camera::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES);
    view.viewer.setCameraManipulator(new osgGA::TrackballManipulator);
    view.viewer.realize();
    view.viewer.frame(0.0);
}

} // namespace

TEST_CASE("sample models: traced and rasterized pictures", "[gl][osg-data]")
{
    for (const std::string name :
         {"SmokeBox.osgt", "axes.osgt", "cessna.osgt", "cessnafire.osgt", "clock.osgt",
          "dumptruck.osgt", "glider.osgt", "glsl_simple.osgt", "lz.osgt", "morphing.osg",
          "simpleroom.osgt", "cow.osgt", "cube_mapped_torus.osgt", "dot3_bumpmapping.osgt",
          "nathan.osg"})
    {
        if (osgDB::findDataFile(name).empty())
        {
            WARN("skipped: " << name << " is not in OSG_FILE_PATH");
            continue;
        }
        const PicturePair pair = picturePair(
            name, [&name] { return osgDB::readRefNodeFile(name); }, goHome);
        std::cout << name << ": mean difference " << pair.difference << "/255, worst tile "
                  << pair.worst << ", " << pair.covered << " pixels covered\n";
        for (const auto& [what, count] : pair.statistics.conversion)
            if (what.rfind("converted", 0) != 0)
                std::cout << "    " << what << ' ' << count << '\n';
        CAPTURE(name, pair.difference);
        // What OpenGL draws of vertices behind the end of an array depends on the memory there.
        if (pair.statistics.conversion.count("skipped.index-out-of-range") == 0)
            CHECK(pair.difference < 2.0);
    }
}
