// AreaLightTest.cpp - receivers at, on and below lights, and round lights. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Adds a white receiver of the given side around the origin, with its normal at +z.
void addReceiver(SceneBuilder& builder, float side)
{
    builder.add(quadMesh({-0.5f * side, -0.5f * side, 0}, {side, 0, 0}, {0, side, 0}),
                lambert(Vec3(1.0f)));
}

} // namespace

TEST_CASE("stability 24: a round light at and below the horizon of its receiver",
          "[stability][statistics]")
{
    // Area lights are not round, so the sphere is an emissive mesh. Its 200 rows of facets have an
    // outline that is 1e-4 smaller in area. [Snyder, 1996] has the formula for the part above the
    // horizon.
    const struct
    {
        double degrees, irradiance;
    } cases[] = {
        {0, 0.78539816}, {60, 0.39269908}, {75, 0.22120088}, {90, 0.09058607}, {100, 0.03544902}};
    for (const auto& c : cases)
    {
        const double theta = c.degrees * M_PI / 180.0;
        SceneBuilder builder;
        addReceiver(builder, 1e-2f);
        builder.addEmissive(
            sphereMesh(Vec3(2.0 * std::sin(theta), 0, 2.0 * std::cos(theta)), 1.0f, 200),
            lamp(Vec3(1.0f)));
        const View view = patchView({0, 0, 0}, {0, 0, 1}, 1e-3, 16);
        const auto traced = builder.build();
        const Estimate path = measure(traced, view, optionsOf(IntegratorKind::Path, 1), 64);
        const Estimate whitted = measure(traced, view, optionsOf(IntegratorKind::Whitted), 16);
        const double expected = c.irradiance / M_PI;
        for (const Estimate& radiance : {path, whitted})
        {
            CAPTURE(c.degrees, radiance.mean(), expected, radiance.standardError());
            CHECK(radiance.agrees(expected, 2e-4 * expected));
            CHECK(radiance.standardError() < 1e-2 * expected);
        }
    }
}

TEST_CASE("stability 26: receiver just above a light", "[stability][statistics]")
{
    // A unit light fills the hemisphere but for 4e-12 of it: the radiance is pi L, to 1e-3 with
    // four standard errors included. None of a million samples may be much brighter, or the
    // variance would not be finite.
    for (const bool mesh : {false, true})
    {
        SceneBuilder builder;
        addReceiver(builder, 0.01f);
        const Vec3 corner(-0.5f, -0.5f, 1e-6f), u(0, 1, 0), v(1, 0, 0);
        if (mesh)
            builder.addEmissive(quadMesh(corner, u, v), lamp(Vec3(1.0f)));
        else
            builder.addQuadLight(corner, u, v, Vec3(1.0f));
        const View view = patchView({0, 0, 0}, {0, 0, 1}, 1e-9, 16);
        const auto traced = builder.build();
        const Estimate radiance = measure(traced, view, optionsOf(IntegratorKind::Path, 1), 256);
        float largest = 0.0f;
        for (uint32_t seed = 0; seed < 256; ++seed)
        {
            const Picture picture =
                render(traced, view, optionsOf(IntegratorKind::Path, 1, seed), 1);
            for (int i = 0; i < 256; ++i)
                largest = std::max(largest, picture.at(i % 16, i / 16).y);
        }
        CAPTURE(mesh, radiance.mean(), radiance.standardError(), largest);
        CHECK(std::abs(radiance.mean() - 1.0) + 4.0 * radiance.standardError() < 1e-3);
        CHECK(largest < 2.0f);
    }
}

TEST_CASE("stability 27: a receiver on the light's plane gets exactly nothing", "[stability]")
{
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        for (const bool twoSided : {false, true})
        {
            for (const bool mesh : {false, true})
            {
                for (const float left : {1.0f, 0.5f}) // the second light touches the receiver
                {
                    SceneBuilder builder;
                    addReceiver(builder, 1.0f);
                    const Vec3 corner(left, -0.5f, 0), u(1, 0, 0), v(0, 1, 0);
                    if (mesh)
                        builder.addEmissive(quadMesh(corner, u, v), lamp(Vec3(1e6f)));
                    else
                        builder.addQuadLight(corner, u, v, Vec3(1e6f), twoSided);
                    const Picture picture =
                        render(builder.build(), patchView({0, 0, 0}, {0, 0, 1}, 1.0, 32),
                               optionsOf(kind, 4), 8);
                    CAPTURE(int(kind), twoSided, mesh, left);
                    CHECK(picture.progress.droppedSamples == 0);
                    CHECK(picture.mean() == Vec3(0.0f));
                }
            }
        }
    }
}
