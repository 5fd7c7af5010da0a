// ReprojectionTest.cpp - samples land where their surfaces are in the other view, and nowhere else.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/Reprojection.h"

#include "osgRayTrace/base/Parallel.h"
#include "tests/Catch.h"
#include "tests/session/PlaneSights.h"

#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <string>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE(
    "reprojection: what is on a plane lands where it is in any view, to a fraction of a pixel",
    "[session]")
{
    using MakeView = View (*)(Vec3d, Vec3d, int, int);
    const MakeView perspective = [](Vec3d eye, Vec3d centre, int width, int height) {
        return perspectiveView(eye, centre, {0, 1, 0}, 40.0, width, height);
    };
    struct Case
    {
        std::string name;
        MakeView view;
        Vec3d origin{0.0};
    };
    const double earth = 6.4e6;
    for (const Case& c : {Case{"perspective", perspective}, Case{"off-axis", offAxisView},
                          Case{"orthographic", orthographicView}, Case{"infinite", infiniteView},
                          Case{"on the earth", perspective, {earth, -earth, 0.5 * earth}}})
    {
        INFO(c.name);
        const auto sight = [&](Vec3d eye, Vec3d centre)
        { return look(c.view(c.origin + eye, c.origin + centre, 101, 77), {kWall}, c.origin); };
        const Sight from = sight({0.2, 0.3, 6}, {0, 0, 0});
        // The view is moved, turned and nearer.
        const Sight to = sight({0.237, 0.281, 5.9}, {0.1, 0.05, 0});
        const SampledImage result = carry(imageOf(from, waves, 8.0f), from, to);
        int taken = 0, full = 0, off = 0;
        double largest = 0.0, unmoved = 0.0;
        for (std::size_t i = 0; i < to.seen.size(); ++i)
        {
            if (result.count[i] == 0.0f) continue;
            ++taken;
            full += result.count[i] == Approx(8.0f).epsilon(1e-4); // not at the old image's rim
            const Vec3 expected = waves(to.seen[i]), before = waves(from.seen[i]);
            for (int k = 0; k < 3; ++k)
            {
                const float carried = result.radiance[4 * i + static_cast<std::size_t>(k)];
                const double error = std::abs(carried - expected[k]);
                largest = std::max(largest, error);
                off += error > 0.03;
                unmoved = std::max(unmoved, double(std::abs(before[k] - expected[k])));
            }
        }
        // The waves have a slope of 0.26 a pixel. Cubics lose a hundredth of them, and bilinear
        // means at the image's rim lose more.
        CHECK(largest < 0.12);
        CHECK(off < 0.03 * 3.0 * taken);
        CHECK(unmoved > 0.2);
        CHECK(taken > 0.8 * double(to.seen.size()));
        CHECK(full > 0.97 * taken);
    }
}

TEST_CASE("reprojection: a view that does not change changes nothing", "[session]")
{
    for (const auto& [width, height] :
         {std::pair(1, 1), {1, 9}, {7, 1}, {17, 3}, {64, 48}, {101, 77}})
    {
        const Sight sight = look(
            perspectiveView({0.2, 0.3, 6}, {0, 0, 0}, {0, 1, 0}, 40.0, width, height), {kWall});
        const SampledImage image = imageOf(sight, waves, 3.0f);
        const SampledImage result = carry(image, sight, sight);
        REQUIRE(result.width == width);
        REQUIRE(result.height == height);
        for (std::size_t i = 0; i < image.count.size(); ++i)
        {
            REQUIRE(result.count[i] == Approx(3.0f).epsilon(1e-3));
            for (std::size_t k = 4 * i; k < 4 * i + 4; ++k)
                REQUIRE(std::abs(result.radiance[k] - image.radiance[k]) < 2e-4f);
        }
    }
}

TEST_CASE("reprojection: what a bar hid has no history, and none of the bar's", "[session]")
{
    for (const uint32_t barObject : {1u, 2u}) // 1 is the wall's own object
    {
        const PlanePart bar{
            {0, 0, 1.5}, {0, 0, 1}, barObject, [](Vec3d p) { return std::abs(p.x) < 0.4; }};
        const auto sight = [&](double x) {
            return look(perspectiveView({x, 0, 6}, {x, 0, 0}, {0, 1, 0}, 40.0, 160, 90),
                        {kWall, bar});
        };
        const auto isBar = [](const Seen& seen) { return seen.point.z > 1.0; };
        const Texture3 colors = [&](const Seen& seen)
        { return isBar(seen) ? Vec3(1, 0, 0) : Vec3(0, 1, 0); };
        const Sight from = sight(0.0);
        for (const double move : {0.13, 0.5, -0.6})
        {
            INFO("object " << barObject << ", move " << move);
            const Sight to = sight(move);
            const SampledImage result = carry(imageOf(from, colors, 16.0f), from, to);
            int hidden = 0, kept = 0, lost = 0;
            for (std::size_t i = 0; i < to.seen.size(); ++i)
            {
                const Seen& seen = to.seen[i];
                const float red = result.radiance[4 * i], green = result.radiance[4 * i + 1];
                // This is the x at which the line from the point to the old eye (0, 0, 6) passes z
                // = 1.5.
                const double x = seen.point.x * (1.0 - 1.5 / 6.0);
                // The bar and the wall keep their own colours; at the rim of the old image there
                // are no samples.
                if (!isBar(seen))
                {
                    REQUIRE(red == 0.0f);
                    if (std::abs(x) < 0.4)
                    {
                        ++hidden;
                        REQUIRE(result.count[i] == 0.0f);
                        REQUIRE(green == 0.0f);
                    }
                    else if (std::abs(x) > 0.5 && std::abs(x) < 1.0)
                        (result.count[i] > 0.0f ? kept : lost) += 1;
                }
                else
                    REQUIRE(green == 0.0f);
            }
            CHECK(hidden > 200 * std::abs(move));
            CHECK(kept > 500);
            // Only pixels that border on the bar in the new view are lost.
            CHECK(lost < 0.05 * kept);
        }
    }
}

TEST_CASE("reprojection: pixels that border on other surfaces give nothing to those that do not",
          "[session]")
{
    // The pixels beside the bar are mixtures of both surfaces, as in renders.
    const PlanePart bar{{0, 0, 1.5}, {0, 0, 1}, 2, [](Vec3d p) { return std::abs(p.x) < 0.4; }};
    const auto sight = [&](double x) {
        return look(perspectiveView({x, 0, 6}, {x, 0, 0}, {0, 1, 0}, 40.0, 160, 90), {kWall, bar});
    };
    const Sight from = sight(0.0), to = sight(0.21);
    SampledImage image = imageOf(
        from, [](const Seen& seen) { return seen.object == 2 ? Vec3(1, 0, 0) : Vec3(0, 1, 0); },
        16.0f);
    for (std::size_t i = 1; i + 1 < from.seen.size(); ++i)
        for (const std::size_t k : {i - 1, i + 1})
            if (from.seen[i].object == 1 && from.seen[k].object == 2) image.radiance[4 * i] = 0.5f;
    const SurfaceMap map = mapOf(to);
    const SampledImage result = carry(image, from, to);
    int smooth = 0, edges = 0;
    for (std::size_t i = 0; i < to.seen.size(); ++i)
    {
        if (to.seen[i].object != 1) continue;
        (map.smooth[i] ? smooth : edges) += 1;
        if (map.smooth[i])
            REQUIRE(result.radiance[4 * i] == 0.0f);
        else
            REQUIRE(result.count[i] <= ReprojectionLimits().edgeCount);
    }
    CHECK(smooth > 5000);
    CHECK(edges >= 180);
}

TEST_CASE(
    "reprojection: surfaces of other normals, other objects and other places are not the same",
    "[session]")
{
    const View before = perspectiveView({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 40.0, 64, 48);
    const View after = perspectiveView({0.05, 0, 6}, {0.05, 0, 0}, {0, 1, 0}, 40.0, 64, 48);
    const Sight from = look(before, {kWall});
    const auto shareOf = [&](const Sight& to)
    {
        SampledImage result;
        return reproject(imageOf(from, waves, 8.0f), mapOf(from), mapOf(to), {}, Workers(1),
                         result);
    };
    CHECK(shareOf(look(after, {kWall})) > 0.95);

    Sight turned = look(after, {kWall}), slightly = turned;
    for (SurfaceSample& sample : turned.samples)
        sample.normal = Vec3(std::sin(0.5f), 0.0f, std::cos(0.5f)); // 0.88
    CHECK(shareOf(turned) == 0.0);
    for (SurfaceSample& sample : slightly.samples)
        sample.normal = Vec3(std::sin(0.2f), 0.0f, std::cos(0.2f));
    CHECK(shareOf(slightly) > 0.95);

    Sight other = look(after, {kWall});
    for (SurfaceSample& sample : other.samples)
        sample.object = 2;
    CHECK(shareOf(other) == 0.0);

    // A pixel is 2 tan(20 degrees) 6 / 48 = 0.09 wide at the wall.
    CHECK(shareOf(look(after, {PlanePart{{0, 0, 0.5}, {0, 0, 1}}})) == 0.0);
    CHECK(shareOf(look(after, {PlanePart{{0, 0, -0.5}, {0, 0, 1}}})) == 0.0);
    CHECK(shareOf(look(after, {PlanePart{{0, 0, 0.05}, {0, 0, 1}}})) > 0.95);

    // The view is cut to another side or to another place.
    CHECK(shareOf(look(perspectiveView({0, 0, -6}, {0, 0, -20}, {0, 1, 0}, 40.0, 64, 48),
                       {PlanePart{{0, 0, -12}, {0, 0, 1}}})) == 0.0);
    CHECK(shareOf(look(perspectiveView({50, 0, 6}, {50, 0, 0}, {0, 1, 0}, 40.0, 64, 48),
                       {kWall})) == 0.0);
}

TEST_CASE("reprojection: mirrors keep what was seen from the same place alone, glossy surfaces "
          "less of it",
          "[session]")
{
    const auto sight = [](Vec3d eye, float turn, float lobe)
    {
        PlanePart wall = kWall;
        wall.lobe = lobe;
        return look(perspectiveView(eye, eye + Vec3d(turn, 0, -6), {0, 1, 0}, 40.0, 64, 48),
                    {wall});
    };
    const auto countOf = [&](const Sight& from, const Sight& to, float turn = 0.0f)
    {
        ReprojectionLimits limits;
        limits.turn = turn;
        return carry(imageOf(from, waves, 100.0f), from, to, 1, limits).count[24 * 64 + 32];
    };
    const float most = ReprojectionLimits().count;
    for (const float lobe : {0.0f, 0.3f, kInfinity})
    {
        INFO(lobe);
        const Sight from = sight({0, 0, 6}, 0.0f, lobe);
        CHECK(countOf(from, from) == most);
        CHECK(countOf(from, sight({0, 0, 6}, 0.1f, lobe)) == most); // turned
        // The eye has moved aside by 0.06 / 6 = 0.01 radians as seen from the point.
        const float moved = countOf(from, sight({0.06, 0, 6}, 0.0f, lobe));
        CHECK(moved == Approx(lobe < 1.0f ? 0.5f * lobe / 0.01f : most).epsilon(0.02));
        CHECK(countOf(from, from, 0.02f) ==
              Approx(lobe < 1.0f ? 0.5f * lobe / 0.02f : most).epsilon(0.02));
    }
}

TEST_CASE("reprojection: the background is far away", "[session]")
{
    const auto sight = [](Vec3d eye, Vec3d towards) {
        return look(perspectiveView(eye, eye + towards, {0, 1, 0}, 40.0, 64, 48), {});
    };
    const Sight from = sight({0, 0, 6}, {0, 0, -1}), to = sight({9, 4, -6}, {0.05, 0.02, -1});
    SampledImage image{64, 48, {}, std::vector<float>(64 * 48, 5.0f)};
    for (std::size_t i = 0; i < image.count.size(); ++i)
        image.radiance.insert(image.radiance.end(),
                              {static_cast<float>(i % 64), static_cast<float>(i / 64), 0.0f, 0.0f});
    const SampledImage result = carry(image, from, to);
    // The centre ray of the new view is given in pixels of the old one: 24 / tan(20 degrees) a unit
    // of slope.
    const double scale = 24.0 / std::tan(20.0 * 3.14159265358979 / 180.0);
    const std::size_t centre = 24 * 64 + 32; // half a pixel right of the centre and above it
    CHECK(result.count[centre] == 5.0f);
    CHECK(result.radiance[4 * centre] == Approx(32.0 + 0.05 * scale).margin(0.1));
    CHECK(result.radiance[4 * centre + 1] == Approx(24.0 + 0.02 * scale).margin(0.1));
}

TEST_CASE("reprojection: what is not finite does not spread", "[session]")
{
    Sight from = look(perspectiveView({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 40.0, 64, 48), {kWall});
    Sight to = look(perspectiveView({0.05, 0.02, 6}, {0, 0, 0}, {0, 1, 0}, 40.0, 64, 48), {kWall});
    SampledImage image = imageOf(from, waves, 8.0f);
    const float nan = std::nanf("");
    image.radiance[4 * (10 * 64 + 10)] = nan;
    image.radiance[4 * (20 * 64 + 30) + 2] = kInfinity;
    image.count[30 * 64 + 40] = nan;
    from.samples[15 * 64 + 20].distance = nan;
    from.samples[15 * 64 + 40].normal = Vec3(nan);
    to.samples[40 * 64 + 20].distance = nan;
    to.samples[40 * 64 + 30].distance = 0.0f;
    const SampledImage result = carry(image, from, to);
    int empty = 0;
    for (std::size_t i = 0; i < result.count.size(); ++i)
    {
        REQUIRE(std::isfinite(result.count[i]));
        empty += result.count[i] == 0.0f;
        for (std::size_t k = 4 * i; k < 4 * i + 4; ++k)
        {
            REQUIRE(std::isfinite(result.radiance[k]));
            if (result.count[i] == 0.0f) REQUIRE(result.radiance[k] == 0.0f);
        }
    }
    CHECK(empty >= 2);
    CHECK(empty < 64 + 48 + 100);
}

TEST_CASE("reprojection: any number of threads gives the same image", "[session]")
{
    const PlanePart bar{{0, 0, 1.5}, {0, 0, 1}, 2, [](Vec3d p) { return std::abs(p.x) < 0.4; }};
    const auto sight = [&](double x) {
        return look(perspectiveView({x, 0, 6}, {x, 0, 0}, {0, 1, 0}, 40.0, 133, 71), {kWall, bar});
    };
    const Sight from = sight(0.0), to = sight(0.3);
    const SampledImage image = imageOf(from, waves, 8.0f);
    const SampledImage one = carry(image, from, to, 1), four = carry(image, from, to, 4);
    CHECK(std::memcmp(one.radiance.data(), four.radiance.data(), 4 * one.radiance.size()) == 0);
    CHECK(one.count == four.count);
}

TEST_CASE("reprojection: frames of a moving view blur little", "[session]")
{
    // A motion of half a pixel a frame is the worst; a sample lives for 32 frames at most.
    const double pixel = 2.0 * std::tan(20.0 * 3.14159265358979 / 180.0) * 6.0 / 90.0;
    const auto sight = [&](int frame)
    {
        const double x = 0.5 * pixel * frame;
        return look(perspectiveView({x, 0, 6}, {x, 0, 0}, {0, 1, 0}, 40.0, 160, 90), {kWall});
    };
    const double period = 12.0 * pixel;
    const auto stripes = [&](const Seen& seen)
    { return Vec3(static_cast<float>(1.0 + 0.5 * std::sin(6.283185307 * seen.point.x / period))); };
    Sight from = sight(0);
    SampledImage image = imageOf(from, stripes, 32.0f);
    for (int frame = 1; frame <= 32; ++frame)
    {
        const Sight to = sight(frame);
        image = carry(image, from, to);
        from = to;
    }
    // The contrast is compared with that of the stripes as the image's own pixels have them.
    const SampledImage exact = imageOf(from, stripes, 1.0f);
    double kept = 0.0, all = 0.0;
    for (std::size_t x = 40; x < 100; ++x)
    {
        const std::size_t i = 4 * (45 * 160 + x);
        kept += (image.radiance[i] - 1.0) * (exact.radiance[i] - 1.0);
        all += (exact.radiance[i] - 1.0) * (exact.radiance[i] - 1.0);
    }
    // Cubics keep (9 cos(w/2) - cos(3w/2)) / 8 a frame of a wave of w radians a pixel, and bilinear
    // means keep cos(w/2).
    const double w = 6.283185307 / 12.0;
    const double expected = std::pow((9.0 * std::cos(0.5 * w) - std::cos(1.5 * w)) / 8.0, 32.0);
    CHECK(expected > 0.9);
    CHECK(kept / all == Approx(expected).margin(0.01));
}
