// SkyPanesTest.cpp - panes in openings to the sky: means beside passes that know none, noise,
// threads.
// SPDX-License-Identifier: MIT
#include "tests/integrators/SkyRoom.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Adds a thin pane of this colour in the right opening, or so far within it.
void addPane(Room& room, Vec3 color = Vec3(1.0f), float within = 0.0f)
{
    Material pane = glass(1.5f);
    pane.baseColor = color;
    MaterialDetail thin;
    thin.thinWalled = true;
    pane.detail = std::make_shared<MaterialDetail>(thin);
    room.builder.add(quadMesh(room.turn * Vec3(4.0f - within, 2, 1), room.turn * Vec3(0, 1, 0),
                              room.turn * Vec3(0, 0, 1)),
                     pane);
}

/// Checks that two estimates are of the same mean, which is known to 1.5 %.
void checkMeans(const Estimate& one, const Estimate& other)
{
    const double error = std::hypot(one.standardError(), other.standardError());
    CAPTURE(one.mean(), one.standardError(), other.mean(), other.standardError());
    CHECK(std::abs(one.mean() - other.mean()) < 4.0 * error); // 6e-5 of all seeds fail
    CHECK(error < 0.015 * one.mean());
}

struct Sill
{
    std::string name;
    Mat3 turn{1.0f};
    Vec3 color{1.0f};       ///< of the pane
    bool second = false;    ///< whether there is a pane within
    bool isBrushed = false; ///< whether the sill is of metal
};

} // namespace

TEST_CASE("sky panes: the mean behind a pane with a sill on both sides",
          "[integrators][statistics][long]")
{
    Room room;
    room.build(false, true);
    room.wall({3.8f, 2, 1}, {0.6f, 0, 0}, {0, 1, 0});
    addPane(room);
    room.addSunnySky(1000.0f);
    const auto traced = room.builder.build();
    const View view = room.view(16, 16);
    const SkyPortals portals({rectangle({4.4f, 1.9f, 0.9f}, {0, 1.2f, 0}, {0, 0, 1.4f})});
    checkMeans(meanWith(*traced, view, nullptr, 192), meanWith(*traced, view, &portals, 96));
}

TEST_CASE("sky panes: the sun is mirrored to what stands outside",
          "[integrators][statistics][long]")
{
    const std::vector<Sill> sills = {{"clear"},
                                     {"turned", turned()},
                                     {"tinted", Mat3(1.0f), {0.9f, 0.5f, 0.7f}},
                                     {"two panes", Mat3(1.0f), Vec3(1.0f), true},
                                     {"brushed", Mat3(1.0f), Vec3(1.0f), false, true}};
    for (const Sill& sill : sills)
    {
        Room room;
        room.turn = sill.turn;
        room.build(false, true);
        if (sill.isBrushed)
        {
            room.material = mirror(Vec3(0.6f));
            room.material.roughness = 0.5f;
        }
        room.wall({4, 1, 1}, {0.6f, 0, 0}, {0, 3, 0});
        addPane(room, sill.color);
        if (sill.second) addPane(room, sill.color, 0.1f);
        room.addSunnySky(sill.isBrushed ? 200.0f : 20000.0f);
        const auto traced = room.builder.build();
        const auto at = [&room](Vec3 p) { return Vec3d(room.turn * p); };
        const View view =
            perspectiveView(at({7, 2.5f, 4}), at({4.2f, 2.5f, 1}), at({0, 0, 1}), 12.0, 16, 16);
        const std::vector<RectangleLight> rectangles = {rectangle(
            room.turn * Vec3(4, 2, 1), room.turn * Vec3(0, 1, 0), room.turn * Vec3(0, 0, 1))};
        TileCounts counts;
        const std::vector<PaneSide> sides = panesOf(contextOf(*traced, view), rectangles, counts);
        CAPTURE(sill.name);
        REQUIRE(sides.size() == 1);
        CHECK(glm::dot(sides[0].normal, room.turn * Vec3(1, 0, 0)) == Approx(1.0f));
        CHECK(sides[0].has(room.turn * Vec3(4.1f, 0, 0)));
        CHECK_FALSE(sides[0].has(room.turn * Vec3(3.8f, 0, 0)));
        const SkyPortals without(rectangles), with(rectangles, true, sides);
        const Estimate chance = meanWith(*traced, view, &without, 384);
        const Estimate known = meanWith(*traced, view, &with, 96);
        const double error = std::hypot(chance.standardError(), known.standardError());
        CAPTURE(chance.mean(), chance.standardError(), known.mean(), known.standardError());
        CHECK(std::abs(known.mean() - chance.mean()) < 4.0 * error); // 6e-5 of all seeds fail
        // Metal finds the mirrored sun by its own samples; the inner of two panes is left to paths.
        if (!sill.isBrushed && !sill.second)
            CHECK(known.standardError() < 0.5 * chance.standardError());
    }
}

TEST_CASE("sky panes: what is hardly brighter than the mean of the sky is left to paths",
          "[integrators]")
{
    // The density of samples of this sky is below 0.5 a steradian, and near the horizon 0.
    const auto softSky = [](Vec3d direction)
    { return Vec3(static_cast<float>(1.0 + std::max(0.0, direction.z))); };
    for (const bool isSunny : {false, true})
    {
        Room room;
        room.build(false, true);
        room.wall({4, 1, 1}, {0.6f, 0, 0}, {0, 3, 0});
        addPane(room);
        room.addSunnySky();
        if (!isSunny)
            room.builder.scene->lights.back().environment.image = newEnvironment(64, 32, softSky);
        const auto traced = room.builder.build();
        const View view = perspectiveView({7, 2.5, 4}, {4.2, 2.5, 1}, {0, 0, 1}, 12.0, 16, 16);
        const std::vector<RectangleLight> rectangles = {rectangle({4, 2, 1}, {0, 1, 0}, {0, 0, 1})};
        TileCounts counts;
        const std::vector<PaneSide> sides = panesOf(contextOf(*traced, view), rectangles, counts);
        REQUIRE(sides.size() == 1);
        const SkyPortals without(rectangles), with(rectangles, true, sides);
        const Estimate paths = meanWith(*traced, view, &without, 2);
        const Estimate known = meanWith(*traced, view, &with, 2);
        CAPTURE(isSunny, paths.mean(), known.mean());
        CHECK((paths.mean() == known.mean()) == !isSunny);
    }
}

TEST_CASE("sky panes: pictures are equal for any number of threads", "[integrators]")
{
    Room room;
    room.build(false, true);
    room.wall({4, 1, 1}, {0.6f, 0, 0}, {0, 3, 0});
    addPane(room);
    room.addSunnySky();
    const auto traced = room.builder.build();
    const View view = room.view(48, 32);
    RenderOptions options = optionsOf(IntegratorKind::Path, 5);
    options.still = true;
    const Picture one = render(traced, view, options, 4, 1);
    CHECK(one.mean().y > 0.0f);
    for (const int threads : {2, 16})
        CHECK(render(traced, view, options, 4, threads).rgba == one.rgba);
}
