// KeptLimitsTest.cpp - what views at rest keep in mirrors, at most, and at their next move.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/history/ChangedSight.h"
#include "osgRayTrace/session/history/SharedChange.h"

#include "tests/Catch.h"
#include "tests/session/KeptYard.h"

#include <cmath>
#include <thread>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("kept view: what differs between two versions is found once for all views", "[session]")
{
    const Yard yard;
    const auto before = traced(yard.at(0.0f)), after = traced(yard.at(0.5f)),
               other = traced(yard.at(20.0f));
    const std::shared_ptr<const SceneChange> change = sharedChange(before, after);
    REQUIRE(change);
    CHECK(change->boxes.size() == 1);
    const std::shared_ptr<const SceneChange> large = sharedChange(before, other);
    CHECK(large->boxes.size() == 2);
    CHECK(sharedChange(before, after) == change);
    CHECK(sharedChange(after, before) != change);
    auto darker = std::make_shared<Scene>(*yard.at(0.0f));
    darker->lights.pop_back();
    CHECK_FALSE(sharedChange(before, traced(darker)));

    std::shared_ptr<const SceneChange> found[4];
    std::vector<std::thread> threads;
    for (auto& result : found)
        threads.emplace_back([&] { result = sharedChange(after, other); });
    for (std::thread& thread : threads)
        thread.join();
    REQUIRE(found[0]);
    for (const auto& result : found)
        CHECK(result == found[0]);
}

namespace
{

/// Returns the pixels that show the right part of a mirror at y = 9 that is 24 wide and 9 high.
std::vector<std::size_t> mirrorPixels()
{
    const PixelRays rays = *pixelRays(yardView());
    const CameraRays& c = rays.rays;
    std::vector<std::size_t> pixels;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
        {
            const float px = float(x) + 0.5f, py = float(y) + 0.5f;
            const Vec3 start = Vec3(rays.pole) + c.origin + px * c.originDx + py * c.originDy;
            const Vec3 direction = c.direction + px * c.directionDx + py * c.directionDy;
            const Vec3 p = start + (9.0f - start.y) / direction.y * direction;
            if (direction.y > 0.0f && p.x > -5.0f && p.x < 11.0f && p.z > 0.5f && p.z < 8.5f)
                pixels.push_back(static_cast<std::size_t>(y * kWidth + x));
        }
    return pixels;
}

} // namespace

TEST_CASE("kept view: a mirror keeps little, and nothing where it shows the box", "[session]")
{
    Yard yard;
    yard.builder.add(quadMesh({-12, 9, 0}, {24, 0, 0}, {0, 0, 9}), mirror(Vec3(0.9f)));
    const auto before = yard.at(-2.0f), after = yard.at(2.0f);
    const TwoPasts pasts(before, after);
    const std::vector<float> old = fresh(before, 5, 256), now = fresh(after, 5, 256);
    const std::vector<uint8_t> box = pixelsOf(yard.box, after); // it takes its samples along
    int changed = 0, ghosts = 0;
    for (std::size_t i = 0; i < old.size() / 4; ++i)
    {
        // One pixel of the mirror sees the box's edge and changes by 0.31: its look may miss it.
        const bool differs =
            std::abs(brightness(old, i) - brightness(now, i)) > 0.35f * brightness(now, i);
        changed += differs;
        ghosts += differs && !box[i] && pasts.tellApart(i);
    }
    CHECK(changed > 60);
    CHECK(ghosts == 0);

    // Elsewhere the old passes of a mirror weigh no more than four of five samples. What is new in
    // the two pictures is the same.
    constexpr float kOldWeight = 0.8f;
    int mixed = 0, tooOld = 0;
    for (const std::size_t i : mirrorPixels())
    {
        const float step = std::abs(brightness(pasts.kept[0], i) - brightness(pasts.kept[1], i));
        const float whole = std::abs(brightness(pasts.last[0], i) - brightness(pasts.last[1], i));
        mixed += step > 0.3f * whole && whole > 0.001f;
        tooOld += step > kOldWeight * whole + 1e-5f;
    }
    CHECK(mixed > 50);
    CHECK(tooOld == 0);
}

TEST_CASE("kept view: what a kept version has of the view's own is told at the next move",
          "[session]")
{
    const Yard yard;
    const View moved = perspectiveView({1, -30, 14}, {0, 0, 1}, {0, 0, 1}, 40.0, kWidth, kHeight);
    for (const bool follows : {false, true})
    {
        Watcher watcher(traced(yard.at(0.0f)));
        watcher.inputs.reprojects = true;
        for (int frame = 0; frame < 4; ++frame)
            watcher.show();
        auto painted = std::make_shared<Scene>(*yard.at(0.0f));
        Material& paint = painted->materials[painted->instances[yard.box].material];
        paint.mapping.coordinates =
            follows ? TextureCoordinates::ReflectionMap : TextureCoordinates::Position;
        paint.changed = 9;
        watcher.show(painted);
        CHECK(watcher.share() > 0.3);
        watcher.show(moved);
        CHECK((watcher.share() == 0.0) == follows);
    }
}

TEST_CASE("kept view: nothing is kept where more boxes and lights meet than can be looked at",
          "[session]")
{
    // Each of the boxes takes one small step.
    const auto sceneOf = [](int boxes, int lights, float step, float apart)
    {
        Yard yard;
        for (int i = 0; i < boxes; ++i)
        {
            const float x = -20.0f + apart * float(i % 16), y = 40.0f + apart * float(i / 16);
            yard.builder.add(boxMesh({0, 0, 0}, {0.1f, 0.1f, 0.1f}), lambert(Vec3(0.5f)));
            Instance& instance = yard.builder.scene->instances.back();
            instance.placed = true;
            instance.engineFromLocal.translation = Vec3(x + step, y, 0.0f);
        }
        for (int i = 1; i < lights; ++i)
            yard.builder.addLight(yard.builder.scene->lights[0]);
        return yard.at(0.0f);
    };
    const auto shareOf = [&](int boxes, int lights, float apart)
    {
        auto before = sceneOf(boxes, lights, 0.0f, apart);
        auto after = std::make_shared<Scene>(*before);
        const auto moved = sceneOf(boxes, lights, 0.01f, apart);
        for (std::size_t i = 0; i < after->instances.size(); ++i)
            after->instances[i].engineFromLocal = moved->instances[i].engineFromLocal;
        Watcher watcher(traced(before));
        watcher.show();
        watcher.show(after);
        return watcher.share();
    };
    constexpr int kLights = 7, kBoxes = int(kMostLooks) / (1 + kLights);
    CHECK(shareOf(kBoxes, kLights, 1.0f) > 0.3);
    CHECK(shareOf(kBoxes + 1, kLights, 1.0f) == 0.0);

    // The limits of samples are found tile by tile. If more than kMostTileLooks changed boxes and
    // shadows concern a tile, it is divided into quarters, and so on. A pixel keeps no samples if
    // that many concern the last part around it.
    const double few = shareOf(int(kMostTileLooks) / 4, 1, 0.2f),
                 many = shareOf(2 * int(kMostTileLooks), 1, 0.2f),
                 most = shareOf(7 * int(kMostTileLooks), 1, 0.1f);
    INFO(few << " " << many << " " << most);
    CHECK(few > 0.95);
    CHECK(many > 0.9);
    CHECK(many < 0.99);
    CHECK(most < 0.95);
}
