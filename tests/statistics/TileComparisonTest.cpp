// TileComparisonTest.cpp - different estimators of the same light, compared tile by tile on ten
// scenes with Welch's test (Jung, Hanika, Dachsbacher, JCGT 9(2), 2020).
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/PValues.h"
#include "tests/statistics/ReferenceTracer.h"
#include "tests/statistics/TenScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSize = 32, kTile = 8, kTiles = kSize / kTile;
constexpr int kRuns = 16;

using TileMeans =
    std::vector<Estimate>; ///< a tile, and last the whole image; one value for each run

/// Adds a run to the means. Only green is used, because the channels of a path share its
/// directions, and p-values must be independent.
template <class At> void addRun(TileMeans& means, const At& at)
{
    means.resize(kTiles * kTiles + 1);
    double whole = 0.0;
    for (int tile = 0; tile < kTiles * kTiles; ++tile)
    {
        double sum = 0.0;
        for (int i = 0; i < kTile * kTile; ++i)
            sum += at(tile % kTiles * kTile + i % kTile, tile / kTiles * kTile + i / kTile);
        means[static_cast<std::size_t>(tile)].add(sum / (kTile * kTile));
        whole += sum / (kSize * kSize);
    }
    means.back().add(whole);
}

TileMeans rendered(const ComparedScene& scene, RenderOptions options, int passes,
                   uint32_t firstSeed)
{
    TileMeans means;
    for (uint32_t run = 0; run < kRuns; ++run)
    {
        options.seed = firstSeed + run;
        const Picture picture = render(scene.traced, scene.view, options, passes);
        REQUIRE(picture.progress.droppedSamples == 0);
        addRun(means, [&](int x, int y) { return double(picture.at(x, y).y); });
    }
    return means;
}

TileMeans referenced(const ComparedScene& scene, int maxBounces, int paths)
{
    TileMeans means;
    for (uint32_t run = 0; run < kRuns; ++run)
    {
        const std::vector<double> image =
            tracePaths(*scene.traced, scene.view, maxBounces, paths, run);
        addRun(means, [&](int x, int y)
               { return image[static_cast<std::size_t>(3 * (y * kSize + x) + 1)]; });
    }
    return means;
}

/// Collects the p-values of a family of comparisons.
class Family
{
public:
    void compare(const std::string& name, const TileMeans& a, const TileMeans& b)
    {
        for (std::size_t tile = 0; tile < a.size(); ++tile)
        {
            const bool certain = a[tile].variance() == 0.0 && b[tile].variance() == 0.0;
            const bool whole = tile + 1 == a.size(); // depends on the tiles
            const double p = welchTest(a[tile], kRuns, b[tile], kRuns, 1e-6);
            _tests.push_back({name, tile, p, a[tile].mean(), b[tile].mean()});
            if (!certain && !whole) _values.push_back(p);
        }
    }

    /// Checks that no tile and no image differs, at 1 % in all (Sidak), and that the p-values are
    /// uniform (Kolmogorov-Smirnov, 1 %).
    void check() const
    {
        const double significance = sidak(0.01, static_cast<int>(_tests.size()));
        for (const Test& test : _tests)
        {
            CAPTURE(test.name, test.tile, test.a, test.b, test.p);
            CHECK(test.p > significance);
        }
        const double uniform = kolmogorovSmirnovTest(_values);
        CAPTURE(_values.size(), uniform);
        CHECK(uniform > 0.01);
    }

private:
    struct Test
    {
        std::string name;
        std::size_t tile;
        double p, a, b;
    };
    std::vector<Test> _tests;
    std::vector<double> _values;
};

} // namespace

TEST_CASE("tiles: path tracing against the reference tracer without light sampling", "[statistics]")
{
    Family family;
    for (const ComparedScene& scene : tenScenes(kSize, kSize))
        family.compare(scene.name, rendered(scene, optionsOf(IntegratorKind::Path, 4), 64, 1000),
                       referenced(scene, 4, 256));
    family.check();
}

TEST_CASE("tiles: direct light of Whitted's ray tracer against path tracing of one bounce",
          "[statistics]")
{
    // Each scene has another strategy of sampling its lights.
    const LightSampling strategies[] = {LightSampling::Sobol, LightSampling::Random,
                                        LightSampling::UniformJitter, LightSampling::Stratified};
    Family family;
    std::size_t index = 0;
    for (const ComparedScene& scene : tenScenes(kSize, kSize))
    {
        if (scene.mirrors) continue;
        RenderOptions options = optionsOf(IntegratorKind::Whitted, 1);
        options.lightSampling = strategies[index++ % 4];
        family.compare(scene.name, rendered(scene, options, 16, 2000),
                       rendered(scene, optionsOf(IntegratorKind::Path, 1), 64, 3000));
    }
    CHECK(index == 8);
    family.check();
}
