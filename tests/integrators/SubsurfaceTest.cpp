// SubsurfaceTest.cpp - light that enters bodies below diffuse boundaries and leaves them elsewhere.
// SPDX-License-Identifier: MIT
//
// All tests have fixed seeds. Means have to agree within four standard errors, as Estimate says.
#include "osgRayTrace/accel/SubsurfaceWalk.h"
#include "osgRayTrace/sampling/Hash.h"
#include "tests/integrators/SubsurfaceScenes.h"

#include <random>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the share of light that a half-space scatters back of light that comes by the cosine
/// law: 1 - 2 sqrt(1 - a) times the integral of H(mu) mu [Chandrasekhar60], with H by iteration of
/// 1/H = sqrt(1 - a) + a/2 times the integral of mu' H(mu') / (mu + mu').
double bondAlbedo(double a)
{
    constexpr int kNodes = 400;
    std::vector<double> h(kNodes, 1.0), next(kNodes);
    const auto node = [](int i) { return (i + 0.5) / kNodes; };
    for (int round = 0; round < 60; ++round)
    {
        for (int i = 0; i < kNodes; i += 1)
        {
            double sum = 0.0;
            for (int j = 0; j < kNodes; ++j)
                sum += node(j) * h[std::size_t(j)] / (node(i) + node(j));
            next[std::size_t(i)] = 1.0 / (std::sqrt(1.0 - a) + 0.5 * a * sum / kNodes);
        }
        h = next;
    }
    double moment = 0.0;
    for (int i = 0; i < kNodes; ++i)
        moment += node(i) * h[std::size_t(i)];
    return 1.0 - 2.0 * std::sqrt(1.0 - a) * moment / kNodes;
}

/// Follows walks through a half-space, in double and with numbers of their own: the distances from
/// their entry at which they leave. A walk that is absorbed has an infinite one.
std::vector<double> distancesInHalfSpace(double albedo, int walks)
{
    std::mt19937_64 random(7);
    const auto unit = [&] { return double(random() >> 11) * 0x1p-53; };
    std::vector<double> distances;
    for (int w = 0; w < walks; ++w)
    {
        double x = 0.0, y = 0.0, z = 0.0, cosine = std::sqrt(unit()),
               phi = 6.283185307179586 * unit();
        double distance = std::numeric_limits<double>::infinity();
        for (;;)
        {
            const double t = -std::log(1.0 - unit()), sine = std::sqrt(1.0 - cosine * cosine);
            const double step = cosine < 0.0 ? std::min(t, -z / cosine) : t;
            x += step * sine * std::cos(phi);
            y += step * sine * std::sin(phi);
            if (step < t)
            {
                distance = std::sqrt(x * x + y * y);
                break;
            }
            z += step * cosine;
            if (!(unit() < albedo)) break;
            cosine = 2.0 * unit() - 1.0;
            phi = 6.283185307179586 * unit();
        }
        distances.push_back(distance);
    }
    return distances;
}

/// Returns the sums of what leaves a box within distances of its entry in the middle of one side,
/// [distance][channel], for throughputs of 1.
struct Profile
{
    Estimate shares[6][3];
    uint64_t open = 0;
};

const double kDistances[6] = {0.5, 1.0, 2.0, 5.0, 10.0, 1e30};

Profile profileOf(Vec3 color, Vec3 radius, int walks)
{
    SceneBuilder builder;
    builder.add(boxMesh(Vec3(-300.0f, -300.0f, -300.0f), Vec3(300.0f, 300.0f, 0.0f)),
                wax(color, radius));
    const auto traced = builder.build();
    const MaterialRecord& material = traced->materials()[traced->surfaces()[0].material];
    Profile profile;
    for (int i = 0; i < walks; ++i)
    {
        SubsurfaceEntry entry;
        entry.position = Vec3(0.1f, 0.2f, 0.0f);
        entry.normal = Vec3(0.0f, 0.0f, 1.0f);
        entry.offset = 1e-4f;
        for (int c = 0; c < 3; ++c)
            entry.sigma[c] = material.subsurfaceSigma[c];
        entry.color = color;
        entry.throughput = Vec3(1.0f);
        entry.least = 0.4f;
        entry.key = hash(uint32_t(i) + 17u);
        entry.direction = Vec2(unitFloat(hash(uint32_t(i), 1u)), unitFloat(hash(uint32_t(i), 2u)));
        const SubsurfaceWalk walk = walkBelow(*traced, entry);
        profile.open += walk.end == SubsurfaceWalk::End::Open;
        const bool left = walk.end == SubsurfaceWalk::End::Left;
        const double distance =
            left ? double(glm::length(Vec2(walk.position) - Vec2(entry.position))) : 1e38;
        for (int k = 0; k < 6; ++k)
            for (int c = 0; c < 3; ++c)
                profile.shares[k][c].add(left && distance < kDistances[k] * double(radius[c])
                                             ? double(walk.throughput[c])
                                             : 0.0);
    }
    return profile;
}

/// Returns the mean radiance of a ball of radius 1 over its disc, seen from far away in a sky of 1.
Estimate discOf(const Material& material, int passes)
{
    SceneBuilder builder;
    builder.add(sphereMesh(Vec3(0.0f), 1.0f, 48), material);
    addSky(builder);
    const double side = 2.2, disc = 3.14159265358979 / (side * side);
    const auto traced = builder.build();
    Estimate estimate;
    RenderOptions options = optionsOf(IntegratorKind::Path, 64);
    for (options.seed = 0; options.seed < 16; ++options.seed)
    {
        const Picture picture =
            render(traced, patchView({0, 0, 4}, {0, 0, 1}, side, 32), options, passes);
        REQUIRE(picture.progress.droppedSamples == 0);
        CHECK(picture.progress.openWalks == 0);
        estimate.add((double(picture.mean().y) - (1.0 - disc)) / disc);
    }
    return estimate;
}

} // namespace

TEST_CASE("subsurface: a white body is not seen in a white sky", "[statistics][subsurface]")
{
    const Material plain = wax(Vec3(1.0f), Vec3(0.2f));
    const struct
    {
        const char* name;
        Material material;
    } cases[] = {
        {"bare", plain},
        {"colours of their own", wax(Vec3(1.0f), Vec3(0.5f, 0.2f, 0.1f))},
        {"smooth", changed(wax(Vec3(1.0f), Vec3(0.2f), 1.5f),
                           [](Material& m, MaterialDetail&) { m.roughness = 0.0f; })},
        {"rough", changed(wax(Vec3(1.0f), Vec3(0.2f), 1.5f),
                          [](Material& m, MaterialDetail&) { m.roughness = 0.6f; })},
        {"half", wax(Vec3(1.0f), Vec3(0.2f), 1.0f, 0.5f)},
        {"coated", changed(plain, [](Material&, MaterialDetail& d) { d.clearcoat = 1.0f; })},
    };
    for (const auto& c : cases)
    {
        const Estimate seen = discOf(c.material, 1);
        CAPTURE(c.name, seen.mean(), seen.standardError());
        CHECK(seen.agrees(1.0, 1e-3));
    }
}

TEST_CASE("subsurface: a thick body has its colour", "[statistics][subsurface]")
{
    for (const float color : {0.2f, 0.5f, 0.9f})
    {
        SceneBuilder builder;
        builder.add(boxMesh(Vec3(-40.0f, -40.0f, -40.0f), Vec3(40.0f, 40.0f, 0.0f)),
                    wax(Vec3(color), Vec3(0.25f)));
        addSky(builder);
        const Estimate seen = measure(builder.build(), patchView({0, 0, 0}, {0, 0, 1}, 1.0, 32),
                                      optionsOf(IntegratorKind::Path, 8), 2);
        const double exact = bondAlbedo(albedoOfColor(double(color), 0.0));
        CAPTURE(color, exact, seen.mean(), seen.standardError());
        CHECK(seen.agrees(exact, 2e-4));
        CHECK(std::abs(exact - double(color)) < 0.006); // what the inversion is worth
    }
    CHECK(albedoOfColor(bondAlbedo(0.5), 0.0) == Approx(0.5046).margin(0.0005));
    CHECK(albedoOfColor(bondAlbedo(0.9), 0.0) == Approx(0.9005).margin(0.0005));
    CHECK(albedoOfColor(bondAlbedo(0.99), 0.0) == Approx(0.9900).margin(0.0005));
}

TEST_CASE("subsurface: light leaves where that of a half-space does",
          "[statistics][subsurface][long]")
{
    const int walks = 60000;
    for (const float color : {0.45f, 0.83f})
    {
        const double albedo = albedoOfColor(double(color), 0.0);
        const std::vector<double> exact = distancesInHalfSpace(albedo, 4 * walks);
        const Profile grey = profileOf(Vec3(color), Vec3(1.0f), walks);
        // Each channel is what it would be alone, though one walk serves all three.
        const Profile rgb = profileOf(Vec3(color), Vec3(1.0f, 0.4f, 2.0f), walks);
        CHECK(grey.open == 0);
        CHECK(rgb.open == 0);
        for (int k = 0; k < 6; ++k)
        {
            Estimate expected;
            for (const double distance : exact)
                expected.add(distance < kDistances[k] ? 1.0 : 0.0);
            CAPTURE(color, kDistances[k], expected.mean());
            for (const Estimate& share :
                 {grey.shares[k][0], rgb.shares[k][0], rgb.shares[k][1], rgb.shares[k][2]})
            {
                CAPTURE(share.mean(), share.standardError());
                CHECK(share.agrees(expected.mean(), 4.0 * expected.standardError()));
            }
        }
    }
}

TEST_CASE("subsurface: walks without light end at once", "[subsurface]")
{
    SceneBuilder builder;
    builder.add(boxMesh(Vec3(-1.0f), Vec3(1.0f)), wax(Vec3(1.0f), Vec3(0.1f)));
    const auto traced = builder.build();
    SubsurfaceEntry entry;
    entry.position = Vec3(0.1f, 0.2f, 1.0f);
    entry.normal = Vec3(0.0f, 0.0f, 1.0f);
    entry.offset = 1e-4f;
    entry.sigma = Vec3(10.0f);
    entry.color = Vec3(1.0f);
    entry.throughput = Vec3(0.0f);
    entry.least = 0.0f;
    entry.direction = Vec2(0.5f);
    for (entry.key = 0; entry.key < 16; ++entry.key)
    {
        const SubsurfaceWalk walk = walkBelow(*traced, entry);
        CHECK(walk.end == SubsurfaceWalk::End::Absorbed);
        CHECK(walk.collisions == 0);
    }
}

TEST_CASE("subsurface: a short way is plain diffuse reflection", "[statistics][subsurface]")
{
    const Vec3 color(0.6f);
    for (const float ior : {1.0f, 1.5f})
    {
        // Of the way that is set no float is left, and the base is Lambert's.
        const Material plain = wax(color, Vec3(1.0f), ior, 0.0f);
        const auto exact = room(plain).build();
        const RenderOptions options = optionsOf(IntegratorKind::Path, 5);
        const Estimate expected = measure(exact, roomView(), options, 2);
        const auto none = room(wax(color, Vec3(1e-12f), ior)).build();
        CHECK(measure(none, roomView(), options, 2)
                  .agrees(expected.mean(), 4.0 * expected.standardError()));
        // Nearly so. The colour of the walk is that of the inversion.
        const auto back = float(bondAlbedo(albedoOfColor(double(color.x), 0.0)));
        const Estimate nearby =
            measure(room(wax(color, Vec3(2e-3f), ior)).build(), roomView(), options, 2);
        const Estimate lambertian =
            measure(room(wax(Vec3(back), Vec3(1.0f), ior, 0.0f)).build(), roomView(), options, 2);
        CAPTURE(ior, nearby.mean(), nearby.standardError(), lambertian.mean());
        CHECK(nearby.agrees(lambertian.mean(), 4.0 * lambertian.standardError() + 5e-4));
        // A radius of 0 is the same material.
        const Picture zero =
            render(room(wax(color, Vec3(0.0f), ior)).build(), roomView(), options, 1);
        const Picture same = render(exact, roomView(), options, 1);
        CHECK(zero.rgba == same.rgba);
    }
}

TEST_CASE("subsurface: an open mesh reflects as a diffuse surface, and is counted",
          "[statistics][subsurface]")
{
    const auto sheet = [](const Material& material)
    {
        SceneBuilder builder;
        builder.add(quadMesh({-1.0f, -1.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}),
                    material);
        addSky(builder);
        return builder.build();
    };
    const View view = patchView({0, 0, 0}, {0, 0, 1}, 1.0, 16);
    const RenderOptions options = optionsOf(IntegratorKind::Path, 3);
    const auto open = sheet(wax(Vec3(0.5f), Vec3(0.1f)));
    CHECK(measure(open, view, options, 2).agrees(0.5, 1e-3));
    CHECK(render(open, view, options, 1).progress.openWalks == 16u * 16u);

    // A body with a hole: nothing is lost but what its own colour takes.
    SceneBuilder box;
    const auto whole = boxMesh(Vec3(-1.0f), Vec3(1.0f));
    std::vector<UVec3> triangles(whole->triangles.begin(), whole->triangles.end());
    triangles.pop_back();
    box.add(newMesh(std::vector<Vec3>(whole->positions.begin(), whole->positions.end()), triangles),
            wax(Vec3(1.0f), Vec3(0.3f)));
    addSky(box);
    const Picture holed = render(box.build(), roomView(), optionsOf(IntegratorKind::Path, 16), 16);
    CHECK(holed.progress.openWalks > 0);
    CHECK(holed.progress.droppedSamples == 0);
    CHECK(holed.mean().y > 0.9f);
    CHECK(holed.mean().y < 1.02f);
}

TEST_CASE("subsurface: pixels that share paths, and those in air, agree",
          "[statistics][subsurface]")
{
    // Scenes with media share no paths: the same light by other code.
    for (const float ior : {1.0f, 1.4f})
    {
        SceneBuilder alone = room(wax(Vec3(0.9f, 0.7f, 0.5f), Vec3(0.4f, 0.2f, 0.1f), ior));
        const auto shared = alone.build();
        alone.scene = std::make_shared<Scene>(*alone.scene);
        setAtmosphere(alone, mediumOf(1e-12f, 0.5f), 20.0f);
        RenderOptions options = optionsOf(IntegratorKind::Path, 5);
        const View near = perspectiveView({0, -6, 3}, {0, 0, 1}, {0, 0, 1}, 14, 32, 32);
        const auto inAir = alone.build();
        Estimate difference; // both have the same random numbers, and nearly the same noise
        for (options.seed = 0; options.seed < 16; ++options.seed)
            difference.add(double(render(shared, near, options, 4).mean().y) -
                           double(render(inAir, near, options, 4).mean().y));
        CAPTURE(ior, difference.mean(), difference.standardError());
        CHECK(difference.standardError() < 3e-4); // of 0.08
        CHECK(difference.agrees(0.0));
    }
}

TEST_CASE("subsurface: bodies of several materials, and bodies within them",
          "[statistics][subsurface]")
{
    // The lower half of a ball has another material; a black ball within is not there.
    const auto whole = sphereMesh(Vec3(0.0f), 1.0f, 24);
    std::vector<UVec3> upper, lower;
    for (const UVec3& t : whole->triangles)
    {
        const Vec3* p = whole->positions.data();
        (p[t.x].y + p[t.y].y + p[t.z].y > 0.0f ? upper : lower).push_back(t);
    }
    const std::vector<Vec3> points(whole->positions.begin(), whole->positions.end());
    SceneBuilder builder;
    builder.add(newMesh(points, upper), wax(Vec3(1.0f), Vec3(0.3f)));
    builder.add(newMesh(points, lower), wax(Vec3(1.0f), Vec3(0.2f), 1.5f));
    builder.add(sphereMesh(Vec3(0.0f), 0.5f, 12), lambert(Vec3(0.0f)));
    builder.add(sphereMesh(Vec3(0.5f, 0.0f, 0.0f), 0.9f, 24), wax(Vec3(1.0f), Vec3(0.4f)));
    addSky(builder);
    const Estimate seen = measure(builder.build(), patchView({0, 0, 4}, {0, 0, 1}, 3.2, 32),
                                  optionsOf(IntegratorKind::Path, 64), 1);
    CAPTURE(seen.mean(), seen.standardError());
    CHECK(seen.agrees(1.0, 1e-3));
}

TEST_CASE("subsurface: a body on a floor that is exactly where the body ends",
          "[statistics][subsurface]")
{
    for (const bool placed : {false, true})
    {
        SceneBuilder builder;
        builder.add(boxMesh(Vec3(-1.0f, -1.0f, 0.0f), Vec3(1.0f)), wax(Vec3(1.0f), Vec3(0.4f)));
        builder.add(quadMesh({-1.0f, -1.0f, 0.0f}, {2.0f, 0.0f, 0.0f}, {0.0f, 2.0f, 0.0f}),
                    lambert(Vec3(0.0f)));
        addSky(builder);
        for (Instance& instance : builder.scene->instances)
            instance.placed = placed;
        const Picture picture = render(builder.build(), patchView({0, 0, 1}, {0, 0, 1}, 1.6, 32),
                                       optionsOf(IntegratorKind::Path, 32), 16);
        CAPTURE(placed, picture.mean().y);
        CHECK(picture.progress.openWalks == 0);
        CHECK(picture.mean().y == Approx(1.0f).margin(2e-3));
    }
}
