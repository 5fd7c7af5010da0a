// VdbFuzzTest.cpp - damaged .vdb files give a tile or an error, and take memory within reason.
// Layer: tests.
// SPDX-License-Identifier: MIT
#include "CountedMemory.h"
#include "FuzzSeeds.h"
#include "tests/plugins/VdbSamples.h"

#include <osg/Notify>

#include <cstring>
#include <set>

using namespace osgRayTrace::test;

namespace
{

constexpr int kFiles = 40000; ///< seeds

/// The plugin may take the file, a list of its leaves and 4 bytes a voxel, of which there are few.
constexpr std::size_t kMostBytes = std::size_t(8) << 20;
const std::string kFewVoxels = "maxVoxels=100000 ";

/// Puts a number that is unlikely to be right where one is likely to stand: in front of the nodes,
/// or just behind a name.
void editNumber(std::string& file, Dice& dice)
{
    constexpr std::uint32_t kNumbers[] = {0u,          1u,          2u,          3u,
                                          7u,          8u,          255u,        4096u,
                                          0xfffff000u, 0x00010000u, 0x7fffffffu, 0x80000000u,
                                          0xffffffffu, 0xfffffff0u, 0x7ff00000u, 0x3ff00000u};
    constexpr int kHead = 1600; ///< bytes before the nodes
    const auto at =
        static_cast<std::size_t>(dice.oneIn(4) ? dice.below(int(file.size())) : dice.below(kHead));
    const std::uint32_t number = dice.oneOf(kNumbers);
    if (at + sizeof number <= file.size()) std::memcpy(&file[at], &number, sizeof number);
}

/// Changes bytes anywhere, or in the last quarter, where the values of leaves are.
void editNodes(std::string& file, Dice& dice)
{
    const int size = static_cast<int>(file.size()), from = dice.oneIn(2) ? 0 : size - size / 4;
    for (int i = 1 + dice.below(8); i > 0; --i)
    {
        const auto at = static_cast<std::size_t>(from + dice.below(size - from));
        file[at] =
            static_cast<char>(dice.oneIn(2) ? dice.below(256) : file[at] ^ 1 << dice.below(8));
    }
}

void damage(std::string& file, Dice& dice)
{
    const int way = dice.below(kDamages + 4);
    if (way < kDamages)
        damageBytes(file, way, dice);
    else
        way % 2 ? editNumber(file, dice) : editNodes(file, dice);
}

} // namespace

TEST_CASE("fuzz: a damaged .vdb file gives an error or a tile, and no absurd allocation", "[fuzz]")
{
    osg::setNotifyLevel(osg::FATAL);
    vdbPlugin();
    std::vector<std::string> files;
    for (const std::string name : kVdbFiles)
        files.push_back(vdbFile(name));
    int tiles = 0, errors = 0;
    std::set<std::string> messages;
    forEachSeed(kFiles,
                [&](uint32_t seed)
                {
                    Dice dice(seed);
                    std::string file =
                        files[static_cast<std::size_t>(dice.below(int(files.size())))];
                    for (int i = 1 + dice.below(3); i > 0 && !file.empty(); --i)
                        damage(file, dice);
                    const char* const kOptions[] = {"", "", "grid=flame", "grid=shared", "yUp"};
                    const std::string options = kFewVoxels + dice.oneOf(kOptions);
                    takeMemoryPeak();
                    auto result = readVdb(file, options);
                    const MemoryPeak peak = takeMemoryPeak();
                    CAPTURE(peak.single, file.size());
                    REQUIRE(peak.total < kMostBytes);
                    if (!result.success())
                    {
                        ++errors;
                        REQUIRE_FALSE(result.message().empty());
                        messages.insert(result.message());
                        return;
                    }
                    ++tiles;
                    auto* tile = dynamic_cast<osgVolume::VolumeTile*>(result.getNode());
                    REQUIRE(tile);
                    const osg::Image& image = *layerOf(*tile).getImage();
                    const auto* values = reinterpret_cast<const float*>(image.data());
                    for (unsigned int i = 0; i < image.getTotalSizeInBytes() / sizeof(float); ++i)
                        if (!std::isfinite(values[i])) FAIL("value " << i << " is " << values[i]);
                    REQUIRE(tile->getLocator()->getTransform().valid());
                });
    // The damage is neither always fatal nor never, and there are many ways to be wrong. Without
    // blosc most of the files cannot be read at all.
#ifdef OSGRAYTRACE_TEST_BLOSC
    CHECK(tiles > seedCount(kFiles) / 25);
#else
    CHECK(tiles > seedCount(kFiles) / 100);
#endif
    CHECK(errors > seedCount(kFiles) / 4);
    CHECK(messages.size() > 8);
}
