// GlossyChainsTest.cpp - more rays from one glossy surface to the next: means and noise compared
// with those of a metal that has no such rays; shadow rays; threads.
// SPDX-License-Identifier: MIT
#include "tests/Environments.h"
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kWidth = 32, kHeight = 32, kSeeds = 16;

enum class Lit
{
    FewLamps,
    ManyLamps, ///< more than offer a sample each
    Sky,
};

/// Returns balls of brushed metal close to each other. A metal with a trace of something else has
/// no further rays, and looks the same to 1e-5.
std::shared_ptr<const TracedScene> balls(Lit light, bool allMetal)
{
    SceneBuilder builder;
    builder.add(quadMesh({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), lambert(Vec3(0.1f)));
    Material metal = mirror(Vec3(1.0f, 0.8f, 0.4f));
    metal.roughness = 0.2f;
    metal.metallic = allMetal ? 1.0f : 1.0f - 1e-6f;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            builder.add(sphereMesh({0.8f * float(x), 0.8f * float(y), 0.4f}, 0.38f, 32), metal);
    const int lamps = light == Lit::Sky ? 0 : light == Lit::FewLamps ? 2 : 12;
    for (int i = 0; i < lamps; ++i)
    {
        const float angle = 6.2831853f * float(i) / float(lamps);
        builder.addQuadLight({2 * std::cos(angle), 2 * std::sin(angle), 3}, {0, 0.6f, 0},
                             {0.6f, 0, 0}, Vec3(24.0f / float(lamps)));
    }
    if (light == Lit::Sky)
        builder.addLight(environmentLight(newEnvironment(
            32, 16, [](Vec3d d) { return Vec3(d.z > 0.9   ? 20.0f
                                              : d.z > 0.0 ? 0.5f
                                                          : 0.0f); })));
    return builder.build();
}

View ballsView(int width = kWidth, int height = kHeight)
{
    return perspectiveView({0, -3, 2.6}, {0, 0, 0.3}, {0, 0, 1}, 40.0, width, height);
}

/// The mean of all pixels by seed, and the mean over all pixels of the variance among the seeds.
struct Pictures
{
    Estimate mean;
    double variance = 0.0;
};

Pictures pictures(const std::shared_ptr<const TracedScene>& traced, int passes)
{
    Pictures result;
    std::vector<double> sums(kWidth * kHeight), squares(kWidth * kHeight);
    for (uint32_t seed = 0; seed < kSeeds; ++seed)
    {
        const Picture picture =
            render(traced, ballsView(), optionsOf(IntegratorKind::Path, 6, seed), passes);
        REQUIRE(picture.progress.droppedSamples == 0);
        result.mean.add(double(picture.mean().y));
        for (std::size_t p = 0; p < sums.size(); ++p)
        {
            const double value = double(picture.rgba[4 * p + 1]);
            sums[p] += value;
            squares[p] += value * value;
        }
    }
    for (std::size_t p = 0; p < sums.size(); ++p)
        result.variance += (squares[p] - sums[p] * sums[p] / kSeeds) / (kSeeds - 1);
    result.variance /= double(sums.size());
    return result;
}

} // namespace

TEST_CASE("glossy chains: further rays change the noise, and not the mean",
          "[integrators][statistics][long]")
{
    for (const Lit light : {Lit::FewLamps, Lit::ManyLamps, Lit::Sky})
    {
        const auto metal = balls(light, true), other = balls(light, false);
        REQUIRE(metal->traits().glossy);
        REQUIRE(!other->traits().glossy);
        REQUIRE((metal->lights().tree() != nullptr) == (light == Lit::ManyLamps));
        const Pictures with = pictures(metal, 64), without = pictures(other, 64);
        const double error = std::hypot(with.mean.standardError(), without.mean.standardError());
        CAPTURE(int(light), with.mean.mean(), without.mean.mean(), error, with.variance,
                without.variance);
        CHECK(std::abs(with.mean.mean() - without.mean.mean()) < 4.0 * error); // false alarm: 1e-3
        CHECK(error < 0.015 * without.mean.mean());
        CHECK(with.variance < 0.9 * without.variance); // 0.82, 0.80, 0.70
    }
}

TEST_CASE("glossy chains: few shadow rays go to lamps whose highlights are elsewhere",
          "[integrators]")
{
    // The eye sees nothing but metal below two lamps, each surface of which asks for one of them.
    SceneBuilder builder;
    Material metal = mirror(Vec3(0.9f));
    metal.roughness = 0.2f;
    builder.add(sphereMesh({0, 0, 0}, 4.0f, 32), metal);
    for (const float x : {-1.0f, 1.0f})
        builder.addQuadLight({x, 0, 3}, {0, 0.3f, 0}, {0.3f, 0, 0}, Vec3(20.0f));
    const Picture picture =
        render(builder.build(), perspectiveView({0, -3, 0}, {0, 0, 0}, {0, 0, 1}, 40.0, 16, 16),
               optionsOf(IntegratorKind::Path, 6), 4);
    const auto& rays = picture.progress.rays;
    CAPTURE(rays.camera, rays.secondary, rays.shadow);
    CHECK(picture.mean().y > 0.0f);
    CHECK(rays.shadow > rays.camera / 2); // what the eye sees has all of its own
    CHECK(rays.shadow < rays.camera + rays.secondary / 5);
}

TEST_CASE("glossy chains: pictures are equal for any number of threads", "[integrators]")
{
    const auto traced = balls(Lit::FewLamps, true);
    const View view = ballsView(48, 40);
    const RenderOptions options = optionsOf(IntegratorKind::Path, 6);
    const Picture one = render(traced, view, options, 3, 1);
    CHECK(one.mean().y > 0.0f);
    for (const int threads : {2, 16})
        CHECK(render(traced, view, options, 3, threads).rgba == one.rgba);
}
