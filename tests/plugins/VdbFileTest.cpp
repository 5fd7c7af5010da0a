// VdbFileTest.cpp - files of OpenVDB 10.0.1 as tiles, and files that are damaged. Layer: tests.
// SPDX-License-Identifier: MIT
#include "VdbSamples.h"

#include "TemporaryFolder.h"

#include <osgRayTrace/Medium>
#include <osgRayTrace/PhysicalMaterial>

#include <osg/ComputeBoundsVisitor>
#include <osg/Notify>
#include <osgDB/ReadFile>
#include <osgVolume/RayTracedTechnique>

#include <cstring>
#include <functional>

using namespace osgRayTrace::test;

namespace
{

#ifdef OSGRAYTRACE_TEST_BLOSC
constexpr bool kHasBlosc = true;
#else
constexpr bool kHasBlosc = false;
#endif

/// Names the files that this build can read.
std::vector<std::string> readableFiles()
{
    std::vector<std::string> names;
    for (const std::string name : kVdbFiles)
        if (kHasBlosc || (name != "fog_blosc" && name != "level_set")) names.push_back(name);
    return names;
}

/// Returns what is wrong with a file that cannot be read.
std::string messageOf(const std::string& bytes, const std::string& options = "")
{
    auto result = readVdb(bytes, options);
    CHECK(result.status() == osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE);
    CHECK(result.message().find('\n') == std::string::npos);
    return result.message();
}

/// Compares all cells with a function of the indices.
void compareAll(const osgVolume::VolumeTile& tile, const int (&low)[3], const int (&size)[3],
                const std::function<double(int, int, int)>& expected, double tolerance)
{
    const osg::Image& image = *layerOf(tile).getImage();
    REQUIRE(image.s() == size[0]);
    REQUIRE(image.t() == size[1]);
    REQUIRE(image.r() == size[2]);
    for (int z = 0; z < size[2]; ++z)
        for (int y = 0; y < size[1]; ++y)
            for (int x = 0; x < size[0]; ++x)
                if (!(std::fabs(valueAt(tile, x, y, z) -
                                expected(x + low[0], y + low[1], z + low[2])) <= tolerance))
                    FAIL(x << " " << y << " " << z << ": " << valueAt(tile, x, y, z));
}

constexpr int kFogLow[] = {14, -37, 7}, kFogSize[] = {14, 14, 13};

void put(std::string& bytes, std::size_t at, std::uint32_t value)
{
    std::memcpy(&bytes[at], &value, sizeof value);
}

/// Puts another value of 8 bytes into the place of a grid, behind its type and an empty parent.
std::size_t placeOfGrid(const std::string& bytes)
{
    const std::string type = "Tree_float_5_4_3";
    return bytes.find(type) + type.size() + 4;
}

} // namespace

TEST_CASE("vdb: densities are those that were written", "[vdb]")
{
    for (const std::string name : {"fog_blosc", "fog_zip_half", "fog_active"})
    {
        if (!kHasBlosc && name == "fog_blosc") continue;
        INFO(name);
        const double tolerance = name == "fog_zip_half" ? 3.0 * 0x1p-11 : 1e-6;
        compareAll(*tileOf(vdbFile(name)), kFogLow, kFogSize, ballDensity, tolerance);
    }
}

TEST_CASE("vdb: tiles are filled", "[vdb]")
{
    const auto tile = tileOf(vdbFile("tiles_double"));
    const int low[] = {-8, 0, 0}, size[] = {149, 128, 128};
    compareAll(
        *tile, low, size,
        [](int x, int y, int z)
        {
            if (x < 0) return y < 8 && z < 8 ? 4.0 : 0.5;
            if (x < 128) return 0.25;
            if (x < 136) return z >= 8 ? 0.5 : y < 8 ? 2.0 : y < 16 ? -1.0 : 0.5;
            return y >= 3 && y < 10 && z >= 2 && z < 21 ? 0.75 : 0.5;
        },
        1e-6);
}

TEST_CASE("vdb: smoke has the depth that is asked for", "[vdb]")
{
    const auto coefficients = [](const osgVolume::VolumeTile& tile)
    {
        const auto* material = dynamic_cast<const osgRayTrace::PhysicalMaterial*>(
            tile.getStateSet()->getAttribute(osgRayTrace::PhysicalMaterial::ATTRIBUTE_TYPE));
        REQUIRE(material);
        const osgRayTrace::Medium* medium = material->getInterior();
        REQUIRE(medium);
        float transparency = 0.0f;
        struct Reader : osgVolume::PropertyVisitor
        {
            Reader() : osgVolume::PropertyVisitor(true) {}
            using osgVolume::PropertyVisitor::apply;
            void apply(osgVolume::TransparencyProperty& p) override { value = p.getValue(); }
            float value = 0.0f;
        } reader;
        const_cast<osgVolume::Property*>(layerOf(tile).getProperty())->accept(reader);
        transparency = reader.value;
        CHECK((transparency > 0.0f && transparency <= 1.0f));
        return double(medium->getScattering()[0] + medium->getAbsorption()[0]) *
               double(transparency);
    };
    const std::string file = vdbFile("fog_active"); // voxels of 1/8
    const auto automatic = tileOf(file);
    const osg::Image& image = *layerOf(*automatic).getImage();
    const auto* values = reinterpret_cast<const float*>(image.data());
    double sum = 0.0, count = 0.0, largest = 0.0;
    for (int i = 0; i < image.s() * image.t() * image.r(); ++i)
    {
        sum += values[i];
        count += values[i] > 0.0f;
        largest = std::max(largest, double(values[i]));
    }
    CHECK(largest == 1.0);
    CHECK(coefficients(*automatic) * (sum / count) * (14 * 0.125) == Approx(10.0).epsilon(1e-4));

    // The densest voxel has the layer's texel scale as its density.
    const auto chosen = tileOf(file, "extinction=2.5");
    CHECK(coefficients(*chosen) == Approx(2.5 * layerOf(*chosen).getTexelScale()[3]).epsilon(1e-4));
    CHECK(dynamic_cast<osgVolume::RayTracedTechnique*>(chosen->getVolumeTechnique()));
}

TEST_CASE("vdb: grids are chosen by name, and others are named", "[vdb]")
{
    if (!kHasBlosc)
    {
        WARN("skipped: this build has no blosc");
        return;
    }
    const std::string file = vdbFile("fog_blosc");
    CHECK(tileOf(file)->getName() == "density");
    const auto flame = tileOf(file, "grid=flame");
    CHECK(flame->getName() == "flame");
    CHECK(layerOf(*flame).getImage()->s() == 1);
    CHECK(valueAt(*flame, 0, 0, 0) == 8.0f);
    CHECK(placeOf(*flame, 0, 0, 0) == osg::Vec3d(4, 5, 6));
    CHECK_THAT(messageOf(file, "grid=vel"), Catch::Matchers::Contains("vel (Tree_vec3s_5_4_3)"));
    CHECK_THAT(messageOf(file, "grid=none"), Catch::Matchers::Contains("no grid 'none'"));
    CHECK_THAT(messageOf(file, "grid=none"), Catch::Matchers::Contains("flame (Tree_float"));

    struct Listener : osg::NotifyHandler
    {
        void notify(osg::NotifySeverity, const char* message) override { text += message; }
        std::string text;
    };
    const osg::ref_ptr<osg::NotifyHandler> before = osg::getNotifyHandler();
    const osg::ref_ptr<Listener> listener = new Listener;
    const osg::NotifySeverity level = osg::getNotifyLevel();
    osg::setNotifyLevel(osg::NOTICE);
    osg::setNotifyHandler(listener);
    tileOf(file);
    osg::setNotifyHandler(before);
    osg::setNotifyLevel(level);
    CHECK_THAT(listener->text,
               Catch::Matchers::Contains("not read: vel (Tree_vec3s_5_4_3), flame"));
}

TEST_CASE("vdb: a level set is a closed ball", "[vdb]")
{
    if (!kHasBlosc)
    {
        WARN("skipped: this build has no blosc");
        return;
    }
    const auto tile = tileOf(vdbFile("level_set"));
    CHECK(tile->getStateSet() == nullptr);
    const int low[] = {13, -38, 6}, size[] = {16, 16, 15};
    compareAll(
        *tile, low, size,
        [](int x, int y, int z) { return 0.5 - 0.5 * ballLevel(x, y, z) / kLevelSetWidth; }, 1e-6);
}

TEST_CASE("vdb: files are read by name, by every OSG program", "[vdb]")
{
    const std::string name =
        std::string(OSGRAYTRACE_TEST_SOURCE) + "/tests/plugins/vdb/fog_active.vdb";
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(name);
    REQUIRE(node);
    CHECK(node->getBound().valid());
    CHECK((node->getBound().center() - osg::Vec3(20.5f, -30.5f, 13.0f) * 0.125f).length() < 0.01f);
    CHECK(osgDB::readRefObjectFile(name));
    CHECK(vdbPlugin()->readNode("smoke.exr", nullptr).status() ==
          osgDB::ReaderWriter::ReadResult::FILE_NOT_HANDLED);
    CHECK(vdbPlugin()->readNode("no_such_file.vdb", nullptr).status() ==
          osgDB::ReaderWriter::ReadResult::FILE_NOT_FOUND);
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "folder.vdb");
    CHECK_FALSE(vdbPlugin()->readNode(folder / "folder.vdb", nullptr).success());
}

TEST_CASE("vdb: every truncated file is an error with a message", "[vdb]")
{
    for (const std::string& name : readableFiles())
    {
        const std::string file = vdbFile(name);
        REQUIRE(readVdb(file, "maxVoxels=1000").success());
        // Of the values of nodes a few places are enough, and of others all.
        for (std::size_t length = 0; length < file.size(); length += length < 1500 ? 1 : 97)
        {
            INFO(name << ", " << length << " of " << file.size() << " bytes");
            auto result = readVdb(file.substr(0, length), "maxVoxels=1000");
            // The grid that is read may end before the file does.
            if (name == "fog_blosc" && result.success()) continue;
            REQUIRE(result.status() == osgDB::ReaderWriter::ReadResult::ERROR_IN_READING_FILE);
            REQUIRE_FALSE(result.message().empty());
        }
    }
}

TEST_CASE("vdb: what a file says that cannot be is named", "[vdb]")
{
    const std::string sound = vdbFile("fog_active");
    const auto changed = [&sound](std::size_t at, std::uint32_t value)
    {
        std::string file = sound;
        put(file, at, value);
        return messageOf(file);
    };
    using Catch::Matchers::Contains;
    CHECK_THAT(messageOf(""), Contains("no OpenVDB file"));
    CHECK_THAT(messageOf(std::string(1 << 20, 'x')), Contains("no OpenVDB file"));
    CHECK_THAT(changed(8, 221), Contains("version 221"));
    CHECK_THAT(changed(8, 226), Contains("version 226"));
    CHECK_THAT(changed(20, 0), Contains("as a stream"));
    CHECK_THAT(changed(57, 0xffffffffu), Contains("ends too early")); // the number of metadata
    CHECK_THAT(changed(61, 0), Contains("no grids"));
    CHECK_THAT(changed(placeOfGrid(sound), 0x7fffffff), Contains("ends too early"));
    const auto renamed = [&sound](const std::string& from, const std::string& to)
    {
        std::string file = sound;
        const std::size_t at = file.find(from);
        REQUIRE(at != std::string::npos);
        return messageOf(file.replace(at, from.size(), to));
    };
    CHECK_THAT(renamed("Tree_float_5_4_3", "Tree_vec3s_5_4_3"), Contains("no grid of float"));
    CHECK_THAT(renamed("Tree_float_5_4_3", "Tree_float_5_4_2"), Contains("no grid of float"));
    CHECK_THAT(renamed("UniformScaleMap", "UniformSpaceMap"), Contains("UniformSpaceMap"));
    const std::size_t scale = sound.find("UniformScaleMap") + std::strlen("UniformScaleMap");
    CHECK_THAT(changed(scale + 4, 0x7ff00000u), Contains("singular"));
    CHECK_THAT(changed(scale + 4, 0), Contains("singular"));
    const std::size_t tree = scale + 5 * 3 * 8;
    CHECK_THAT(changed(tree, 2), Contains("several values"));
    CHECK_THAT(changed(tree + 8, 0xfffffff0u), Contains("two nodes are at one")); // tiles
    CHECK_THAT(changed(tree + 16, 8), Contains("place where none can be"));
    CHECK_THAT(changed(tree + 28 + 8192, 0x9), Contains("unknown kind"));

    if (kHasBlosc) // an array whose length is not the one that its node says
    {
        std::string level = vdbFile("level_set");
        const std::size_t map = level.find("UniformScaleMap") + std::strlen("UniformScaleMap");
        const std::size_t length = map + 5 * 3 * 8 + 28 + 8192 + 1;
        put(level, length, 0xfffffff0u);
        put(level, length + 4, 0xffffffffu);
        CHECK_THAT(messageOf(level), Contains("wrong length"));
    }

    CHECK_THAT(messageOf(sound, "maxVoxels=0"), Contains("maxVoxels"));
    CHECK_THAT(messageOf(sound, "maxVoxels=many"), Contains("maxVoxels"));
    CHECK_THAT(messageOf(sound, "extinction=-1"), Contains("extinction"));
    CHECK_THAT(messageOf(sound, "extinction=nan"), Contains("extinction"));
    CHECK(readVdb(sound, "maxVoxels=1e9 somethingElse").success());
}
