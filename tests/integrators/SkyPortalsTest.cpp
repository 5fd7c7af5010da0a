// SkyPortalsTest.cpp - openings to the sky: densities by quadrature, where they are found, means
// beside surfaces that know none, noise, threads.
// SPDX-License-Identifier: MIT
#include "tests/integrators/SkyRoom.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns a window in the plane x = 2 and one in the plane y = 3.
SkyPortals twoWindows()
{
    return SkyPortals({rectangle({2, -0.5f, 1}, {0, 1, 0}, {0, 0, 0.8f}),
                       rectangle({-1, 3, 0.5f}, {0, 0, 1.5f}, {0.4f, 0, 0})});
}

/// Calls f(direction, solid angle) for the middles of cells of the sphere.
template <class F> void forSphere(F f)
{
    constexpr int kRows = 1500, kColumns = 3000;
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column)
        {
            const double z = 2.0 * (row + 0.5) / kRows - 1.0, r = std::sqrt(1.0 - z * z);
            const double phi = 2.0 * M_PI * (column + 0.5) / kColumns;
            f(Vec3(Vec3d(r * std::cos(phi), r * std::sin(phi), z)),
              4.0 * M_PI / (double(kRows) * kColumns));
        }
}

std::shared_ptr<const SkyPortals> portalsOf(const std::shared_ptr<const TracedScene>& traced,
                                            const View& view)
{
    TileCounts counts;
    const auto portals = findSkyPortals(contextOf(*traced, view), counts);
    CHECK(counts.shadowRays > 0);
    return portals;
}

/// Returns the variance of pixels among eight seeds over the square of their mean, as a mean over
/// the picture.
double pixelVariance(const std::shared_ptr<const TracedScene>& traced, RenderOptions options,
                     int passes = 32)
{
    constexpr int kSeeds = 8;
    std::vector<double> sums, squares;
    for (uint32_t seed = 0; seed < kSeeds; ++seed)
    {
        options.seed = seed;
        const Picture picture = render(traced, Room().view(32, 32), options, passes);
        sums.resize(picture.rgba.size());
        squares.resize(picture.rgba.size());
        for (std::size_t k = 1; k < picture.rgba.size(); k += 4)
        {
            const auto green = double(picture.rgba[k]);
            sums[k] += green;
            squares[k] += green * green;
        }
    }
    double variance = 0.0;
    for (std::size_t k = 1; k < sums.size(); k += 4)
    {
        const double mean = sums[k] / kSeeds;
        variance += (squares[k] - sums[k] * mean) / (kSeeds - 1) / (mean * mean + 1e-6);
    }
    return variance / (double(sums.size()) / 4.0);
}

} // namespace

TEST_CASE("sky portals: densities integrate to 1, and samples have them", "[integrators]")
{
    const SkyPortals portals = twoWindows();
    for (const Vec3 point : {Vec3(0, 0, 0), Vec3(1.7f, -0.3f, 1.4f), Vec3(-30, -20, 0.2f)})
    {
        double sum = 0.0;
        Vec3d mean(0.0);
        forSphere(
            [&](Vec3 wi, double solidAngle)
            {
                const double p = double(portals.chanceOf(point, wi).pdfW) * solidAngle;
                sum += p;
                mean += p * Vec3d(wi);
            });
        CAPTURE(point.x, sum);
        const double far = point.x < -20.0f ? 0.1 : 0.01; // few cells are in small angles
        CHECK(sum == Approx(1.0).epsilon(far));

        Vec3Lanes points, wi;
        for (int i = 0; i < kLanes; ++i)
            setLane(points, i, point);
        FloatLanes sums, choice, u, v, pdf;
        portals.weigh(points, sums);
        Vec3d sampled(0.0);
        constexpr int kBlocks = 4096;
        for (int block = 0; block < kBlocks; ++block)
        {
            for (int i = 0; i < kLanes; ++i)
            {
                const auto index = static_cast<uint32_t>(block * kLanes + i);
                sobol2(index, 7u, u[i], v[i]);
                sobol2(index, 11u, choice[i], pdf[i]);
            }
            portals.sample(points, sums, choice, u, v, wi);
            portals.pdfW(points, sums, wi, pdf);
            for (int i = 0; i < kLanes; ++i)
            {
                const Vec3 direction = laneOf(wi, i);
                sampled += Vec3d(direction) / (double(kBlocks) * kLanes);
                if (block % 64 > 0) continue;
                REQUIRE(glm::length(direction) == Approx(1.0f));
                CHECK(pdf[i] > 0.0f);
                CHECK(portals.chanceOf(point, direction).pdfW == Approx(pdf[i]).epsilon(1e-4));
            }
        }
        CHECK(glm::length(sampled - mean / sum) < (point.x < -20.0f ? 0.02 : 0.01));
    }
    CHECK_FALSE(portals.chanceOf({2.5f, 4, 1}, {-1, 0, 0}).inside);
}

TEST_CASE("sky portals: the density of beams integrates to 1", "[integrators]")
{
    const SkyPortals portals = twoWindows();
    for (const Vec3 towards : {Vec3(1, 0.3f, 0.5f), Vec3(1, -0.2f, 0.7f), Vec3(0.1f, 1, 0.4f)})
    {
        const Vec3 wi = glm::normalize(towards);
        double sum = 0.0;
        constexpr int kCells = 1600;
        constexpr double kWidth = 16.0 / kCells;
        for (int x = 0; x < kCells; ++x)
            for (int y = 0; y < kCells; ++y)
                sum += kWidth * kWidth *
                       double(portals.beamPdfA(Vec3(float(-9.0 + (x + 0.5) * kWidth),
                                                    float(-9.0 + (y + 0.5) * kWidth), 0.0f),
                                               wi, wi.z));
        CAPTURE(wi.x, wi.y);
        CHECK(sum == Approx(1.0).epsilon(0.01));
        for (int k = 0; k < 256; ++k)
        {
            float u, v;
            sobol2(static_cast<uint32_t>(k), 3u, u, v);
            const std::optional<Vec3> begin = portals.sampleBeam(wi, u, v);
            REQUIRE(begin);
            CHECK(portals.beamPdfA(*begin - 1.5f * wi, wi, 1.0f) > 0.0f);
        }
    }
    CHECK_FALSE(portals.sampleBeam(glm::normalize(Vec3(-1, -1, 0.2f)), 0.5f, 0.5f));
}

TEST_CASE("sky portals: openings are found where they are", "[integrators]")
{
    for (const bool second : {false, true})
    {
        Room room;
        room.turn = turned();
        room.build(second, true);
        room.addSunnySky();
        const auto portals = portalsOf(room.builder.build(), room.view(128, 96));
        REQUIRE(portals);
        REQUIRE(portals->rectangles().size() == (second ? 2u : 1u));
        for (const RectangleLight& r : portals->rectangles())
        {
            CHECK(r.width == Approx(1.0f).margin(0.12f));
            CHECK(r.height == Approx(1.0f).margin(0.12f));
            const PlainVec3 middle =
                mad(r.axisU, 0.5f * r.width, mad(r.axisV, 0.5f * r.height, r.corner));
            const Vec3 local = glm::transpose(room.turn) * Vec3(middle.x, middle.y, middle.z);
            const Vec3 normal =
                glm::transpose(room.turn) * Vec3(r.normal.x, r.normal.y, r.normal.z);
            const float wall = local.x > 2.0f ? 4.0f : 0.0f;
            CAPTURE(local.x, local.y, local.z);
            CHECK(local.x == Approx(wall).margin(0.1f));
            CHECK(local.y == Approx(2.5f).margin(0.05f));
            CHECK(local.z == Approx(1.5f).margin(0.05f));
            CHECK(normal.x == Approx(wall > 2.0f ? 1.0f : -1.0f).margin(1e-3f));
        }
    }
    Room closed, open, hall;
    hall.buildHall(false);
    hall.addSunnySky();
    CHECK_FALSE(portalsOf(hall.builder.build(), hall.view(128, 96)));
    closed.build(false, false);
    closed.addSunnySky();
    CHECK_FALSE(portalsOf(closed.builder.build(), closed.view(128, 96)));
    open.wall({0, 0, 0}, {4, 0, 0}, {0, 5, 0});
    open.wall({0, 0, 0}, {0, 5, 0}, {0, 0, 3});
    open.addSunnySky();
    CHECK_FALSE(portalsOf(open.builder.build(), open.view(128, 96)));
}

TEST_CASE("sky portals: ground outside an opening does not hide it", "[integrators]")
{
    Room room;
    room.turn = turned();
    room.build(false, true);
    room.wall({-98, -97.5f, -0.01f}, {200, 0, 0}, {0, 200, 0});
    room.addSunnySky();
    const auto traced = room.builder.build();
    const auto at = [&room](Vec3 p) { return Vec3d(room.turn * p); };
    const View down =
        perspectiveView(at({2.6f, 1.6f, 2.1f}), at({4, 2.5f, 1.4f}), at({0, 0, 1}), 60.0, 128, 96);
    for (const View& view : {room.view(128, 96), down})
    {
        const auto portals = portalsOf(traced, view);
        REQUIRE(portals);
        REQUIRE(portals->rectangles().size() == 1);
        const RectangleLight& r = portals->rectangles()[0];
        // Light comes from above alone, so that a plane farther out is about as good.
        CHECK(r.width == Approx(1.1f).margin(0.12f));
        CHECK(r.height == Approx(1.1f).margin(0.12f));
        const PlainVec3 middle =
            mad(r.axisU, 0.5f * r.width, mad(r.axisV, 0.5f * r.height, r.corner));
        const Vec3 local = glm::transpose(room.turn) * Vec3(middle.x, middle.y, middle.z);
        CAPTURE(local.x, local.y, local.z);
        CHECK(glm::length(local - Vec3(4.0f, 2.5f, 1.5f)) < 0.15f);
    }
}

TEST_CASE("sky portals: the mean of surfaces that know none, and much less noise",
          "[integrators][statistics][long]")
{
    const auto built = [](bool air, float sun)
    {
        Room room;
        room.build(false, true);
        room.addSunnySky(sun);
        if (air) setAtmosphere(room.builder, mediumOf(1e-9f, 0.0f), 30.0f);
        return room.builder.build();
    };
    const View view = Room().view(16, 16);
    const RenderOptions options = optionsOf(IntegratorKind::Path, 5);
    for (const float sun : {1.0f, 3000.0f})
    {
        const Estimate none = measure(built(true, sun), view, options, 512);
        const Estimate known = measure(built(false, sun), view, options, 128);
        const double error = std::hypot(none.standardError(), known.standardError());
        CAPTURE(sun, none.mean(), known.mean(), error);
        CHECK(std::abs(known.mean() - none.mean()) < 4.0 * error); // 6e-5 of all seeds fail
        CHECK(error < 0.01 * none.mean());
        // The gains of eight seeds, some 10 and 4, scatter by a few percent.
        const double variance = pixelVariance(built(false, sun), options);
        const double before = pixelVariance(built(true, sun), options);
        CAPTURE(variance, before, before / variance);
        CHECK(variance < 0.4 * before);
    }
}

TEST_CASE("sky portals: images that get many passes know them from the first one on",
          "[integrators][statistics]")
{
    Room room;
    room.build(false, true);
    room.addSunnySky();
    const auto traced = room.builder.build();
    const View view = room.view(16, 16);
    RenderOptions still = optionsOf(IntegratorKind::Path, 5);
    still.still = true;
    const Estimate two = measure(traced, view, still, 2);
    const Estimate many = measure(traced, view, optionsOf(IntegratorKind::Path, 5), 128);
    const double error = std::hypot(two.standardError(), many.standardError());
    CAPTURE(two.mean(), many.mean(), error);
    CHECK(std::abs(two.mean() - many.mean()) < 4.0 * error); // 6e-5 of all seeds fail
    const double variance = pixelVariance(traced, still, 2);
    const double before = pixelVariance(traced, optionsOf(IntegratorKind::Path, 5), 2);
    CAPTURE(variance, before);
    CHECK(variance < 0.5 * before);
}

TEST_CASE("sky portals: the mean is the same wherever the rectangles stand",
          "[integrators][statistics][long]")
{
    Room room;
    room.build(false, true);
    room.addSunnySky(1000.0f);
    const auto traced = room.builder.build();
    const View view = room.view(16, 16);
    const Estimate none = meanWith(*traced, view, nullptr, 192);
    const RectangleLight half = rectangle({4, 2, 1}, {0, 0.5f, 0}, {0, 0, 1});
    const RectangleLight large = rectangle({4.2f, 1.8f, 0.7f}, {0, 1.3f, 0}, {0, 0, 1.5f});
    const RectangleLight within = rectangle({3.3f, 2, 0.9f}, {0.4f, 0.8f, 0}, {0, 0, 1});
    const std::vector<std::vector<RectangleLight>> choices = {
        {half}, {large, half}, {within}, {rectangle({0, 1, 0}, {0, 0, 1}, {0, 1, 0})}};
    for (const std::vector<RectangleLight>& rectangles : choices)
    {
        const SkyPortals portals(rectangles);
        const Estimate known = meanWith(*traced, view, &portals, 96);
        const double error = std::hypot(none.standardError(), known.standardError());
        CAPTURE(rectangles.size(), none.mean(), known.mean(), error);
        CHECK(std::abs(known.mean() - none.mean()) < 4.0 * error); // 6e-5 of all seeds fail
        CHECK(error < 0.015 * none.mean());
    }
}

TEST_CASE("sky portals: pictures are equal for any number of threads", "[integrators]")
{
    Room room;
    room.build(false, true);
    room.addSunnySky();
    const auto traced = room.builder.build();
    const View view = room.view(48, 32);
    const Picture one = render(traced, view, optionsOf(IntegratorKind::Path, 5), 4, 1);
    CHECK(one.mean().y > 0.0f);
    for (const int threads : {2, 16})
        CHECK(render(traced, view, optionsOf(IntegratorKind::Path, 5), 4, threads).rgba ==
              one.rgba);
}
