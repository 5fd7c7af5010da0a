// ModelPairsTest.cpp - all of OSG's sample models, traced and rasterized. Layer: tests.
// Set OSG_FILE_PATH to OpenSceneGraph's sample models.
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

/// At osgviewer's home view.
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
    // The last four have textures by generated coordinates, a cube map, combined textures and a
    // glass case that blends: those are counted, and compared when they are traced.
    struct Model
    {
        const char* name;
        const char* approximated = nullptr;
    };
    const Model models[] = {{"SmokeBox.osgt"},
                            {"axes.osgt"},
                            {"cessna.osgt"},
                            {"cessnafire.osgt"},
                            {"clock.osgt"},
                            {"dumptruck.osgt"},
                            {"glider.osgt"},
                            {"glsl_simple.osgt"},
                            {"lz.osgt"},
                            {"morphing.osg"},
                            {"simpleroom.osgt"},
                            {"cow.osgt", "approximated.texgen"},
                            {"cube_mapped_torus.osgt", "approximated.texture-target"},
                            {"dot3_bumpmapping.osgt", "approximated.texture-environment"},
                            {"nathan.osg", "approximated.blending"}};
    for (const auto& [name, approximated] : models)
    {
        if (osgDB::findDataFile(name).empty())
        {
            WARN("skipped: " << name << " is not in OSG_FILE_PATH");
            continue;
        }
        const PicturePair pair = picturePair(
            name, [file = name] { return osgDB::readRefNodeFile(file); }, goHome);
        std::cout << name << ": mean difference " << pair.difference << "/255, worst tile "
                  << pair.worst << ", " << pair.covered << " pixels covered\n";
        for (const auto& [what, count] : pair.statistics.conversion)
            if (what.rfind("converted", 0) != 0)
                std::cout << "    " << what << ' ' << count << '\n';
        CAPTURE(name, pair.difference);
        CHECK((pair.difference < 2.0 || (approximated && pair.count(approximated) > 0)));
    }
}
