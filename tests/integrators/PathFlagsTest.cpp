// PathFlagsTest.cpp - what a path remembers of the surfaces that it has met.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/path/PathFlags.h"

#include "tests/Catch.h"

using namespace osgRayTrace::engine;

namespace
{

constexpr uint32_t kYes = 0xffffffffu, kNo = 0u;
constexpr uint32_t kPixel = 137;

struct Lobe
{
    uint32_t gathering, rough, mirrored, carried = kNo;
};

constexpr Lobe kDiffuse{kYes, kYes, kNo};
constexpr Lobe kGlossy{kYes, kNo, kNo};
constexpr Lobe kDiffuseWithoutPhotons{kNo, kNo, kNo};
constexpr Lobe kMirror{kNo, kNo, kYes};

/// The path of a pixel after these surfaces.
PathFlags pathAfter(std::initializer_list<Lobe> lobes)
{
    uint32_t word = PathFlags::ofPixel(kPixel).word();
    for (const Lobe& lobe : lobes)
        word =
            PathFlags::afterSurface(word, lobe.gathering, lobe.rough, lobe.carried, lobe.mirrored);
    return PathFlags(word);
}

} // namespace

TEST_CASE("a path of a pixel keeps its pixel, reused or not, and reused paths have sums apart",
          "[path]")
{
    const PathFlags path = pathAfter({kDiffuse, kMirror, kDiffuseWithoutPhotons});
    CHECK(path.pixel() == kPixel);
    CHECK(path.sum() == kPixel);
    CHECK_FALSE(path.isReused());
    CHECK(path.reused().isReused());
    CHECK(path.reused().pixel() == kPixel);
    CHECK(path.reused().sum() == kPixel + kTilePixels);
    CHECK(path.reused().isScattered());
    CHECK(path.reused().hasTaken());
}

TEST_CASE("mirrors alone neither scatter a path nor bring it onto a caustic chain", "[path]")
{
    const PathFlags path = pathAfter({kMirror, kMirror});
    CHECK(path.word() == PathFlags::ofPixel(kPixel).word());
}

TEST_CASE("a path is on a caustic chain once it meets mirrors behind a surface that photons know",
          "[path]")
{
    CHECK_FALSE(pathAfter({kDiffuse}).isOnCausticChain());
    CHECK(pathAfter({kDiffuse, kMirror}).isOnCausticChain());
    CHECK(pathAfter({kDiffuse, kMirror, kMirror}).isOnCausticChain());
    CHECK(pathAfter({kGlossy, kMirror}).isOnCausticChain());
    CHECK_FALSE(pathAfter({kDiffuseWithoutPhotons, kMirror}).isOnCausticChain());
    // Any surface that scatters ends the chain; behind a rough one photons know the next, too.
    CHECK_FALSE(pathAfter({kDiffuse, kMirror, kDiffuseWithoutPhotons}).isOnCausticChain());
    CHECK(pathAfter({kDiffuse, kDiffuseWithoutPhotons, kMirror}).isOnCausticChain());
    CHECK_FALSE(pathAfter({kGlossy, kDiffuseWithoutPhotons, kMirror}).isOnCausticChain());
}

TEST_CASE("photons carry what a glossy surface casts, also by way of mirrors", "[path]")
{
    constexpr Lobe kCaster{kNo, kNo, kNo, kYes}, kCoat{kNo, kNo, kYes, kYes};
    CHECK(pathAfter({kDiffuse, kCaster}).isOnCausticChain());
    CHECK(pathAfter({kDiffuse, kCoat}).isOnCausticChain());
    CHECK(pathAfter({kDiffuse, kCaster, kMirror}).isOnCausticChain());
    CHECK(pathAfter({kDiffuse, kDiffuseWithoutPhotons, kCaster}).isOnCausticChain());
    CHECK_FALSE(pathAfter({kDiffuse, kCaster, kDiffuseWithoutPhotons}).isOnCausticChain());
    CHECK(pathAfter({kDiffuse, kCaster}).isScattered());
}

TEST_CASE("photons are taken at rough surfaces only, and once for all", "[path]")
{
    CHECK_FALSE(pathAfter({kMirror}).hasTaken());
    CHECK_FALSE(pathAfter({kGlossy}).hasTaken());
    CHECK(pathAfter({kMirror, kDiffuse}).hasTaken());
    CHECK(pathAfter({kDiffuse, kMirror, kDiffuseWithoutPhotons}).hasTaken());
    CHECK(pathAfter({kGlossy}).isScattered());
}

TEST_CASE("behind a collision that looked up caustics, mirrors lead onto a chain and photons are "
          "still wanted",
          "[path]")
{
    const PathFlags path = PathFlags::ofPixel(kPixel).collidedAmongCaustics();
    CHECK(path.hasCollided());
    CHECK_FALSE(path.hasTaken());
    CHECK_FALSE(path.isOnCausticChain());
    const auto after = [](PathFlags flags, const Lobe& lobe)
    {
        return PathFlags(PathFlags::afterSurface(flags.word(), lobe.gathering, lobe.rough,
                                                 lobe.carried, lobe.mirrored));
    };
    CHECK(after(path, kMirror).isOnCausticChain());
    CHECK_FALSE(after(after(path, kDiffuseWithoutPhotons), kMirror).isOnCausticChain());
    CHECK(after(path, kDiffuse).hasTaken());
    CHECK(pathAfter({kDiffuse}).collidedAmongCaustics().hasTaken());
}
