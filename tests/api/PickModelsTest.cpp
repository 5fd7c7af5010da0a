// PickModelsTest.cpp - picks in real models as osgUtil does; OSG_FILE_PATH leads to the sample
// data. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/api/Picks.h"

#include <osgDB/FileUtils>
#include <osgDB/ReadFile>

#include <algorithm>
#include <random>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kRays = 10000;

/// Produces random lines through the middle of a model, from side to side.
class RandomLines
{
public:
    RandomLines(const osg::BoundingSphere& bound, unsigned int seed) : _bound(bound), _random(seed)
    {
    }

    Line next()
    {
        const osg::Vec3d through =
            osg::Vec3d(_bound.center()) + direction() * (0.5 * _bound.radius());
        const osg::Vec3d along = direction() * (2.0 * _bound.radius());
        return {through - along, through + along};
    }

private:
    osg::Vec3d direction()
    {
        const engine::test::NormalNumbers normal;
        // One after the other: the order in which arguments are evaluated is the compiler's.
        const double x = normal(_random), y = normal(_random), z = normal(_random);
        osg::Vec3d d(x, y, z);
        d.normalize();
        return d;
    }

    osg::BoundingSphere _bound;
    std::mt19937 _random;
};

struct Tally
{
    int rays = 0, hits = 0, same = 0, ties = 0, edges = 0, wrong = 0;
};

/// Checks everything that osgUtil tells about a hit.
void checkDetails(const Pick& ours, const Pick& theirs, double radius)
{
    REQUIRE(std::fabs(ours.ratio - theirs.ratio) < 1e-6);
    REQUIRE((ours.getLocalIntersectPoint() - theirs.getLocalIntersectPoint()).length() <
            1e-6 * radius);
    REQUIRE((ours.getWorldIntersectPoint() - theirs.getWorldIntersectPoint()).length() <
            1e-6 * radius);
    REQUIRE((ours.getLocalIntersectNormal() - theirs.getLocalIntersectNormal()).length() < 1e-5f);
    REQUIRE((ours.getWorldIntersectNormal() - theirs.getWorldIntersectNormal()).length() < 1e-5f);
}

void compare(const std::string& file, int rays, Tally& tally)
{
    const osg::ref_ptr<osg::Node> model = osgDB::readRefNodeFile(file);
    REQUIRE(model);
    const osg::ref_ptr<RayTracedScene> scene = new RayTracedScene;
    scene->addChild(model);
    RandomLines lines(model->getBound(), 17);
    for (int i = 0; i < rays; ++i)
    {
        const Line line = lines.next();
        const double tolerance =
            1e-5 * model->getBound().radius() / (line.end - line.start).length();
        const Picks theirs = picksOfOsg(*scene, line);
        const Picks ours = picksByRay(*scene, line);
        ++tally.rays;
        tally.hits += !theirs.empty();
        switch (relation(ours, theirs, tolerance))
        {
        case Relation::Same:
            ++tally.same;
            if (!ours.empty())
                checkDetails(ours.front(), theirs.front(), model->getBound().radius());
            break;
        case Relation::Tie:
            ++tally.ties;
            break;
        case Relation::Other:
            if (isAtAnEdge(*scene, line, ours, theirs, tolerance))
                ++tally.edges;
            else
            {
                ++tally.wrong;
                UNSCOPED_INFO(file << ", ray " << i << ": " << describe(ours) << " not "
                                   << describe(theirs));
            }
            break;
        }
    }
}

} // namespace

TEST_CASE("the picker has osgUtil's nearest hit on 10,000 rays over real models", "[osg-data]")
{
    const std::vector<std::string> files = {"cow.osgt", "cessna.osgt",    "glider.osgt",
                                            "lz.osgt",  "dumptruck.osgt", "simpleroom.osgt"};
    Tally tally;
    for (const std::string& file : files)
    {
        if (osgDB::findDataFile(file).empty())
        {
            WARN("skipped: " << file << " not found; set OSG_FILE_PATH");
            continue;
        }
        compare(file, kRays / static_cast<int>(files.size()) + 1, tally);
    }
    if (tally.rays == 0) return;
    INFO(tally.hits << " hits, " << tally.same << " the same, " << tally.ties << " ties, "
                    << tally.edges << " at edges, " << tally.wrong << " wrong");
    CHECK(tally.wrong == 0);
    CHECK(tally.hits > tally.rays / 3);
    CHECK(tally.ties + tally.edges <= tally.rays / 1000);
}
