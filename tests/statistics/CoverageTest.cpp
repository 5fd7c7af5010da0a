// CoverageTest.cpp - intervals of 68 and 95 % made from the two halves contain the truth as often.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/PValues.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kSize = 48, kTile = 16, kTiles = kSize / kTile;
constexpr int kSeeds = 250;

/// A sum of independent errors, estimated from the halves of each. The degrees of freedom of such
/// an estimate are those of Satterthwaite, An Approximate Distribution of Estimates of Variance
/// Components, 1946.
struct Interval
{
    double mean = 0.0;
    double variance = 0.0; ///< of the mean
    double fourths = 0.0;  ///< sum of squares of the variance's terms

    double degrees() const
    {
        // A squared normal error has a fourth moment of 3 variances squared.
        return fourths > 0.0 ? 3.0 * variance * variance / fourths : 1.0;
    }
};

/// Returns the green of each tile; its error follows from the channel that holds each pixel's
/// error.
std::vector<Interval> tileIntervals(const RenderSession& session)
{
    const std::vector<float> image = session.resolveRadiance(),
                             errors = session.resolveChannel(Channel::Error);
    std::vector<Interval> tiles(kTiles * kTiles);
    for (int pixel = 0; pixel < kSize * kSize; ++pixel)
    {
        const int x = pixel % kSize, y = pixel / kSize;
        Interval& tile = tiles[static_cast<std::size_t>(y / kTile * kTiles + x / kTile)];
        const double share = 1.0 / (kTile * kTile);
        // Only green is used, because the channels of a pixel share their samples.
        const double error = errors[static_cast<std::size_t>(3 * pixel + 1)] * share;
        tile.mean += image[static_cast<std::size_t>(4 * pixel + 1)] * share;
        tile.variance += error * error;
        tile.fourths += error * error * error * error;
    }
    return tiles;
}

/// Returns the interval of the whole image from those of its tiles.
Interval wholeOf(const std::vector<Interval>& tiles)
{
    Interval whole;
    const double share = 1.0 / static_cast<double>(tiles.size());
    for (const Interval& tile : tiles)
    {
        whole.mean += tile.mean * share;
        whole.variance += tile.variance * share * share;
        whole.fourths += tile.fourths * share * share * share * share;
    }
    return whole;
}

struct Coverage
{
    int trials = 0, in68 = 0, in95 = 0;

    void add(const Interval& interval, const Interval& truth)
    {
        add((interval.mean - truth.mean) / std::sqrt(interval.variance + truth.variance),
            interval.degrees());
    }

    /// z: the distance from the truth in standard errors, which are estimated with these degrees
    /// of freedom.
    void add(double z, double degrees)
    {
        const double p = studentTail(z, degrees);
        ++trials;
        in68 += p > 1.0 - 0.6827;
        in95 += p > 0.05;
    }

    double share68() const { return double(in68) / trials; }
    double share95() const { return double(in95) / trials; }
};

/// Checks a share of trials, which is binomial, by 3.9 sigma: a false alarm in 10 000 for each
/// check.
void checkShare(double share, double claimed, int trials)
{
    const double spread = std::sqrt(claimed * (1.0 - claimed) / trials);
    CAPTURE(share, claimed, spread);
    CHECK(std::abs(share - claimed) < 3.9 * spread);
}

void checkShares(const Coverage& coverage)
{
    checkShare(coverage.share68(), 0.6827, coverage.trials);
    checkShare(coverage.share95(), 0.95, coverage.trials);
}

/// A session that renders the same view with one seed after the other, some passes and then more.
class SeededSession
{
public:
    SeededSession(const std::shared_ptr<const TracedScene>& traced, const View& view,
                  const RenderOptions& options)
        : _options(options)
    {
        _session.setScene(traced);
        _session.setView(view);
    }

    void begin(uint32_t seed)
    {
        _options.seed = seed;
        _session.setOptions(_options);
    }

    /// Makes what the seed lacks of some passes.
    const RenderSession& renderTo(int passes)
    {
        StopRule rule;
        rule.passes = passes;
        REQUIRE(_session.render(rule).passes == passes);
        return _session;
    }

private:
    RenderSession _session{std::make_shared<Workers>()};
    RenderOptions _options;
};

constexpr uint32_t kTrueSeed = 99999;

/// Checks the intervals after some numbers of passes, the largest last.
void checkCoverage(const std::shared_ptr<const TracedScene>& traced, const View& view,
                   const RenderOptions& options, const std::vector<int>& passes)
{
    SeededSession session(traced, view, options);
    session.begin(kTrueSeed);
    const std::vector<Interval> truth = tileIntervals(session.renderTo(128 * passes.back()));

    std::vector<Coverage> tiles(passes.size()), whole(passes.size());
    for (uint32_t seed = 0; seed < kSeeds; ++seed)
    {
        session.begin(seed);
        for (std::size_t k = 0; k < passes.size(); ++k)
        {
            const std::vector<Interval> intervals = tileIntervals(session.renderTo(passes[k]));
            for (std::size_t i = 0; i < intervals.size(); ++i)
                if (intervals[i].variance > 0.0) tiles[k].add(intervals[i], truth[i]);
            whole[k].add(wholeOf(intervals), wholeOf(truth));
        }
    }
    for (std::size_t k = 0; k < passes.size(); ++k)
    {
        CAPTURE(passes[k], int(options.integrator), int(options.lightSampling), tiles[k].trials,
                tiles[k].share68(), tiles[k].share95(), whole[k].share68(), whole[k].share95());
        CHECK(tiles[k].trials > kSeeds * kTiles);
        checkShares(tiles[k]);
        checkShares(whole[k]);
    }
}

/// The green of one pixel of each tile: pixels of different tiles have camera paths of their own,
/// whatever the integrator.
struct PixelEstimate
{
    double mean, error;
};

std::vector<PixelEstimate> pixelEstimates(const RenderSession& session)
{
    const std::vector<float> image = session.resolveRadiance(),
                             errors = session.resolveChannel(Channel::Error);
    std::vector<PixelEstimate> pixels;
    for (int tile = 0; tile < kTiles * kTiles; ++tile)
    {
        const int x = tile % kTiles * kTile + 5, y = tile / kTiles * kTile + 9;
        const auto pixel = static_cast<std::size_t>(y * kSize + x);
        pixels.push_back({double(image[4 * pixel + 1]), double(errors[3 * pixel + 1])});
    }
    return pixels;
}

/// Checks the intervals of single pixels: the two halves of a pixel give one degree of freedom.
void checkPixelCoverage(const std::shared_ptr<const TracedScene>& traced, const View& view,
                        const RenderOptions& options, const std::vector<int>& passes)
{
    SeededSession session(traced, view, options);
    session.begin(kTrueSeed);
    const std::vector<PixelEstimate> truth = pixelEstimates(session.renderTo(128 * passes.back()));

    std::vector<Coverage> coverage(passes.size());
    for (uint32_t seed = 0; seed < kSeeds; ++seed)
    {
        session.begin(seed);
        for (std::size_t k = 0; k < passes.size(); ++k)
        {
            const std::vector<PixelEstimate> pixels = pixelEstimates(session.renderTo(passes[k]));
            for (std::size_t i = 0; i < pixels.size(); ++i)
                coverage[k].add((pixels[i].mean - truth[i].mean) / pixels[i].error, 1.0);
        }
    }
    for (std::size_t k = 0; k < passes.size(); ++k)
    {
        CAPTURE(passes[k], int(options.integrator), coverage[k].trials);
        checkShares(coverage[k]);
    }
}

/// Checks integrators with photons: the truth is the expectation of the image after that many
/// passes, taken as the mean over all seeds. The halves of an image cannot tell how far it is from
/// the light itself, because photons are looked up in discs.
void checkPhotonCoverage(const std::shared_ptr<const TracedScene>& traced, const View& view,
                         const RenderOptions& options, const std::vector<int>& passes)
{
    SeededSession session(traced, view, options);
    std::vector<std::vector<std::vector<PixelEstimate>>> seeds(passes.size());
    for (uint32_t seed = 0; seed < kSeeds; ++seed)
    {
        session.begin(seed);
        for (std::size_t k = 0; k < passes.size(); ++k)
            seeds[k].push_back(pixelEstimates(session.renderTo(passes[k])));
    }
    for (std::size_t k = 0; k < passes.size(); ++k)
    {
        std::vector<double> truth(kTiles * kTiles, 0.0);
        for (const std::vector<PixelEstimate>& pixels : seeds[k])
            for (std::size_t i = 0; i < truth.size(); ++i)
                truth[i] += pixels[i].mean / kSeeds;
        Coverage coverage;
        for (const std::vector<PixelEstimate>& pixels : seeds[k])
            for (std::size_t i = 0; i < truth.size(); ++i)
                coverage.add((pixels[i].mean - truth[i]) / pixels[i].error, 1.0);
        CAPTURE(passes[k], int(options.integrator), coverage.trials);
        checkShares(coverage);
    }
}

View withoutLight()
{
    return perspectiveView({278, 400, 20}, {278, 100, 559}, {0, 1, 0}, 45.0, kSize, kSize);
}

/// Returns a box whose colours could change from point to point, so that no paths are reused.
SceneBuilder boxWithoutReuse()
{
    SceneBuilder box = cornellBox();
    for (Material& material : box.scene->materials)
    {
        if (material.emission != Vec3(0.0f)) continue;
        const Vec3 albedo = material.baseColor;
        material = Material();
        material.diffuse = albedo;
        material.vertexColorUse = VertexColorUse::Ambient;
    }
    return box;
}

} // namespace

TEST_CASE("coverage: path tracing with Sobol points", "[statistics]")
{
    // Pixels of a tile share paths: the error of each pixel is known, but not that of their sum.
    checkPixelCoverage(cornellBox().build(), withoutLight(), optionsOf(IntegratorKind::Path, 4),
                       {4, 5, 16});
}

TEST_CASE("coverage: path tracing whose pixels share nothing", "[statistics]")
{
    checkCoverage(boxWithoutReuse().build(), withoutLight(), optionsOf(IntegratorKind::Path, 4),
                  {4, 5, 16});
}

TEST_CASE("coverage: photons, seen by paths that glossy surfaces spread", "[statistics]")
{
    // On a glossy floor, most of the noise of pixels is that of camera paths, which passes of PPM
    // share.
    SceneBuilder box = cornellBox();
    Material glossy = mirror(Vec3(0.9f));
    glossy.roughness = 0.45f;
    box.add(quadMesh({549, 1, 1}, {-548, 0, 0}, {0, 0, 557}), glossy);
    const auto traced = box.build();
    for (const IntegratorKind kind : {IntegratorKind::Ppm, IntegratorKind::Sppm})
    {
        RenderOptions options = optionsOf(kind, 4);
        options.photons = 3000;
        checkPhotonCoverage(traced, withoutLight(), options, {4, 5, 16, 40});
    }
}

TEST_CASE("coverage: Whitted's ray tracer with Sobol points", "[statistics]")
{
    RenderOptions options = optionsOf(IntegratorKind::Whitted);
    options.lightSamples = 1;
    checkCoverage(cornellBox().build(), withoutLight(), options, {4, 9, 32});
}

TEST_CASE("coverage: the other light strategies", "[statistics]")
{
    RenderOptions options = optionsOf(IntegratorKind::Whitted);
    for (const LightSampling strategy :
         {LightSampling::Random, LightSampling::UniformJitter, LightSampling::Stratified})
    {
        options.lightSampling = strategy;
        checkCoverage(cornellBox().build(), withoutLight(), options, {8});
    }
}

TEST_CASE("coverage: with the light's edges in view", "[statistics]")
{
    // The few pixels along the edges make the error of their tile. Whitted's ray tracer has no
    // other noise there, so it takes more passes until this error is normally distributed.
    checkCoverage(boxWithoutReuse().build(), cornellView(kSize, kSize),
                  optionsOf(IntegratorKind::Path, 4), {16});
    checkCoverage(cornellBox().build(), cornellView(kSize, kSize),
                  optionsOf(IntegratorKind::Whitted), {64});
}
