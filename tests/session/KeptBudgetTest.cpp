// KeptBudgetTest.cpp - a view at rest under a budget, in whose scene a little moves, stays at full
// resolution.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/session/BudgetScreen.h"

#include <algorithm>
#include <cmath>
#include <memory>

using namespace osgRayTrace;
using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// Returns the Cornell box with a small cube that floats at height y.
struct Room
{
    Room() { cube = builder.add(boxMesh({100, 0, 200}, {125, 25, 225}), lambert(Vec3(0.6f))); }

    std::shared_ptr<const TracedScene> at(float y) const
    {
        auto scene = std::make_shared<Scene>(*builder.scene);
        scene->instances[cube].placed = true;
        scene->instances[cube].engineFromLocal.translation = Vec3(0.0f, y, 0.0f);
        return TracedScene::build(scene, std::make_shared<Workers>(1));
    }

    SceneBuilder builder = cornellBox();
    uint32_t cube = 0;
};

} // namespace

TEST_CASE("frame budget: a cube that moves in a view at rest leaves full resolution", "[session]")
{
    const Room room;
    for (const bool keeps : {true, false})
    {
        Screen screen;
        screen.inputs.keepsUnchanged = keeps;
        screen.inputs.maxPasses = 1000;
        screen.inputs.scene = room.at(100.0f);
        for (int i = 0; i < 20; ++i)
            screen.frame(0.0);
        REQUIRE(screen.shown.width == kWidth);
        int whole = 0;
        std::size_t lacks = 0;
        for (int i = 0; i < 30; ++i)
        {
            screen.inputs.scene = room.at(100.0f + 4.0f * float(i));
            screen.frame(0.0);
            CAPTURE(keeps, i);
            CHECK(screen.tracer.frame().seconds < 1.1 * kBudget);
            REQUIRE(screen.tracer.hasImage());
            whole += screen.shown.width == kWidth && screen.tracer.frame().divider == 1;
            for (const float depth : screen.shown.depth)
                lacks += !(depth > 0.0f && depth < 1.0f); // the room fills the view
        }
        CHECK(whole == (keeps ? 30 : 0));
        CHECK(lacks == 0);
    }
}

TEST_CASE("frame budget: each tile has a pass every few frames while a cube moves", "[session]")
{
    const Room room;
    Screen screen;
    screen.inputs.keepsUnchanged = true;
    screen.inputs.maxPasses = 1000;
    screen.inputs.scene = room.at(100.0f);
    for (int i = 0; i < 20; ++i)
        screen.frame(0.0);
    const std::vector<float> first = screen.tracer.radiance();
    for (int i = 0; i < 40; ++i)
    {
        screen.inputs.scene = room.at(100.0f + 2.0f * float(i));
        screen.frame(0.0);
        REQUIRE(screen.tracer.progress().passes == 0); // there is no time for a whole pass
    }
    const std::vector<float> last = screen.tracer.radiance();
    REQUIRE(first.size() == last.size());
    int stale = 0;
    for (int y = 8; y < kHeight; y += kTileSize)
        for (int x = 8; x < kWidth; x += kTileSize)
        {
            const auto i = 4 * std::size_t(y * kWidth + x);
            stale += first[i] == last[i] && first[i + 1] == last[i + 1];
        }
    CHECK(stale == 0);
    // At rest the pass is completed, and more passes follow.
    for (int i = 0; i < 12; ++i)
        screen.frame(0.0);
    CHECK(screen.tracer.progress().passes >= 2);
}

TEST_CASE("frame budget: a view that stops before a moving cube gets its full resolution",
          "[session]")
{
    const Room room;
    Screen screen;
    screen.inputs.keepsUnchanged = true;
    screen.inputs.maxPasses = 1000;
    for (int i = 0; i < 10; ++i)
    {
        screen.inputs.scene = room.at(100.0f + 2.0f * float(i));
        screen.frame(i);
    }
    REQUIRE(screen.tracer.frame().divider > 1);
    int slow = 0;
    for (int i = 10; i < 30; ++i)
    {
        screen.inputs.scene = room.at(100.0f + 2.0f * float(i));
        screen.frame(10.0);
        slow += screen.tracer.frame().seconds > 1.1 * kBudget;
    }
    CHECK(screen.tracer.frame().divider == 1);
    CHECK(slow <= 2); // the first whole pass, and the frame in which the surfaces are looked for
}

TEST_CASE("frame budget: what is kept is denoised with the tiles that have no pass", "[session]")
{
    const Room room;
    Screen screen;
    screen.inputs.keepsUnchanged = true;
    screen.inputs.denoise = DenoiseKind::Filter;
    screen.inputs.maxPasses = 1000;
    screen.inputs.scene = room.at(100.0f);
    for (int i = 0; i < 20; ++i)
        screen.frame(0.0);
    for (int i = 0; i < 4; ++i)
    {
        screen.inputs.scene = room.at(100.0f + 4.0f * float(i));
        screen.frame(0.0);
    }
    REQUIRE(screen.tracer.progress().passes == 0);
    REQUIRE(screen.resolved);
    CHECK(screen.shown.width == kWidth);
    double sum = 0.0;
    int black = 0;
    const std::vector<float> image = screen.tracer.radiance();
    const std::vector<float> reference =
        render(screen.inputs.scene, viewAt(0.0), screen.inputs.options, 64).rgba;
    REQUIRE(image.size() == reference.size());
    for (std::size_t i = 0; i < image.size(); i += 4)
    {
        sum += image[i] - reference[i];
        black += !(image[i + 3] > 0.0f);
    }
    CHECK(black == 0);
    CHECK(std::abs(sum) < 0.02 * double(image.size()) / 4.0);
}

TEST_CASE("frame budget: views that agree keep nothing", "[session]")
{
    const Room room;
    for (const bool agrees : {true, false})
    {
        double clock = 0.0;
        ViewTracer tracer([&clock] { return clock += kTile; });
        ViewInputs inputs;
        inputs.options.integrator = IntegratorKind::Path;
        inputs.keepsUnchanged = true;
        inputs.maxPasses = 1000;
        inputs.workers = std::make_shared<Workers>(1);
        inputs.photons = std::make_shared<PhotonPasses>();
        FrameBudget budget;
        budget.seconds = kBudget;
        if (agrees) budget.agreement = std::make_shared<FrameAgreement>();
        const View view = reducedView(viewAt(0.0), 4);
        double share = 0.0;
        for (int i = 0; i < 12; ++i)
        {
            inputs.scene = room.at(100.0f + float(i / 2));
            budget.frameNumber = static_cast<uint64_t>(i) + 1;
            tracer.trace(inputs, view, budget);
            share = std::max(share, tracer.progress().stages.reprojectedShare);
            tracer.recordPresented();
        }
        CHECK((share > 0.0) == !agrees);
    }
}
