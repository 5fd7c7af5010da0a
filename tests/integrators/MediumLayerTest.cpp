// MediumLayerTest.cpp - media that thin out with height, compared with quadrature.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/FreeFlight.h"
#include "osgRayTrace/media/GridRay.h"
#include "osgRayTrace/media/MediumWay.h"

#include "tests/Statistics.h"
#include "tests/integrators/FlightMeans.h"
#include "tests/integrators/VolumeScenes.h"

#include <functional>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the integral of a function by Simpson's rule, on both sides of a kink.
double integral(const std::function<double(double)>& f, double begin, double end, double kink,
                int steps = 2000)
{
    const auto simpson = [&](double a, double b)
    {
        if (!(b > a)) return 0.0;
        const double h = (b - a) / steps;
        double sum = f(a) + f(b);
        for (int i = 1; i < steps; ++i)
            sum += (i % 2 ? 4.0 : 2.0) * f(a + h * i);
        return sum * h / 3.0;
    };
    const double middle = std::clamp(kink, begin, end);
    return simpson(begin, middle) + simpson(middle, end);
}

/// A layer that is even below the height 0 of the z axis.
struct Layer
{
    double scaleHeight;

    double density(Vec3d p) const { return std::exp(-std::max(0.0, p.z / scaleHeight)); }

    /// Returns the density's integral from the origin to a distance.
    double depth(Vec3d origin, Vec3d direction, double distance, int steps = 2000) const
    {
        const double kink = direction.z != 0.0 ? -origin.z / direction.z : 0.0;
        return integral([&](double t) { return density(origin + direction * t); }, 0.0, distance,
                        kink, steps);
    }

    MediumRecord record() const
    {
        SceneBuilder builder;
        setAtmosphere(builder, mediumOf(1.0f, 1.0f), 1000.0f);
        thinOut(builder, float(scaleHeight));
        return MediumTable(*builder.scene, Vec3(-1.0f), Vec3(1.0f))[kOutside];
    }
};

Vec3d rising(double sine)
{
    return {std::sqrt(1.0 - sine * sine), 0.0, sine};
}

/// Returns a narrow view of one ray.
View viewAlong(Vec3d origin, Vec3d direction)
{
    return perspectiveView(origin, origin + direction, {0, 1, 0}, 1e-3, 4, 4);
}

struct Ray
{
    double height, sine, length;
};

const Ray kRays[] = {{0.5, 0.6, 20.0}, {-4.0, 0.5, 20.0}, {6.0, -0.7, 15.0},  {1.0, 0.0, 12.0},
                     {-1.0, 0.0, 6.0}, {3.0, -1.0, 9.0},  {-2.0, 1e-5, 10.0}, {1.5, -1e-6, 9.0}};

/// Adds a wall that ends a ray, so small that its shadow does not count.
void addWall(SceneBuilder& builder, Vec3d at, Vec3d direction, const Material& material)
{
    const Vec3 n(direction), u = glm::normalize(glm::cross(n, Vec3(0, 1, 0)));
    const Vec3 v(0, 1, 0);
    constexpr float kHalf = 2e-3f;
    builder.add(quadMesh(Vec3(at) - kHalf * (u + v), 2.0f * kHalf * v, 2.0f * kHalf * u), material);
}

} // namespace

TEST_CASE("medium layer: lengths at full density are those of quadrature, and their inverse is",
          "[integrators][media]")
{
    for (const double scaleHeight : {0.05, 1.0, 40.0})
        for (const double sine : {0.0, 1e-7, -1e-7, 1e-4, -1e-4, 0.01, -0.01, 0.3, -0.3, 1.0, -1.0})
            for (const double height : {-50.0, -3.0, -1e-3, 0.0, 1e-3, 0.7, 5.0, 60.0})
                for (const double length : {1e-3, 2.0, 100.0})
                {
                    const Layer layer{scaleHeight};
                    const Vec3d origin(2.0, 1.0, height), direction = rising(sine);
                    const MediumRecord medium = layer.record();
                    const float begin = 0.5f;
                    const MediumWay way(medium, Vec3(origin), Vec3(direction),
                                        {begin, begin + float(length)});
                    const Vec3d from = origin + direction * double(begin);
                    const double exact = layer.depth(from, direction, length, 40000);
                    CAPTURE(scaleHeight, sine, height, length, exact, way.length());
                    // Heights are rounded to 4e-6 of a length here.
                    const double rounding = 3e-5 + 8e-6 / scaleHeight;
                    CHECK(double(way.length()) ==
                          Approx(exact).epsilon(rounding).margin(1e-7 * length));
                    for (const double share : {1e-6, 0.01, 0.3, 0.5, 0.9, 0.9999})
                    {
                        const float wanted = float(share) * way.length();
                        const float at = way.distanceAt(wanted);
                        CAPTURE(share, at, wanted);
                        CHECK(at >= begin);
                        CHECK(at <= begin + float(length));
                        // A way of 100 is rounded by 1e-5, at which the density is this.
                        const double margin = 3e-5 * double(way.density(at)) + 1e-30;
                        CHECK(double(way.lengthTo(at)) ==
                              Approx(double(wanted)).epsilon(rounding).margin(margin));
                    }
                }
}

TEST_CASE("medium layer: free flights have the density of quadrature",
          "[integrators][statistics][media]")
{
    constexpr int kCells = 64, kSamples = 40000;
    const Vec3 sigma(0.2f, 0.7f, 2.0f), pmf(0.5f, 0.3f, 0.2f);
    const Layer layer{1.7};
    const MediumRecord medium = layer.record();
    Uniform random(3);
    for (const Ray& ray : kRays)
    {
        const Vec3d origin(0, 0, ray.height), direction = rising(ray.sine);
        const MediumWay way(medium, Vec3(origin), Vec3(direction), {0.0f, float(ray.length)});
        std::vector<double> counts(kCells + 1), expected(kCells + 1);
        for (int i = 0; i < kSamples; ++i)
        {
            const FreeFlight flight = sampleFlight(sigma, way.length(), pmf, random());
            const double t = double(way.distanceAt(flight.distance));
            const int cell = flight.collides ? int(t / ray.length * kCells) : kCells;
            ++counts[std::size_t(std::min(cell, kCells))];
        }
        for (int c = 0; c < 3; ++c)
        {
            double left = 1.0;
            for (int cell = 0; cell <= kCells; ++cell)
            {
                const double end = ray.length * (cell + 1) / kCells;
                const double next =
                    cell < kCells
                        ? std::exp(-double(sigma[c]) * layer.depth(origin, direction, end))
                        : 0.0;
                expected[std::size_t(cell)] += kSamples * double(pmf[c]) * (left - next);
                left = next;
            }
        }
        CAPTURE(ray.height, ray.sine);
        CHECK(chiSquareTest(counts, expected) > sidak(1e-3, 8));
    }
}

TEST_CASE("medium layer: light falls by Beer's law, and emission adds up", "[integrators][media]")
{
    const Vec3 sigma(0.05f, 0.25f, 1.0f), emission(0.3f, 0.2f, 0.1f);
    const Layer layer{1.7};
    for (const Ray& ray : kRays)
        for (const bool scatters : {false, true})
        {
            const Vec3d origin(0, 0, ray.height), direction = rising(ray.sine);
            SceneBuilder builder;
            Medium medium;
            (scatters ? medium.sigmaS : medium.sigmaA) = sigma;
            medium.emission = emission;
            setAtmosphere(builder, medium, 100.0f);
            thinOut(builder, float(layer.scaleHeight));
            addWall(builder, origin + direction * ray.length, direction, lamp(Vec3(8.0f)));
            const auto traced = builder.build();
            const double depth = layer.depth(origin, direction, ray.length);
            for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
            {
                // Lamps do not light the air in one edge, and by Whitted's rays they do.
                if (kind == IntegratorKind::Whitted && scatters) continue;
                const Vec3 seen =
                    render(traced, viewAlong(origin, direction), optionsOf(kind, 1), 1).mean();
                for (int c = 0; c < 3; ++c)
                {
                    const double left = std::exp(-double(sigma[c]) * depth);
                    const double expected =
                        8.0 * left + double(emission[c]) * (1.0 - left) / double(sigma[c]);
                    CAPTURE(ray.height, ray.sine, scatters, int(kind), c);
                    CHECK(double(seen[c]) == Approx(expected).epsilon(2e-4));
                }
            }
        }
}

TEST_CASE("medium layer: air light of lamps and suns", "[integrators][statistics][media][long]")
{
    const Layer layer{1.7};
    const double sigmaT = 0.4, sigmaS = 0.3, radius = 60.0;
    const Vec3d lamp(4.0, 1.0, 2.5), towardsSun = glm::normalize(Vec3d(0.3, 0.2, 0.8));
    for (const Ray& ray : kRays)
        for (const bool sun : {false, true})
        {
            const Vec3d origin(0, 0, ray.height), direction = rising(ray.sine);
            SceneBuilder builder;
            setAtmosphere(builder, mediumOf(float(sigmaT), float(sigmaS / sigmaT)), float(radius));
            thinOut(builder, float(layer.scaleHeight));
            addWall(builder, origin + direction * ray.length, direction, lambert(Vec3(0.0f)));
            Light light = pointLight(Vec3(lamp), Vec3(float(1.0 / 3.14159265358979)));
            if (sun)
            {
                light = Light();
                light.kind = LightKind::Directional;
                light.direction = Vec3(-towardsSun);
                light.diffuse = Vec3(float(1.0 / 3.14159265358979));
            }
            builder.addLight(light);
            const auto arriving = [&](Vec3d p)
            {
                const Vec3d way = lamp - p;
                const double d = sun ? 200.0 : glm::length(way);
                const Vec3d wi = sun ? towardsSun : way / d;
                // The medium ends at the sphere.
                const double b = glm::dot(p, wi);
                const double end = -b + std::sqrt(b * b + radius * radius - glm::dot(p, p));
                const double depth = layer.depth(p, wi, std::min(d, end), 200);
                return std::exp(-sigmaT * depth) / (sun ? 1.0 : d * d);
            };
            double depth = 0.0, expected = 0.0;
            constexpr int kSteps = 4000;
            const double step = ray.length / kSteps;
            for (int i = 0; i < kSteps; ++i)
            {
                const Vec3d p = origin + direction * (step * (i + 0.5));
                const double density = layer.density(p);
                expected += density * sigmaS * std::exp(-sigmaT * (depth + 0.5 * step * density)) *
                            arriving(p) * step / 12.566370614359172;
                depth += density * step;
            }
            const auto traced = builder.build();
            for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
            {
                const Estimate seen =
                    measure(traced, viewAlong(origin, direction), optionsOf(kind, 1), 16);
                CAPTURE(ray.height, ray.sine, sun, int(kind), expected, seen.mean(),
                        seen.standardError());
                CHECK(seen.agrees(expected, 1e-4 * expected));
                CHECK(seen.standardError() < 0.05 * expected);
            }
        }
}

TEST_CASE("medium layer: what does not absorb is not seen in a white sky",
          "[integrators][statistics][media][long]")
{
    SceneBuilder builder;
    setAtmosphere(builder, mediumOf(0.7f, 1.0f, 0.5f), 20.0f);
    thinOut(builder, 1.5f, glm::normalize(Vec3(0.2f, 0.3f, 0.9f)));
    addSky(builder);
    const auto traced = builder.build();
    for (const double sine : {-0.7, -0.05, 0.4})
    {
        const View view = viewAlong({0, 0, 1}, rising(sine));
        const Estimate seen = measure(traced, view, optionsOf(IntegratorKind::Path, 64), 64);
        CAPTURE(sine, seen.mean(), seen.standardError());
        CHECK(seen.agrees(1.0, 1e-4));
        CHECK(seen.standardError() < 0.02);
    }
}

TEST_CASE("medium layer: below its base it is an even medium, and far above nothing is",
          "[integrators][media]")
{
    const MediumRecord medium = Layer{1.7}.record();
    MediumRecord even = medium;
    even.thins = false;
    for (const double sine : {-1.0, -0.3, 0.0, 1e-6, 0.7})
    {
        const Vec3 origin(0, 0, -40), direction(rising(sine));
        const RayPart part{0.3f, 17.7f};
        const MediumWay way(medium, origin, direction, part), plain(even, origin, direction, part);
        CAPTURE(sine);
        CHECK(way.length() == plain.length());
        for (const float t : {0.3f, 1.1f, 9.7f, 17.7f})
        {
            CHECK(way.lengthTo(t) == plain.lengthTo(t));
            CHECK(way.distanceAt(t - 0.3f) == plain.distanceAt(t - 0.3f));
            CHECK(way.density(t) == 1.0f);
        }
        const MediumWay high(medium, {0, 0, 900}, direction, part);
        CHECK(high.length() == 0.0f);
        CHECK(high.distanceAt(0.0f) >= part.begin);
        CHECK(high.distanceAt(0.0f) <= part.end);
    }
    SceneBuilder builder = cornellBox();
    setAtmosphere(builder, mediumOf(0.02f, 0.9f, 0.3f), 3000.0f, {278, -2000, 280});
    thinOut(builder, 1e-30f, {0, 1, 0});
    const Picture above =
        render(builder.build(), cornellView(24, 24), optionsOf(IntegratorKind::Path, 6), 2);
    CHECK(above.progress.droppedSamples == 0);
    const Vec3 without =
        render(cornellBox().build(), cornellView(24, 24), optionsOf(IntegratorKind::Path, 6), 2)
            .mean();
    CHECK(above.mean().y == Approx(without.y).epsilon(0.05));
}

TEST_CASE("medium layer: volumes lie in it", "[integrators][statistics][volumes]")
{
    const Layer layer{1.7};
    Medium medium;
    medium.sigmaS = Vec3(0.1f, 0.3f, 0.6f);
    SceneBuilder around;
    setAtmosphere(around, medium, 50.0f);
    thinOut(around, float(layer.scaleHeight));
    const MediumTable media(*around.scene, Vec3(-1.0f), Vec3(1.0f));
    Scene scene;
    scene.volumes.push_back(densityIn({2, -1, -9}, {4, 1, 9}, ramp(40), medium));
    const GridTable table(scene, nullptr, nullptr, nullptr);
    for (const Ray& r : {Ray{-1.0, 0.4, 8.0}, Ray{2.5, -0.5, 7.0}, Ray{1.0, 0.0, 5.0}})
    {
        const Vec3d origin(0, 0, r.height), direction = rising(r.sine);
        GridRay ray(table, Vec3(origin), Vec3(direction), 0.0f, float(r.length));
        ray.setAround(media[kOutside], {0.0f, float(r.length)});
        // The ramp is along x, of which the ray goes cos a length.
        const double ramped = rampDepth(40) * 2.0 / direction.x;
        const auto [left, collided, ways, shadows] = flightMeans(ray, float(r.length));
        for (std::size_t c = 0; c < 3; ++c)
        {
            const double depth = layer.depth(origin, direction, r.length) + ramped;
            const double expected = std::exp(-double(medium.sigmaS[int(c)]) * depth);
            CAPTURE(r.height, c, expected, left[c].mean(), ways[c].mean(), shadows[c].mean());
            CHECK(left[c].agrees(expected));
            CHECK(collided[c].agrees(1.0 - expected));
            CHECK(ways[c].agrees(expected));
            CHECK(shadows[c].agrees(expected));
        }
    }
}

TEST_CASE("medium layer: beside volumes, a long way down through thin air is not cut",
          "[integrators][volumes]")
{
    constexpr float kHeight = 1e5f; // at the density of the lower end, as many collisions
    Medium medium;
    medium.sigmaS = Vec3(1.0f);
    SceneBuilder around;
    setAtmosphere(around, medium, 2.0f * kHeight);
    thinOut(around, 1.0f);
    const MediumTable media(*around.scene, Vec3(-1.0f), Vec3(1.0f));
    Scene scene;
    scene.volumes.push_back(densityIn({-1, -1, 7}, {1, 1, 9}, ramp(4), mediumOf(0.0f, 0.0f)));
    const GridTable table(scene, nullptr, nullptr, nullptr);
    GridRay ray(table, Vec3(0, 0, kHeight), Vec3(0, 0, -1), 0.0f, kHeight);
    ray.setAround(media[kOutside], {0.0f, kHeight});
    Estimate shadow, left;
    for (uint32_t k = 0; k < 4000; ++k)
    {
        NumberStream numbers(hash(k, 5u));
        shadow.add(double(ray.transmittance(0.0f, kHeight, numbers).x));
        left.add(double(ray.way(numbers).left.x));
    }
    CAPTURE(shadow.mean(), left.mean());
    CHECK(shadow.agrees(std::exp(-1.0)));
    CHECK(left.agrees(std::exp(-1.0)));
}
