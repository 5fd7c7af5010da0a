// PickModelsTest.cpp - picks in real models as osgUtil does; OSG_FILE_PATH leads to the sample data. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
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

/// Random lines through a ball around the model.
class RandomLines
{
public:
    RandomLines(const osg::BoundingSphere& bound, unsigned int seed) : _bound(bound), _random(seed)
    {
    }

    Line next() { return {point(), point()}; }

private:
    osg::Vec3d point()
    {
        std::normal_distribution<double> normal;
        osg::Vec3d p(normal(_random), normal(_random), normal(_random));
        p.normalize();
        return osg::Vec3d(_bound.center()) + p * (1.1 * _bound.radius());
    }

    osg::BoundingSphere _bound;
    std::mt19937 _random;
};

struct Tally
{
    int rays = 0, hits = 0, same = 0, ties = 0, edges = 0, wrong = 0;
};

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
        const double tolerance = 1e-5 * model->getBound().radius() / (line.end - line.start).length();
        const Picks theirs = picksOfOsg(*scene, line);
        const Picks ours = picksByRay(*scene, line);
        ++tally.rays;
        tally.hits += !theirs.empty();
        switch (relation(ours, theirs, tolerance))
        {
        case Relation::Same:
            ++tally.same;
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
                UNSCOPED_INFO(file << ", ray " << i << ": " << describe(ours) << " not " << describe(theirs));
            }
            break;
        }
    }
}

} // namespace

TEST_CASE("the picker has osgUtil's nearest hit on 10,000 rays over real models", "[osg-data]")
{
    const std::vector<std::string> files = {"cow.osgt", "cessna.osgt", "glider.osgt",
                                            "lz.osgt", "dumptruck.osgt", "simpleroom.osgt"};
    Tally tally;
    for (const std::string& file : files)
    {
        if (osgDB::findDataFile(file).empty())
        {
            WARN("skipped: " << file << " not found; set OSG_FILE_PATH");
            continue;
        }
        compare(file, kRays / static_cast<int>(files.size()) + 1, tally);
        std::printf("%s: rays %d hits %d same %d ties %d edges %d wrong %d\n", file.c_str(), tally.rays, tally.hits, tally.same, tally.ties, tally.edges, tally.wrong);
    }
    CHECK(tally.wrong == 0);
}
