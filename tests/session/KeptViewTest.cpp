// KeptViewTest.cpp - a view at rest keeps samples where nothing near has changed, and no others.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Statistics.h"
#include "tests/session/KeptYard.h"

#include <cmath>
#include <functional>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

double squaredError(const std::vector<float>& picture, const std::vector<float>& reference)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.size(); ++i)
        if (i % 4 != 3)
            sum += (double(picture[i]) - reference[i]) * (double(picture[i]) - reference[i]);
    return sum / (0.75 * double(picture.size()));
}

} // namespace

TEST_CASE("kept view: what differs between two scenes is told by boxes, or not at all", "[session]")
{
    const Yard yard;
    const auto before = yard.at(0.0f);
    const auto differs = [&](const std::function<void(Scene&)>& edit)
    {
        auto after = std::make_shared<Scene>(*before);
        edit(*after);
        return sceneChange(*before, *after);
    };
    const auto none = differs([](Scene& scene) { scene.changed = 7; });
    REQUIRE(none);
    CHECK(none->boxes.empty());

    // A small step makes one box, a large one two.
    const auto step = sceneChange(*before, *yard.at(0.5f));
    REQUIRE(step);
    REQUIRE(step->boxes.size() == 1);
    CHECK(step->instances == std::vector<uint32_t>{yard.box});
    CHECK(glm::length(step->boxes[0].low - Vec3(-1, -1, 0)) < 1e-5f);
    CHECK(glm::length(step->boxes[0].high - Vec3(1.5f, 1, 2)) < 1e-5f);
    CHECK(sceneChange(*before, *yard.at(20.0f))->boxes.size() == 2);

    const auto turned = differs(
        [&](Scene& scene)
        {
            const float s = std::sqrt(0.5f);
            scene.instances[yard.box].engineFromLocal.linear =
                Mat3(Vec3(s, s, 0), Vec3(-s, s, 0), Vec3(0, 0, 1));
        });
    REQUIRE((turned && turned->boxes.size() == 1));
    CHECK(turned->boxes[0].high.x == Approx(std::sqrt(2.0f)));

    const auto gone = differs([](Scene& scene) { scene.instances.pop_back(); });
    REQUIRE((gone && gone->boxes.size() == 1));
    const auto came = sceneChange(
        *before,
        *[&]
        {
            auto after = std::make_shared<Scene>(*before);
            after->instances.push_back(after->instances[1]);
            return after;
        }());
    REQUIRE((came && came->boxes.size() == 1));
    CHECK(came->boxes[0].low == Vec3(-9, 6, 0));
    const auto painted = differs([](Scene& scene) { scene.materials[1].changed = 9; });
    CHECK((painted && painted->boxes.size() == 1));

    CHECK_FALSE(differs([](Scene& scene) { scene.lights[0].changed = 9; }));
    CHECK_FALSE(differs([](Scene& scene) { scene.lights.pop_back(); }));
    CHECK_FALSE(differs([](Scene& scene) { scene.background.x += 0.1f; }));
    CHECK_FALSE(differs([](Scene& scene) { scene.origin.x += 1.0; }));
    CHECK_FALSE(differs(
        [&](Scene& scene)
        {
            scene.instances[yard.box].light = 0;
            scene.instances[yard.box].engineFromLocal.translation.x += 1.0f;
        }));
    CHECK_FALSE(differs(
        [](Scene& scene) {
            scene.instances.resize(scene.instances.size() + kMostChanged + 1, scene.instances[1]);
        }));
}

TEST_CASE("kept view: a box that moves leaves no ghost, and takes its shadow along", "[session]")
{
    const Yard yard;
    const auto before = yard.at(-2.0f), after = yard.at(2.0f);
    const TwoPasts pasts(before, after);
    CHECK(pasts.share > 0.5);
    CHECK(pasts.share < 0.99);
    // Where the box was or is, and where its shadow was or is, there are new samples alone, but for
    // what the box takes along.
    const std::vector<float> old = fresh(before, 5, 64), now = fresh(after, 5, 64);
    const std::vector<uint8_t> box = pixelsOf(yard.box, after); // it takes its samples along
    int changed = 0, ghosts = 0, mixed = 0;
    for (std::size_t i = 0; i < old.size() / 4; ++i)
    {
        // Sixty-four passes tell the sun's shadow and the red box from noise.
        const bool differs =
            std::abs(brightness(old, i) - brightness(now, i)) > 0.3f * brightness(now, i);
        changed += differs;
        ghosts += differs && !box[i] && pasts.tellApart(i);
        mixed += pasts.tellApart(i);
    }
    CHECK(changed > 40);
    CHECK(ghosts == 0);
    CHECK(mixed > kWidth * kHeight / 2);
}

TEST_CASE("kept view: frames in which a box moves have a small part of the error", "[session]")
{
    const Yard yard;
    Watcher keeping(traced(yard.at(0.0f))), restarting(traced(yard.at(0.0f)), false);
    showMovingBox(yard, keeping, restarting);
    const auto last = yard.at(2.0f);
    const std::vector<float> reference = fresh(last, 9, 256);
    const double kept = squaredError(keeping.show(last), reference),
                 plain = squaredError(restarting.show(last), reference);
    INFO(plain << " to " << kept);
    CHECK(kept < 0.25 * plain);
    CHECK(restarting.share() == 0.0);
    // The estimate is of the new passes alone and never less than the error.
    CHECK(keeping.tracer.progress().error.relative == std::numeric_limits<double>::infinity());
    keeping.show();
    CHECK(keeping.tracer.progress().error.relative >
          std::sqrt(squaredError(keeping.tracer.radiance(), reference)));
}

TEST_CASE("kept view: at rest what was kept fades, and the image is that of a fresh start",
          "[session]")
{
    const Yard yard;
    for (const int maxPasses : {1 << 20, 21})
    {
        Watcher watcher(traced(yard.at(0.0f)));
        watcher.inputs.maxPasses = maxPasses;
        for (int frame = 0; frame < 12; ++frame)
            watcher.show(yard.at(0.3f * float(frame)));
        REQUIRE(watcher.share() > 0.3);
        const int passes = std::min(maxPasses, 2 * static_cast<int>(ViewHistory::kMostKept) + 1);
        for (int pass = 2; pass <= passes; ++pass)
            watcher.show();
        CHECK(watcher.tracer.progress().passes == passes);
        CHECK(watcher.share() == 0.0);
        // The eleventh change of the scene takes the eleventh sequence of random numbers.
        CHECK((watcher.tracer.radiance() == fresh(yard.at(0.3f * 11.0f), 11, passes)));
    }
}

TEST_CASE("kept view: all that is not a few objects restarts", "[session]")
{
    const Yard yard;
    const auto moved = yard.at(0.3f);
    const auto check = [&](const std::shared_ptr<const Scene>& scene,
                           const std::function<void(Watcher&)>& edit, const View& view = yardView())
    {
        Watcher watcher(traced(yard.at(0.0f)));
        for (int frame = 0; frame < 4; ++frame)
            watcher.show();
        edit(watcher);
        watcher.inputs.scene = traced(scene);
        const std::vector<float> picture = watcher.show(view);
        Watcher other(watcher.inputs.scene);
        other.inputs.options = watcher.inputs.options;
        CHECK(watcher.share() == 0.0);
        CHECK((picture == other.show(view)));
    };
    const auto nothing = [](Watcher&) {};
    auto brighter = std::make_shared<Scene>(*moved);
    brighter->lights[0].diffuse *= 2.0f;
    brighter->lights[0].changed = 3;
    check(brighter, nothing);
    auto sky = std::make_shared<Scene>(*moved);
    sky->lights[1].environment.image = newEnvironment(2, 2, Vec3(0.8f));
    sky->lights[1].changed = 3;
    check(sky, nothing);
    auto repainted = std::make_shared<Scene>(*moved);
    for (Material& material : repainted->materials)
    {
        material.baseColor *= 0.5f;
        material.changed = 3; // of the floor as well: most of the image
    }
    check(repainted, nothing);
    check(moved, [](Watcher& watcher) { watcher.inputs.keepsUnchanged = false; });
    check(moved, [](Watcher& watcher) { watcher.inputs.maxPasses = 2; });
    check(moved, [](Watcher& watcher) { watcher.inputs.options.maxBounces = 2; });
    for (const IntegratorKind kind : {IntegratorKind::Debug, IntegratorKind::Sppm})
        check(moved,
              [kind](Watcher& watcher)
              {
                  watcher.inputs.options.integrator = kind;
                  watcher.show();
              });
    check(moved, nothing,
          perspectiveView({1, -30, 14}, {0, 0, 1}, {0, 0, 1}, 40.0, kWidth, kHeight));
    check(moved, nothing, perspectiveView({0, -30, 14}, {0, 0, 1}, {0, 0, 1}, 40.0, 64, 48));
}

TEST_CASE("kept view: equal bits for one and two threads", "[session]")
{
    // The pole goes past behind the box: their windows overlap.
    const Yard yard;
    const auto sceneAt = [&](int frame)
    {
        const auto t = static_cast<float>(frame);
        const auto scene = yard.at(0.4f * t);
        Instance& pole = scene->instances[yard.box - 1];
        pole.placed = true;
        pole.engineFromLocal.translation = Vec3(9.0f - 0.2f * t, -2.0f, 0.0f);
        return scene;
    };
    const auto begin = traced(sceneAt(0));
    Watcher one(begin, true, 3, 1), two(begin, true, 3, 2);
    for (int frame = 0; frame < 6; ++frame)
    {
        const auto scene = sceneAt(frame);
        const std::vector<float> picture = one.show(scene);
        REQUIRE(picture == two.show(scene));
        REQUIRE(one.rgba == two.rgba);
    }
    CHECK(one.share() > 0.3);
}

TEST_CASE("kept view: the mean around a box that moves stays what it is", "[session][statistics]")
{
    // Sixteen walks of eight frames; a false alarm has a probability of 1e-3, see Estimate::agrees.
    // Pixels that have become darker count as negative, so that whatever is stale adds up. What the
    // box hides of the sky may be stale by 1 % of the brightness.
    const Yard yard;
    const auto last = yard.at(1.4f);
    const std::vector<float> first = fresh(yard.at(0.0f), 77, 128), now = fresh(last, 77, 128),
                             reference = fresh(last, 78, 256);
    const auto meanOf = [&](const std::vector<float>& picture)
    {
        double sum = 0.0, pixels = 0.0;
        for (std::size_t i = 0; i < picture.size() / 4; ++i)
        {
            const float difference = brightness(first, i) - brightness(now, i);
            if (std::abs(difference) < 0.15f * brightness(now, i)) continue;
            sum += (difference > 0.0f ? 1.0 : -1.0) * brightness(picture, i) / brightness(now, i);
            pixels += 1.0;
        }
        REQUIRE(pixels > 30.0);
        return sum / pixels;
    };
    Estimate mean;
    for (unsigned seed = 0; seed < 16; ++seed)
    {
        Watcher watcher(traced(yard.at(0.0f)), true, seed);
        for (int frame = 0; frame < 7; ++frame)
            watcher.show(yard.at(0.2f * float(frame)));
        mean.add(meanOf(watcher.show(last)));
    }
    const double expected = meanOf(reference);
    INFO(mean.mean() << " +- " << mean.standardError() << " for " << expected);
    CHECK(mean.agrees(expected, 0.01));
}
