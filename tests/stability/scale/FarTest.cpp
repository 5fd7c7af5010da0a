// FarTest.cpp - the same scene at the origin and at the radius of the earth. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/stability/scale/ScaledScene.h"

#include <cmath>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

const osg::Vec3d kOnEquator(6378137.0, 0.0, 0.0), kDiagonal(4.51e6, 4.51e6, 0.0);

/// These recipes compute direct light only, without a bounce.
const Recipe kWhittedDirect{RayTraceSettings::WHITTED, 0, 4};
const Recipe kPathDirect{RayTraceSettings::PATH, 0, 4};

uint64_t farVertices(const Picture& picture)
{
    const auto found = picture.statistics.conversion.find("warned.far-vertices");
    return found == picture.statistics.conversion.end() ? 0 : found->second;
}

/// Returns the distance at which the line through a pixel's centre meets the floor, which is z = 0.
double distanceToFloor(int x, int y)
{
    osg::Vec3d forward = kTarget - kEye;
    forward.normalize();
    osg::Vec3d right = forward ^ osg::Vec3d(0.0, 0.0, 1.0);
    right.normalize();
    const osg::Vec3d up = right ^ forward;
    const double half = std::tan(osg::DegreesToRadians(0.5 * kFovyDegrees));
    osg::Vec3d direction = forward +
                           right * (half * (2.0 * (x + 0.5) / kWidth - 1.0) * kWidth / kHeight) +
                           up * (half * (2.0 * (y + 0.5) / kHeight - 1.0));
    direction.normalize();
    return -kEye.z() / direction.z();
}

/// The largest error of distances to the floor, which is the first instance, and the number of
/// pixels that show it.
struct FloorError
{
    double largest = 0.0;
    int pixels = 0;
};

FloorError floorError(const Picture& picture)
{
    FloorError error;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
        {
            const std::size_t i = static_cast<std::size_t>(y * kWidth + x);
            if (picture.id.at(i) != 1.0f) continue;
            ++error.pixels;
            error.largest =
                std::max(error.largest, std::abs(picture.distance[i] - distanceToFloor(x, y)));
        }
    return error;
}

} // namespace

TEST_CASE("stability 1: the same picture at the origin and at earth radius", "[stability]")
{
    const Placement home;
    const Picture classicHome = pictureOf(*classicScene(home), home, kWhittedDirect);
    const Picture physicalHome = pictureOf(*physicalScene(home), home, kPathDirect);
    CHECK(floorError(classicHome).largest < 1e-5);
    for (const osg::Vec3d& offset : {kOnEquator, kDiagonal})
    {
        for (const Storage storage : {Storage::Local, Storage::Double})
        {
            CAPTURE(offset.x(), offset.y(), int(storage));
            const Placement far{1.0, offset, storage};
            const Picture classic = pictureOf(*classicScene(far), far, kWhittedDirect);
            CHECK(classic.statistics.droppedSamples == 0);
            CHECK(farVertices(classic) == 0);
            CHECK(largestDifference(classic, classicHome) <= 1e-5);
            const FloorError floor = floorError(classic);
            CHECK(floor.pixels > 500);
            CHECK(floor.largest <= 1e-5);

            const Picture physical = pictureOf(*physicalScene(far), far, kPathDirect);
            CHECK(largestDifference(physical, physicalHome) <= 1e-5);
        }
    }
}

TEST_CASE("stability 2: world coordinates baked into floats are named", "[stability]")
{
    const Placement home{1.0, osg::Vec3d(), Storage::Float};
    CHECK(farVertices(pictureOf(*classicScene(home), home, kWhittedDirect)) == 0);
    for (const osg::Vec3d& offset : {kOnEquator, kDiagonal})
    {
        const Placement far{1.0, offset, Storage::Float};
        for (const auto makeScene : {classicScene, physicalScene})
        {
            for (const Recipe& recipe : {kWhittedDirect, kPathDirect})
            {
                const Picture picture = pictureOf(*makeScene(far), far, recipe);
                CHECK(picture.statistics.ok);
                CHECK(picture.statistics.droppedSamples == 0);
                CHECK(allFinite(picture.rgba));
                // The floor, the ball and the panel of the physical scene are counted; the boxes
                // have transforms.
                CHECK(farVertices(picture) == (makeScene == physicalScene ? 3 : 2));
            }
        }
    }
}
