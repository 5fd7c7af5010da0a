// EmissionShapeTest.cpp - where photons leave lights, in which directions, and that all of their
// power arrives.
// SPDX-License-Identifier: MIT
#include "tests/photons/PhotonMeans.h"

#include "osgRayTrace/photons/PhotonTracer.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr double kPiD = glm::pi<double>();
constexpr int kPhotons = 200000;

/// Returns a closed box without targets.
SceneBuilder box(const Material& material)
{
    SceneBuilder builder;
    builder.add(boxMesh(Vec3(-2.0f), Vec3(2.0f)), material);
    return builder;
}

/// Returns the p-value of a chi-square test that the photons fall evenly into the cells. Plain
/// emission is in proportion to what the light sends, so that counting photons is enough.
template <class CellOf> double chiSquareOf(const SceneBuilder& builder, int cells, CellOf cellOf)
{
    const auto traced = builder.build(1);
    const PhotonEmitter emitter(*traced, traced->scene().lights, 0.0f);
    Uniform uniform(5);
    std::vector<double> weights(static_cast<std::size_t>(cells)), expected(weights);
    double total = 0.0;
    for (int k = 0; k < kPhotons; ++k)
    {
        const auto start = emitter.emit(randomPoint(uniform));
        if (!start) continue;
        weights[static_cast<std::size_t>(std::clamp(cellOf(*start), 0, cells - 1))] += 1.0;
        total += 1.0;
    }
    for (double& e : expected)
        e = total / cells;
    REQUIRE(total > 0.99 * kPhotons);
    return chiSquareTest(weights, expected);
}

int cell(double u, int cells)
{
    return std::clamp(static_cast<int>(u * cells), 0, cells - 1);
}

/// Returns one of 8 x 8 cells, by the azimuth around +z and by a height in which the light's flux
/// is even.
int directionCell(Vec3 d, double evenHeight)
{
    const double azimuth = std::atan2(double(d.y), double(d.x)) / (2.0 * kPiD) + 0.5;
    return cell(azimuth, 8) + 8 * cell(evenHeight, 8);
}

Light sun()
{
    Light light;
    light.kind = LightKind::Directional;
    light.direction = Vec3(0, 0, -1);
    light.diffuse = Vec3(2.0f);
    return light;
}

} // namespace

// These are nine chi-square tests, each at 1e-3.
TEST_CASE("photon emission: directions and places are spread as the light shines",
          "[photons][statistics]")
{
    // By Lambert's law the square of the cosine is even.
    SceneBuilder quad = box(lambert(Vec3(0.0f)));
    quad.addQuadLight({-0.5f, -0.25f, 0}, {1, 0, 0}, {0.2f, 0.5f, 0}, Vec3(3.0f));
    const auto lambertCell = [](const PhotonStart& s)
    { return directionCell(s.direction, double(s.direction.z) * double(s.direction.z)); };
    CHECK(chiSquareOf(quad, 64, lambertCell) > 1e-3);
    const auto quadCell = [](const PhotonStart& s)
    {
        const double v = (double(s.origin.y) + 0.25) / 0.5;
        return cell(double(s.origin.x) + 0.5 - 0.2 * v, 8) + 8 * cell(v, 8);
    };
    CHECK(chiSquareOf(quad, 64, quadCell) > 1e-3);

    // Both sides of a mesh of two unequal triangles emit.
    SceneBuilder mesh = box(lambert(Vec3(0.0f)));
    mesh.addEmissive(
        newMesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0.25f, 0}}, {{0, 1, 2}, {0, 2, 3}}),
        lamp(Vec3(1.0f)));
    const auto bothSides = [](const PhotonStart& s)
    {
        const double z = s.direction.z;
        return directionCell(s.direction, 0.5 + 0.5 * z * std::abs(z));
    };
    CHECK(chiSquareOf(mesh, 64, bothSides) > 1e-3);
    // The triangles have areas of 1/2 and 1/8, and the first lies below the diagonal: there are
    // five cells of equal area along x.
    const auto meshCell = [](const PhotonStart& s)
    {
        const double x = s.origin.x, y = s.origin.y;
        if (y > x) return 4; // above the diagonal
        return cell(x * x, 4);
    };
    CHECK(chiSquareOf(mesh, 5, meshCell) > 1e-3);

    SceneBuilder point = box(lambert(Vec3(0.0f)));
    point.addLight(pointLight(Vec3(0.0f)));
    CHECK(chiSquareOf(point, 64,
                      [](const PhotonStart& s) {
                          return directionCell(s.direction, 0.5 + 0.5 * double(s.direction.z));
                      }) > 1e-3);

    // A spot's photons are even in its cone; it is their power that falls off.
    Light light = pointLight(Vec3(0.0f));
    light.direction = Vec3(0, 0, 1);
    light.spotCosCutoff = 0.6f;
    SceneBuilder spot = box(lambert(Vec3(0.0f)));
    spot.addLight(light);
    CHECK(chiSquareOf(spot, 64,
                      [](const PhotonStart& s) {
                          return directionCell(s.direction, (double(s.direction.z) - 0.6) / 0.4);
                      }) > 1e-3);

    // The sun fills the disc of the sphere around the box, whose radius is 2 sqrt(3).
    SceneBuilder sunny = box(lambert(Vec3(0.0f)));
    sunny.addLight(sun());
    CHECK(chiSquareOf(sunny, 64,
                      [](const PhotonStart& s)
                      {
                          const double r2 = double(s.origin.x) * double(s.origin.x) +
                                            double(s.origin.y) * double(s.origin.y);
                          return directionCell(s.origin, r2 / 12.0);
                      }) > 1e-3);

    // Three lights of power 1 : 2 : 5 have numbers of photons in this proportion.
    SceneBuilder three = box(lambert(Vec3(0.0f)));
    for (const float power : {1.0f, 2.0f, 5.0f})
        three.addQuadLight({power, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, Vec3(power));
    CHECK(chiSquareOf(three, 8,
                      [next = 0](const PhotonStart& s) mutable
                      {
                          ++next; // deals a light's photons out to as many cells as it has power
                          return s.light == 0 ? 0 : s.light == 1 ? 1 + next % 2 : 3 + next % 5;
                      }) > 1e-3);
}

TEST_CASE("photon emission: the power of a spot falls with its exponent", "[photons]")
{
    Light light = pointLight(Vec3(0.0f), Vec3(2.0f));
    light.direction = Vec3(0, 0, 1);
    light.spotCosCutoff = 0.6f;
    light.spotExponent = 4.0f;
    SceneBuilder builder = box(lambert(Vec3(0.0f)));
    builder.addLight(light);
    const auto traced = builder.build(1);
    const PhotonEmitter emitter(*traced, traced->scene().lights, 0.0f);
    Uniform uniform(9);
    for (int k = 0; k < 1000; ++k)
    {
        const auto start = emitter.emit({0.5f, uniform(), Vec2(0.0f), Vec2(uniform(), uniform())});
        REQUIRE(start);
        REQUIRE(start->direction.z >= 0.6f);
        // The power is pi I over the density 1 / (2 pi 0.4).
        const double expected =
            2.0 * kPiD * std::pow(double(start->direction.z), 4.0) * 2.0 * kPiD * 0.4;
        REQUIRE(double(start->power.y) == Approx(expected).epsilon(1e-4));
    }
}

namespace
{

/// The power that lands after one straight pass through glass without refraction: a closed skin of
/// index 1 is around the light, within a box. Direct light is not stored, but this light is.
struct Landed
{
    Estimate all;  ///< [W] a pass
    Estimate disc; ///< part of all, on the disc of radius 1/2 in the middle of the floor
};

Landed landed(const Light& light, float guidedShare)
{
    SceneBuilder builder = box(lambert(Vec3(0.5f)));
    Material skin = glass(1.0f);
    skin.baseColor = Vec3(1.0f - 0x1p-20f); // without any tint it would not be traced
    builder.add(sphereMesh(Vec3(0.0f), 1.9f, 16), skin);
    builder.add(sphereMesh({0, 0, -1.0f}, 0.4f, 8), skin); // a target
    if (light.kind == LightKind::Parallelogram)
        builder.addQuadLight(light.corner, light.edgeU, light.edgeV, light.radiance);
    else
        builder.addLight(light);
    const auto traced = builder.build(1);
    const PhotonEmitter emitter(*traced, traced->scene().lights, guidedShare);
    PhotonPassOptions options;
    options.use = PhotonUse::Caustics;
    options.photons = 20000;
    options.maxBounces = 16;
    Landed result;
    const Workers workers(1);
    PhotonMemory memory;
    for (int pass = 0; pass < 16; ++pass)
    {
        const TracedPhotons traced1 =
            tracePhotons(*traced, traced->scene().lights, emitter, options, pass, workers, memory);
        double all = 0.0, disc = 0.0;
        for (const Photon& p : listOf(traced1.photons.spans()))
        {
            const Vec3 far = glm::abs(p.position);
            const bool wall = std::max(far.x, std::max(far.y, far.z)) > 1.99f;
            if (!wall || !p.direct) continue;
            all += double(p.power.y);
            const bool inDisc = p.position.z < -1.99f &&
                                p.position.x * p.position.x + p.position.y * p.position.y < 0.25f;
            if (inDisc) disc += double(p.power.y);
        }
        result.all.add(all);
        result.disc.add(disc);
    }
    return result;
}

} // namespace

// Each estimate has 16 independent passes: there are twelve comparisons at 4 standard errors, with
// a false alarm of 1e-3 a comparison; the seeds are fixed.
TEST_CASE("photon emission: all power arrives at the walls, and its share at a disc",
          "[photons][statistics]")
{
    Light quad;
    quad.kind = LightKind::Parallelogram;
    quad.corner = Vec3(-0.05f, -0.05f, 1.0f);
    quad.edgeU = Vec3(0, 0.1f, 0);
    quad.edgeV = Vec3(0.1f, 0, 0);
    quad.radiance = Vec3(50.0f);
    Light spot = pointLight({0, 0, 1});
    spot.direction = Vec3(0, 0, -1);
    spot.spotCosCutoff = 0.5f;
    spot.spotExponent = 2.0f;
    // The disc of radius 1/2 at distance 3 lies within the cone of cosine c.
    const double c = 3.0 / std::hypot(3.0, 0.5);
    const struct
    {
        Light light;
        double all, disc;
    } cases[] = {{pointLight({0, 0, 1}), 4.0 * kPiD * kPiD, 2.0 * kPiD * kPiD * (1.0 - c)},
                 {spot, 2.0 * kPiD * kPiD * (1.0 - 0.125) / 3.0,
                  2.0 * kPiD * kPiD * (1.0 - c * c * c) / 3.0},
                 // The form factor is that of a small patch and a disc; the size of the patch
                 // changes it by 1e-3.
                 {quad, kPiD * 50.0 * 0.01, kPiD * 50.0 * 0.01 * 0.25 / (9.0 + 0.25)}};
    for (const auto& k : cases)
        for (const float share : {0.0f, 0.9f})
        {
            const Landed result = landed(k.light, share);
            CAPTURE(int(k.light.kind), share, result.all.mean(), k.all, result.all.standardError(),
                    result.disc.mean(), k.disc, result.disc.standardError());
            CHECK(result.all.agrees(k.all, 1e-3 * k.all));
            CHECK(result.disc.agrees(k.disc, 2e-3 * k.disc));
            CHECK(result.disc.standardError() < 0.03 * k.disc);
        }
}
