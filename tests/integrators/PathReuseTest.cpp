// PathReuseTest.cpp - paths that pixels share change the noise, and nothing else.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kPixels = 32;
constexpr int kRegion = 4; ///< pixels a side of a compared region
constexpr int kRegions = kPixels / kRegion;

/// Returns the same surface, but one whose paths are not reused, because its colour could change
/// from point to point.
Material varying(const Material& diffuse)
{
    Material material;
    material.diffuse = diffuse.baseColor;
    material.vertexColorUse = VertexColorUse::Ambient;
    return material;
}

/// Returns the Cornell box in which every step-th material is varying.
std::shared_ptr<const TracedScene> boxWith(std::size_t step)
{
    const SceneBuilder box = cornellBox();
    std::vector<Material>& materials = box.scene->materials;
    for (std::size_t i = 0; i < materials.size(); i += step)
        if (materials[i].emission == Vec3(0.0f)) materials[i] = varying(materials[i]);
    return box.build();
}

struct Measured
{
    std::vector<Estimate> regions; ///< radiance of each region, all channels
    std::vector<Estimate> pixels;

    /// Returns a relative variance as relMSE defines it; an absolute one would come from the pixels
    /// at the light's edge alone.
    double relativeVariance() const
    {
        double sum = 0.0;
        for (const Estimate& pixel : pixels)
            sum += pixel.variance() / (pixel.mean() * pixel.mean() + 0.01);
        return sum;
    }
};

/// Measures the box over 24 seeds. There are so many passes that the sums of regions are nearly
/// normal: with a quarter of them the largest of 192 differences of equal means was once 5.02
/// standard errors.
Measured measureBox(const std::shared_ptr<const TracedScene>& traced, uint32_t firstSeed)
{
    Measured measured;
    measured.regions.resize(kRegions * kRegions * 3);
    measured.pixels.resize(kPixels * kPixels * 3);
    RenderOptions options = optionsOf(IntegratorKind::Path, 20);
    for (uint32_t seed = 0; seed < 24; ++seed)
    {
        options.seed = firstSeed + seed;
        const Picture picture = render(traced, cornellView(kPixels, kPixels), options, 96);
        REQUIRE(picture.progress.droppedSamples == 0);
        std::vector<double> sums(measured.regions.size(), 0.0);
        for (int y = 0; y < kPixels; ++y)
        {
            for (int x = 0; x < kPixels; ++x)
            {
                const int region = y / kRegion * kRegions + x / kRegion;
                for (int c = 0; c < 3; ++c)
                {
                    const double radiance = double(picture.at(x, y)[c]);
                    sums[std::size_t(region * 3 + c)] += radiance;
                    measured.pixels[std::size_t((y * kPixels + x) * 3 + c)].add(radiance);
                }
            }
        }
        for (std::size_t i = 0; i < sums.size(); ++i)
            measured.regions[i].add(sums[i]);
    }
    return measured;
}

/// Returns the largest difference of two means in standard errors.
double largestDifference(const std::vector<Estimate>& a, const std::vector<Estimate>& b)
{
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        const double error = std::hypot(a[i].standardError(), b[i].standardError());
        if (error > 0.0) largest = std::max(largest, std::abs(a[i].mean() - b[i].mean()) / error);
    }
    return largest;
}

double sumOf(const std::vector<Estimate>& regions)
{
    double sum = 0.0;
    for (const Estimate& region : regions)
        sum += region.mean();
    return sum;
}

} // namespace

TEST_CASE("path reuse: the same light in all parts of the Cornell box, with less noise",
          "[integrators][statistics][long]")
{
    const Measured own = measureBox(boxWith(1), 100);
    const Measured reused = measureBox(boxWith(1000), 200);
    const Measured mixed = measureBox(boxWith(2), 300);

    // There are 192 differences with about 46 degrees of freedom: a false alarm, which is one
    // beyond 5, has a probability of 0.2 %.
    CHECK(largestDifference(own.regions, reused.regions) < 5.0);
    CHECK(largestDifference(own.regions, mixed.regions) < 5.0);
    // The bound is six standard errors.
    CHECK(sumOf(reused.regions) == Approx(sumOf(own.regions)).epsilon(0.004));
    CHECK(sumOf(mixed.regions) == Approx(sumOf(own.regions)).epsilon(0.004));

    // The variance is about a half here, where pixels are far apart and share little; it is an
    // eighth at 512 x 512.
    CHECK(reused.relativeVariance() < 0.7 * own.relativeVariance());
}
