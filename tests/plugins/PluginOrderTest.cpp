// PluginOrderTest.cpp - our plugins are taken before others of the same names. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/plugins/HdrFiles.h"
#include "tests/plugins/TemporaryFolder.h"

#include <osgDB/ObjectWrapper>
#include <osgDB/ReadFile>

#include <fstream>

using namespace osgRayTrace::engine::test;

TEST_CASE(
    "plugins: with any of ours loaded, .hdr files are read by ours, whatever folder comes first",
    "[plugins]")
{
    const TemporaryFolder folder;
    const std::string version = osgDB::Registry::instance()->createLibraryNameForExtension("hdr");
    std::filesystem::create_directories(std::filesystem::path(folder / version).parent_path());
    std::ofstream(folder / version) << "of somebody else";
    osgDB::FilePathList& folders = osgDB::Registry::instance()->getLibraryFilePathList();
    const std::string other = folder / "";

    folders.push_front(other);
    REQUIRE(osgDB::Registry::instance()->getObjectWrapperManager()->findWrapper(
        "osgRayTrace::EnvironmentLight"));
    CHECK(folders.front() != other);

    folders.push_front(other);
    CHECK_FALSE(osgDB::readRefNodeFile("none.osgt.raytrace"));
    CHECK(folders.front() != other);

    hdrPlugin(); // fails if the plugin is not ours
    const std::size_t count = folders.size();
    CHECK(osgDB::Registry::instance()->getReaderWriterForExtension("raytrace"));
    CHECK(folders.size() == count);
}
