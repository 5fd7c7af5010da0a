// AreaLightTest.cpp - irradiance of square lights compared with Lambert's closed form, by every
// estimator.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

struct Square
{
    const char* name;
    Vec3 corner, u, v; ///< cross(u, v) points to the receiver, at the origin with its normal at +z
    double irradiance; ///< for radiance 1 [Lambert 1760]
};

const Square kSquares[] = {
    {"above", {-0.5f, -0.5f, 1}, {0, 1, 0}, {1, 0, 0}, 0.75227469},
    {"shifted", {0.5f, -0.5f, 1}, {0, 1, 0}, {1, 0, 0}, 0.26500485},
    {"standing", {1, -0.5f, 0}, {0, 0, 1}, {0, 1, 0}, 0.22334663},
};

enum class Emitter
{
    Parallelogram,
    Mesh,
};

std::shared_ptr<const TracedScene> receiverUnder(const Square& square, Emitter emitter,
                                                 float radiance = 1.0f, float receiverSize = 1.0f)
{
    SceneBuilder builder;
    const float half = 0.5f * receiverSize;
    builder.add(quadMesh({-half, -half, 0}, {receiverSize, 0, 0}, {0, receiverSize, 0}),
                lambert(Vec3(1.0f)));
    if (emitter == Emitter::Parallelogram)
        builder.addQuadLight(square.corner, square.u, square.v, Vec3(radiance));
    else
        builder.addEmissive(quadMesh(square.corner, square.u, square.v), lamp(Vec3(radiance)));
    return builder.build();
}

View receiverView(double side = 1e-3)
{
    return patchView({0, 0, 0}, {0, 0, 1}, side, 16);
}

} // namespace

TEST_CASE("area light: irradiance by path tracing, as parallelogram and as mesh",
          "[integrators][statistics][stability 23]")
{
    for (const Square& square : kSquares)
    {
        for (const Emitter emitter : {Emitter::Parallelogram, Emitter::Mesh})
        {
            const Estimate radiance = measure(receiverUnder(square, emitter), receiverView(),
                                              optionsOf(IntegratorKind::Path, 4), 64);
            CAPTURE(square.name, int(emitter), radiance.mean() * M_PI,
                    radiance.standardError() * M_PI);
            CHECK(radiance.agrees(square.irradiance / M_PI, 2e-6));
            CHECK(radiance.standardError() < 2e-3 * square.irradiance);
        }
    }
}

TEST_CASE("area light: irradiance by Whitted's light samples, with every strategy",
          "[integrators][statistics][long][stability 23]")
{
    for (const Square& square : kSquares)
    {
        for (const Emitter emitter : {Emitter::Parallelogram, Emitter::Mesh})
        {
            const auto traced = receiverUnder(square, emitter);
            for (const LightSampling strategy :
                 {LightSampling::Random, LightSampling::UniformJitter, LightSampling::Stratified,
                  LightSampling::Sobol})
            {
                RenderOptions options = optionsOf(IntegratorKind::Whitted);
                options.lightSampling = strategy;
                options.lightSamples = 9;
                const Estimate radiance = measure(traced, receiverView(), options, 32);
                CAPTURE(square.name, int(emitter), int(strategy), radiance.mean() * M_PI,
                        radiance.standardError() * M_PI);
                CHECK(radiance.agrees(square.irradiance / M_PI, 2e-6));
                CHECK(radiance.standardError() < 1e-3 * square.irradiance);
            }
        }
    }
}

TEST_CASE("area light: a light behind its back, or below the horizon, gives nothing",
          "[integrators]")
{
    const Square turned{"", {-0.5f, -0.5f, 1}, {1, 0, 0}, {0, 1, 0}, 0.0};
    const Square below{"", {-0.5f, -0.5f, -1}, {1, 0, 0}, {0, 1, 0}, 0.0};
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        for (const Square& square : {turned, below})
        {
            const Picture picture = render(receiverUnder(square, Emitter::Parallelogram),
                                           receiverView(), optionsOf(kind), 4);
            CHECK(picture.mean() == Vec3(0.0f));
            CHECK(picture.progress.droppedSamples == 0);
        }
    }
}

TEST_CASE("area light: a two-sided light shines from its back as well", "[integrators][statistics]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(1.0f)));
    builder.addQuadLight({-0.5f, -0.5f, 1}, {1, 0, 0}, {0, 1, 0}, Vec3(1.0f), true);
    const auto traced = builder.build();
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
        CHECK(measure(traced, receiverView(), optionsOf(kind, 4), 32)
                  .agrees(0.75227469 / M_PI, 2e-6));
}

TEST_CASE("area light: very small and very distant lights are point lights",
          "[integrators][statistics][stability 25]")
{
    const Square tiny{"tiny", {-5e-7f, -5e-7f, 1}, {0, 1e-6f, 0}, {1e-6f, 0, 0}, 1.0};
    const Square distant{"distant", {-0.5f, -0.5f, 1e6f}, {0, 1, 0}, {1, 0, 0}, 1.0};
    for (const Square& square : {tiny, distant})
    {
        for (const Emitter emitter : {Emitter::Parallelogram, Emitter::Mesh})
        {
            for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
            {
                CAPTURE(square.name, int(emitter), int(kind));
                // The radiance is 1e12, so that I / d^2 = 1.
                const Estimate radiance = measure(receiverUnder(square, emitter, 1e12f),
                                                  receiverView(), optionsOf(kind, 4), 4);
                CHECK(radiance.mean() * M_PI == Approx(1.0).epsilon(1e-4));
            }
        }
    }
}

TEST_CASE("area light: a receiver next to the middle of a light gets pi L",
          "[integrators][statistics]")
{
    // Only chance hits find this light: they are weighted right only if they stay finite.
    for (const float gap : {1e-2f, 1e-4f, 1e-6f})
    {
        const Square close{"close", {-0.5f, -0.5f, gap}, {0, 1, 0}, {1, 0, 0}, M_PI};
        const double side = 1e-3 * gap;
        const View view = patchView({0, 0, 0}, {0, 0, 1}, side, 16);
        for (const Emitter emitter : {Emitter::Parallelogram, Emitter::Mesh})
        {
            const Estimate radiance = measure(receiverUnder(close, emitter, 1.0f, 0.01f), view,
                                              optionsOf(IntegratorKind::Path, 4), 32);
            const double expected =
                1.0 - 4.0 * gap * gap; // an upper bound of what is missing at the horizon
            CAPTURE(gap, int(emitter), radiance.mean(), radiance.standardError());
            CHECK(radiance.agrees(expected, 1e-3));
            CHECK(radiance.standardError() < 0.01);
        }
    }
}

TEST_CASE("area light: a receiver on the light's plane gets nothing, and no NaN", "[integrators]")
{
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        for (const bool twoSided : {false, true})
        {
            SceneBuilder builder;
            builder.add(quadMesh({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(1.0f)));
            builder.addQuadLight({1, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}, Vec3(1.0f), twoSided);
            const Picture picture = render(builder.build(), receiverView(), optionsOf(kind, 4), 8);
            CAPTURE(int(kind), twoSided);
            CHECK(picture.progress.droppedSamples == 0);
            CHECK(picture.mean().y < 1e-6f);
        }
    }
}

TEST_CASE("area light: triangles without area among the others change nothing",
          "[integrators][stability 28]")
{
    const Square& square = kSquares[0];
    const auto clean = receiverUnder(square, Emitter::Mesh);
    SceneBuilder builder;
    builder.add(quadMesh({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(1.0f)));
    const auto quad = quadMesh(square.corner, square.u, square.v);
    std::vector<Vec3> positions(quad->positions.begin(), quad->positions.end());
    builder.addEmissive(newMesh(positions, {{0, 0, 1}, {0, 1, 2}, {2, 2, 2}, {0, 2, 3}, {1, 3, 1}}),
                        lamp(Vec3(1.0f)));
    const auto dirty = builder.build();
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Picture a = render(clean, receiverView(), optionsOf(kind), 4);
        const Picture b = render(dirty, receiverView(), optionsOf(kind), 4);
        CHECK(a.rgba == b.rgba);
        CHECK(b.progress.droppedSamples == 0);
    }
}

TEST_CASE("area light: several lights of different power add up", "[integrators][statistics][long]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), lambert(Vec3(1.0f)));
    const float radiances[] = {1.0f, 20.0f, 0.1f};
    double expected = 0.0;
    for (int i = 0; i < 3; ++i)
    {
        // The shifted square goes to the other side, so that no square hides another.
        Square s = kSquares[i];
        if (i == 1) s.corner.x = -1.5f;
        if (i == 1)
            builder.addEmissive(quadMesh(s.corner, s.u, s.v), lamp(Vec3(radiances[i])));
        else
            builder.addQuadLight(s.corner, s.u, s.v, Vec3(radiances[i]));
        expected += radiances[i] * s.irradiance / M_PI;
    }
    const auto traced = builder.build();
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Estimate radiance = measure(traced, receiverView(), optionsOf(kind, 1), 128);
        CAPTURE(int(kind), radiance.mean(), expected, radiance.standardError());
        CHECK(radiance.agrees(expected, 5e-6));
    }
}

TEST_CASE("area light: found by chance or sampled, every material shows the same",
          "[integrators][statistics][long]")
{
    // A lamp in the light table is compared with a lamp that only bounces find: multiple importance
    // sampling must not change the mean. The bound is 4 standard errors of 16 seeds each.
    std::vector<std::pair<const char*, Material>> materials{{"lambert", lambert(Vec3(0.8f))},
                                                            {"rough glass", glass(1.5f, 0.5f)}};
    Material plastic = lambert(Vec3(0.8f));
    plastic.ior = 1.5f;
    plastic.roughness = 0.5f;
    materials.emplace_back("plastic", plastic);
    Material metal = mirror(Vec3(0.9f));
    metal.roughness = 0.4f;
    materials.emplace_back("metal", metal);
    Material phong;
    phong.specular = Vec3(0.6f);
    phong.shininess = 20.0f;
    materials.emplace_back("phong", phong);
    for (const auto& [name, material] : materials)
    {
        SceneBuilder sampled, found;
        for (SceneBuilder* builder : {&sampled, &found})
        {
            builder->add(boxMesh({-0.5f, -0.5f, -0.3f}, {0.5f, 0.5f, 0.0f}), material);
            const auto lampMesh = quadMesh({-0.5f, 0.2f, 0.7f}, {0, 1, 0}, {1, 0, 0});
            const auto below = quadMesh({-0.5f, -0.5f, -1}, {1, 0, 0}, {0, 1, 0});
            if (builder == &sampled)
            {
                builder->addEmissive(lampMesh, lamp(Vec3(3.0f)));
                builder->addEmissive(below, lamp(Vec3(1.0f)));
            }
            else
            {
                builder->add(lampMesh, lamp(Vec3(3.0f)));
                builder->add(below, lamp(Vec3(1.0f)));
            }
        }
        const View view = perspectiveView({0, -1.2, 0.6}, {0, 0, 0}, {0, 0, 1}, 25.0, 32, 32);
        const Estimate a = measure(sampled.build(), view, optionsOf(IntegratorKind::Path, 12), 32);
        const Estimate b = measure(found.build(), view, optionsOf(IntegratorKind::Path, 12), 64);
        CAPTURE(name, a.mean(), a.standardError(), b.mean(), b.standardError());
        CHECK(std::abs(a.mean() - b.mean()) <
              4.0 * std::hypot(a.standardError(), b.standardError()));
        CHECK(a.standardError() < 0.02 * a.mean());
    }
}
