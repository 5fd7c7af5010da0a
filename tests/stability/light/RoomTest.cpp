// RoomTest.cpp - closed rooms: energy after many bounces, uniformity, reciprocity. Layer: tests.
// SPDX-License-Identifier: MIT
#include "tests/integrators/Measure.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("stability 37: a closed room of albedo 0.99", "[stability][statistics]")
{
    // The radiance is Le (1 - rho^(k+1)) / (1 - rho); 4096 bounces give all of it to 1e-17.
    // Roulette alone ends these paths: after a hundred bounces on average, with a standard
    // deviation of a hundred.
    const struct
    {
        int bounces, passes;
        double radiance, noise;
    } cases[] = {{8, 16, 8.6482752, 1e-3}, {64, 32, 47.966, 1e-3}, {4096, 32, 100.0, 2e-3}};
    Material wall = lambert(Vec3(0.99f));
    wall.emission = Vec3(1.0f);
    for (const auto& c : cases)
    {
        SceneBuilder room;
        if (c.bounces < 64)
            room.addEmissive(boxMesh(Vec3(-1.0f), Vec3(1.0f)), wall);
        else
            room.add(boxMesh(Vec3(-1.0f), Vec3(1.0f)), wall); // shadow rays would double the time
        const View view =
            perspectiveView({0.1, 0.2, -0.1}, {0.3, 0.1, 0.8}, {0, 1, 0}, 80.0, 32, 32);
        const double expected = (1.0 - std::pow(0.99, c.bounces + 1)) / 0.01;
        REQUIRE(expected == Approx(c.radiance).epsilon(2e-5));
        const Estimate radiance =
            measure(room.build(), view, optionsOf(IntegratorKind::Path, c.bounces), c.passes);
        CAPTURE(c.bounces, radiance.mean(), expected, radiance.standardError());
        CHECK(radiance.agrees(expected, 1e-3 * expected));
        CHECK(radiance.standardError() < c.noise * expected);
    }
}

TEST_CASE("stability 48: an off-centre spot in an integrating sphere lights all of it alike",
          "[stability][statistics]")
{
    // E_ind = rho Phi / (4 pi R^2 (1 - rho)) holds wherever the spot is and shines. The spot's flux
    // follows from OpenGL's terms, an intensity of pi cos^e within the cutoff: Phi = 2 pi^2 (1 -
    // cos^(e+1) cutoff) / (e + 1).
    constexpr double kRho = 0.5, kExponent = 1.0;
    const double cosCutoff = std::cos(1.2);
    Light spot = pointLight(Vec3(0.45f, -0.2f, 0.3f));
    spot.direction = glm::normalize(Vec3(0.3f, 0.2f, 1.0f));
    spot.spotExponent = kExponent;
    spot.spotCosCutoff = static_cast<float>(cosCutoff);
    SceneBuilder sphere;
    sphere.add(sphereMesh(Vec3(0.0f), 1.0f, 100), lambert(Vec3(kRho)));
    sphere.addLight(spot);
    const auto traced = sphere.build();

    const double flux =
        2.0 * M_PI * M_PI * (1.0 - std::pow(cosCutoff, kExponent + 1)) / (kExponent + 1);
    const double expected = kRho / M_PI * kRho * flux / (4.0 * M_PI * (1.0 - kRho));
    double low = 1e9, high = 0.0, noise = 0.0;
    int dark = 0;
    for (int i = 0; i < 14; ++i)
    {
        // The places are off the directions in which facets meet, all around the sphere.
        const double z = -0.93 + 0.14 * i, phi = 2.4 * i + 0.1, r = std::sqrt(1.0 - z * z);
        const Vec3d n(r * std::cos(phi), r * std::sin(phi), z);
        const Vec3d towards = glm::normalize(n - Vec3d(spot.position));
        if (glm::dot(towards, Vec3d(spot.direction)) > cosCutoff - 0.05) continue; // sees the spot
        ++dark;
        const Estimate radiance = measure(traced, patchView(n * 0.999, -n, 0.02, 16),
                                          optionsOf(IntegratorKind::Path, 16), 128);
        CAPTURE(i, radiance.mean(), expected, radiance.standardError());
        CHECK(radiance.agrees(expected, 2.5e-3 * expected));
        CHECK(radiance.standardError() < 4e-3 * expected);
        low = std::min(low, radiance.mean());
        high = std::max(high, radiance.mean());
        noise = std::max(noise, radiance.standardError());
    }
    CAPTURE(low, high, noise);
    CHECK(dark >= 7);
    CHECK(high - low <= 5e-3 * expected + 8.0 * noise);
}

TEST_CASE("stability 49: light from A to B is light from B to A", "[stability][statistics]")
{
    // Two equal patches of the same albedo are on the floor and on the back wall of the Cornell box
    // without its lamp; one of them has radiance 10 on its front. The tall block hides some of the
    // direct light. Welch's test has 16 seeds a side, about 28 degrees of freedom, and p > 1e-3 is
    // |t| < 3.67.
    constexpr float kSide = 120.0f;
    const struct
    {
        Vec3 corner, u, v;
    } patches[2] = {{{60, 1, 300}, {0, 0, kSide}, {kSide, 0, 0}},     // on the floor, faces up
                    {{400, 240, 558}, {0, kSide, 0}, {kSide, 0, 0}}}; // on the back wall
    const auto room = [&patches](int emitter)
    {
        SceneBuilder box = cornellBox();
        box.scene->lights.clear();
        for (Instance& instance : box.scene->instances)
        {
            if (instance.light == kInvalid) continue;
            instance.light = kInvalid;
            box.scene->materials[instance.material] = lambert(Vec3(0.73f));
        }
        for (int i = 0; i < 2; ++i)
        {
            const auto& p = patches[i];
            if (i == emitter)
            {
                box.addQuadLight(p.corner, p.u, p.v, Vec3(10.0f));
                box.scene->materials.back().baseColor = Vec3(0.6f);
            }
            else
                box.add(quadMesh(p.corner, p.u, p.v), lambert(Vec3(0.6f)));
        }
        return box.build();
    };
    const auto radianceAt = [&](int patch)
    {
        const auto& p = patches[patch];
        const View view = patchView(Vec3d(p.corner + 0.5f * (p.u + p.v)),
                                    glm::normalize(Vec3d(glm::cross(p.u, p.v))), kSide, 16);
        return measure(room(1 - patch), view, optionsOf(IntegratorKind::Path, 16), 256);
    };
    const Estimate atFloor = radianceAt(0), atWall = radianceAt(1);
    const double t = (atWall.mean() - atFloor.mean()) /
                     std::hypot(atWall.standardError(), atFloor.standardError());
    CAPTURE(atWall.mean(), atWall.standardError(), atFloor.mean(), atFloor.standardError(), t);
    CHECK(std::abs(t) < 3.67);
    CHECK(atWall.standardError() < 3e-3 * atWall.mean());
    CHECK(atFloor.standardError() < 3e-3 * atFloor.mean());
}
