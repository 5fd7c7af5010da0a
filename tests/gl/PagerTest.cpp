// PagerTest.cpp - pages settle and expire below a traced scene as without it. Layer: tests.
// SPDX-License-Identifier: MIT
#include "TestViewer.h"
#include "tests/Catch.h"
#include "tests/plugins/TemporaryFolder.h"

#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osgDB/DatabasePager>
#include <osgDB/WriteFile>

#include <algorithm>
#include <set>
#include <string>

using namespace osgRayTrace;
using namespace osgRayTrace::test;

namespace
{

constexpr int kSide = 10;         ///< tiles of a side of the terrain
constexpr float kTileSize = 4.0f; ///< length of a tile
constexpr int kQuarters = 4;
constexpr int kMostFrames = 400;     ///< until everything has settled
constexpr unsigned int kTarget = 12; ///< pages that the pager may keep

/// Holds the files of a terrain: each tile has finer ones in four files, and each of those again.
class TerrainFiles
{
public:
    TerrainFiles()
    {
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
            {
                const std::string name = std::to_string(x) + "-" + std::to_string(y);
                write(name + "-1", finer(name, kTileSize, 1));
                for (int quarter = 0; quarter < kQuarters; ++quarter)
                    write(name + "-1" + std::to_string(quarter),
                          square(0.5f * kTileSize, 0.9f).get());
            }
    }

    osg::ref_ptr<osg::Group> terrain() const
    {
        osg::ref_ptr<osg::Group> terrain = new osg::Group;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
            {
                osg::ref_ptr<osg::MatrixTransform> place =
                    new osg::MatrixTransform(osg::Matrix::translate(
                        (x - 0.5 * kSide) * kTileSize, (y - 0.5 * kSide) * kTileSize, 0.0));
                const std::string name = std::to_string(x) + "-" + std::to_string(y);
                const osg::ref_ptr<osg::PagedLOD> tile = page(name + "-1", kTileSize, 0.3f, 14.0f);
                tile->setDatabasePath(_folder / "");
                place->addChild(tile);
                terrain->addChild(place);
            }
        return terrain;
    }

private:
    static osg::ref_ptr<osg::Geometry> square(float size, float green)
    {
        const osg::ref_ptr<osg::Geometry> square =
            unlitSquare(0.5f * size, osg::Vec4(0.2f, green, 0.1f, 1.0f));
        return square;
    }

    /// Returns a coarse square and the file that takes its place where the eye is near.
    osg::ref_ptr<osg::PagedLOD> page(const std::string& name, float size, float green,
                                     float range) const
    {
        osg::ref_ptr<osg::PagedLOD> page = new osg::PagedLOD;
        page->setName(name);
        page->setCenter(osg::Vec3());
        page->setRadius(size);
        page->addChild(square(size, green), range, 1e6f);
        page->setFileName(1, name + ".osgb"); // in the folder of the file that names it
        page->setRange(1, 0.0f, range);
        return page;
    }

    osg::ref_ptr<osg::Group> finer(const std::string& name, float size, int level) const
    {
        osg::ref_ptr<osg::Group> group = new osg::Group;
        for (int quarter = 0; quarter < kQuarters; ++quarter)
        {
            osg::ref_ptr<osg::MatrixTransform> place =
                new osg::MatrixTransform(osg::Matrix::translate(
                    (quarter % 2 - 0.5) * 0.5 * size, (quarter / 2 - 0.5) * 0.5 * size, 0.0));
            place->addChild(page(name + "-" + std::to_string(level) + std::to_string(quarter),
                                 0.5f * size, 0.6f, 8.0f));
            group->addChild(place);
        }
        return group;
    }

    void write(const std::string& name, osg::ref_ptr<osg::Node> node) const
    {
        osgDB::writeNodeFile(*node, _folder / (name + ".osgb"));
    }

    TemporaryFolder _folder;
};

/// Finds the pages that are loaded.
struct LoadedPages : osg::NodeVisitor
{
    LoadedPages() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::PagedLOD& page) override
    {
        if (page.getNumChildren() > 1) names.insert(page.getName());
        traverse(page);
    }
    std::set<std::string> names;
};

/// Holds a viewer of the terrain with a pager.
struct PagedView
{
    PagedView(const TerrainFiles& files, bool traced)
        : scene(tracedScene(files.terrain().get())), viewer(96, 96, scene.get())
    {
        scene->setEnabled(traced);
        pager().setTargetMaximumNumberOfPageLOD(kTarget);
    }

    /// Joins the threads of the pager, which OSG ends without joining them.
    ~PagedView()
    {
        pager().cancel();
        for (unsigned int i = 0; i < pager().getNumDatabaseThreads(); ++i)
            pager().getDatabaseThread(i)->join();
    }

    osgDB::DatabasePager& pager() { return *viewer.viewer.getDatabasePager(); }

    /// Draws until the pages stay the same, and returns their names.
    std::set<std::string> settle(const osg::Vec3d& eye, const osg::Vec3d& center)
    {
        viewer.look(eye, center);
        int still = 0;
        std::set<std::string> last;
        for (int frame = 0; frame < kMostFrames && still < 30; ++frame)
        {
            viewer.viewer.frame(time += 0.5);
            OpenThreads::Thread::microSleep(2000); // for the threads of the pager
            LoadedPages pages;
            scene->getChild(0)->accept(pages);
            const bool same = pages.names == last && !pager().getRequestsInProgress();
            still = same ? still + 1 : 0;
            last = pages.names;
        }
        return last;
    }

    osg::ref_ptr<RayTracedScene> scene;
    TestViewer viewer;
    double time = 0.0;
};

} // namespace

TEST_CASE("pager: pages settle and expire below a traced scene as without it", "[gl][pager]")
{
    const TerrainFiles files;
    PagedView traced(files, true), plain(files, false);
    const osg::Vec3d far(0.0, 0.0, 60.0),
        places[] = {{-12.0, -12.0, 7.0}, {0.0, 2.0, 5.0}, {13.0, 9.0, 11.0}, {13.0, -10.0, 7.0}};
    std::size_t most = 0;
    for (const osg::Vec3d& place : places)
    {
        const osg::Vec3d center(place.x() + 1.0, place.y(), 0.0);
        const std::set<std::string> wanted = plain.settle(place, center);
        const std::set<std::string> pages = traced.settle(place, center);
        CAPTURE(place.x(), place.y());
        CHECK(wanted.size() > 0);
        CHECK(pages == wanted);
        most = std::max(most, pages.size());
    }
    const std::set<std::string> kept = plain.settle(far, osg::Vec3d());
    const std::set<std::string> pages = traced.settle(far, osg::Vec3d());
    CAPTURE(most, kept.size());
    CHECK(pages.size() == kept.size());
    CHECK(kept.size() < most); // pages have expired
}
