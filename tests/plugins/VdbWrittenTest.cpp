// VdbWrittenTest.cpp - files that OpenVDB writes have the values that OpenVDB has. Layer: tests.
// SPDX-License-Identifier: MIT
#include "VdbFiles.h"
#include "VdbWriting.h"

#include <ctime>
#include <iostream>

using namespace osgRayTrace::test;

namespace
{

constexpr std::uint32_t kZip = 1, kActive = 2, kBlosc = 4;

/// Compares all cells of a grid read with one voxel a cell. half: values have 11 bits.
void compareAll(const osgVolume::VolumeTile& tile, const VdbWritten& written, bool half)
{
    const osg::Image& image = *layerOf(tile).getImage();
    REQUIRE(image.s() == written.size[0]);
    REQUIRE(image.t() == written.size[1]);
    REQUIRE(image.r() == written.size[2]);
    const double step = half ? 0x1p-11 : 0x1p-22;
    const float scale = layerOf(tile).getTexelScale()[3];
    int wrong = 0;
    for (int z = 0; z < image.r(); ++z)
        for (int y = 0; y < image.t(); ++y)
        {
            const auto* const row = reinterpret_cast<const float*>(image.data(0, y, z));
            for (int x = 0; x < image.s(); ++x)
            {
                const double expected =
                    written.value(x + written.low[0], y + written.low[1], z + written.low[2]);
                const double found = row[x] * scale;
                // OpenVDB stores inactive values with all of their bits.
                const bool close = std::fabs(found - expected) <= step * std::fabs(expected) + 1e-7;
                if (close || wrong++ > 0) continue;
                FAIL_CHECK(x << " " << y << " " << z << ": " << found << ", not " << expected);
            }
        }
    CHECK(wrong == 0);
}

} // namespace

TEST_CASE("vdb: all voxels have OpenVDB's values, whatever the storage", "[vdb]")
{
    const VdbContent content =
        GENERATE(VdbContent::Fog, VdbContent::Tiles, VdbContent::Inactive, VdbContent::Octants);
    for (const std::uint32_t compression :
         {0u, kZip, kActive, kBlosc, kZip | kActive, kBlosc | kActive})
        for (const bool half : {false, true})
            for (const bool isDouble : {false, true})
            {
                VdbStyle style;
                style.content = content;
                style.compression = compression;
                style.half = half;
                style.isDouble = isDouble;
                style.isFog = false;
                INFO("content " << int(content) << ", compression " << compression << ", half "
                                << half << ", double " << isDouble);
                const VdbWritten written = writeVdb(style);
                compareAll(*tileOf(written.bytes), written, half);
            }
}

TEST_CASE("vdb: a level set is an isosurface at a half", "[vdb]")
{
    for (const std::uint32_t compression : {0u, kActive, kBlosc | kActive})
    {
        VdbStyle style;
        style.content = VdbContent::LevelSet;
        style.compression = compression;
        const VdbWritten written = writeVdb(style);
        const auto tile = tileOf(written.bytes);
        const auto* property =
            dynamic_cast<const osgVolume::IsoSurfaceProperty*>(layerOf(*tile).getProperty());
        REQUIRE(property);
        CHECK(property->getValue() == 0.5f);
        const osg::Image& image = *layerOf(*tile).getImage();
        for (int z = 0; z < image.r(); ++z)
            for (int y = 0; y < image.t(); ++y)
                for (int x = 0; x < image.s(); ++x)
                {
                    const float level =
                        written.value(x + written.low[0], y + written.low[1], z + written.low[2]);
                    const double expected = 0.5 - 0.5 * level / kLevelSetWidth;
                    if (std::fabs(valueAt(*tile, x, y, z) - expected) > 1e-6)
                        FAIL(x << " " << y << " " << z);
                }
    }
}

TEST_CASE("vdb: affine transforms place voxels where OpenVDB does", "[vdb]")
{
    for (const VdbMap map : {VdbMap::UniformScale, VdbMap::Scale, VdbMap::ScaleTranslate,
                             VdbMap::Translation, VdbMap::Affine, VdbMap::Unitary})
    {
        VdbStyle style;
        style.map = map;
        style.compression = kBlosc | kActive;
        const VdbWritten written = writeVdb(style);
        const auto tile = tileOf(written.bytes), turned = tileOf(written.bytes, "yUp");
        for (const int corner : {0, 1, 2, 4, 7})
        {
            int cell[3], voxel[3];
            for (std::size_t k = 0; k < 3; ++k)
            {
                cell[k] = corner >> k & 1 ? written.size[k] - 1 : 0;
                voxel[k] = cell[k] + written.low[k];
            }
            const auto expected = written.world(voxel[0], voxel[1], voxel[2]);
            const osg::Vec3d found = placeOf(*tile, cell[0], cell[1], cell[2]);
            INFO("map " << int(map) << ", corner " << corner);
            for (int k = 0; k < 3; ++k)
                CHECK(std::fabs(found[k] - expected[std::size_t(k)]) < 1e-9);
            const osg::Vec3d up = placeOf(*turned, cell[0], cell[1], cell[2]);
            CHECK((up - osg::Vec3d(found.x(), -found.z(), found.y())).length() < 1e-9);
        }
    }
}

TEST_CASE("vdb: what cannot be placed or read is refused by name", "[vdb]")
{
    const auto message = [](const VdbStyle& style, const std::string& options = "")
    {
        auto result = readVdb(writeVdb(style).bytes, options);
        CHECK(result.status() == osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE);
        return result.message();
    };
    VdbStyle frustum, empty, stream;
    frustum.map = VdbMap::Frustum;
    empty.content = VdbContent::Empty;
    stream.asStream = true;
    CHECK_THAT(message(frustum), Catch::Matchers::Contains("NonlinearFrustumMap"));
    CHECK_THAT(message(empty), Catch::Matchers::Contains("no active voxels"));
    CHECK_THAT(message(stream), Catch::Matchers::Contains("as a stream"));
}

TEST_CASE("vdb: a grid that shares a tree has its own place", "[vdb]")
{
    VdbStyle style;
    style.others = true;
    style.compression = kBlosc | kActive;
    const VdbWritten written = writeVdb(style);
    compareAll(*tileOf(written.bytes), written, false);
    const auto shared = tileOf(written.bytes, "grid=shared");
    CHECK(shared->getName() == "shared");
    compareAll(*shared, written, false);
    const osg::Vec3d expected(written.low[0] + 1.0, written.low[1] + 2.0, written.low[2] + 3.0);
    CHECK((placeOf(*shared, 0, 0, 0) - expected).length() < 1e-9);
}

TEST_CASE("vdb: larger grids are read as means", "[vdb]")
{
    for (const VdbContent content : {VdbContent::Fog, VdbContent::Tiles, VdbContent::Octants})
    {
        VdbStyle style;
        style.content = content;
        style.isFog = false;
        const VdbWritten written = writeVdb(style);
        const int voxels = written.size[0] * written.size[1] * written.size[2];
        const auto tile = tileOf(written.bytes, "maxVoxels=" + std::to_string(voxels / 20));
        const osg::Image& image = *layerOf(*tile).getImage();
        CHECK(image.s() * image.t() * image.r() <= voxels / 20);
        constexpr int kFactor = 3; // the least with which 1/20 of the voxels is enough
        REQUIRE(image.s() == (written.size[0] + kFactor - 1) / kFactor);
        for (int z = 0; z < image.r(); ++z)
            for (int y = 0; y < image.t(); ++y)
                for (int x = 0; x < image.s(); ++x)
                {
                    double sum = 0.0;
                    for (int i = 0; i < kFactor * kFactor * kFactor; ++i)
                        sum += written.value(written.low[0] + kFactor * x + i % kFactor,
                                             written.low[1] + kFactor * y + i / kFactor % kFactor,
                                             written.low[2] + kFactor * z + i / kFactor / kFactor);
                    const double expected = sum / (kFactor * kFactor * kFactor);
                    if (std::fabs(valueAt(*tile, x, y, z) - expected) > 1e-5)
                        FAIL(x << " " << y << " " << z << ": " << valueAt(*tile, x, y, z)
                               << ", not " << expected);
                }
    }
    VdbStyle far;
    far.content = VdbContent::Far;
    const auto tile = tileOf(writeVdb(far).bytes);
    CHECK(layerOf(*tile).getImage()->s() == (100001 + 6) / 7); // at most 16,384 along a side
    CHECK(layerOf(*tileOf(writeVdb(far).bytes, "maxVoxels=1")).getImage()->s() == 1);
}

TEST_CASE("vdb: values that are not finite are the background", "[vdb]")
{
    VdbStyle style;
    style.content = VdbContent::NotFinite;
    const auto tile = tileOf(writeVdb(style).bytes);
    const osg::Image& image = *layerOf(*tile).getImage();
    for (int z = 0; z < image.r(); ++z)
        for (int y = 0; y < image.t(); ++y)
            for (int x = 0; x < image.s(); ++x)
                REQUIRE(std::isfinite(valueAt(*tile, x, y, z)));
}

// These are no tests: the first one writes the files in tests/plugins/vdb, the second one tells
// times.
TEST_CASE("vdb: write the files", "[.write]")
{
    const auto write = [](const std::string& name, const VdbStyle& style)
    {
        std::ofstream(std::string(OSGRAYTRACE_TEST_SOURCE) + "/tests/plugins/vdb/" + name + ".vdb",
                      std::ios::binary)
            << writeVdb(style).bytes;
    };
    VdbStyle blosc, zipHalf, active, levelSet, tiles;
    blosc.compression = kBlosc | kActive;
    blosc.map = VdbMap::ScaleTranslate;
    blosc.others = true;
    zipHalf.compression = kZip | kActive;
    zipHalf.half = true;
    zipHalf.isFog = false;
    zipHalf.map = VdbMap::Affine;
    active.compression = kActive;
    levelSet.content = VdbContent::LevelSet;
    levelSet.compression = kBlosc | kActive;
    levelSet.name = "surface";
    tiles.content = VdbContent::Tiles;
    tiles.isDouble = true;
    tiles.compression = kZip | kActive;
    tiles.isFog = false;
    write("fog_blosc", blosc);
    write("fog_zip_half", zipHalf);
    write("fog_active", active);
    write("level_set", levelSet);
    write("tiles_double", tiles);
}

TEST_CASE("vdb: time of 256^3 voxels", "[.time]")
{
    for (const std::uint32_t compression : {kActive, kBlosc | kActive})
    {
        const std::string bytes = writeDenseVdb(256, compression);
        for (int run = 0; run < 3; ++run)
        {
            const std::clock_t begin = std::clock();
            tileOf(bytes);
            std::cout << "compression " << compression << ", " << bytes.size()
                      << " bytes: " << double(std::clock() - begin) / CLOCKS_PER_SEC
                      << " s of the processor\n";
        }
    }
}
