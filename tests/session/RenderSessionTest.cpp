// RenderSessionTest.cpp - restart, continue, stop, cancel, and the effects of bad views.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

/// A session that is ready to render the Cornell box.
struct BoxSession
{
    explicit BoxSession(IntegratorKind kind = IntegratorKind::Path, int size = 40, int threads = 2)
        : traced(cornellBox().build()), session(std::make_shared<Workers>(threads))
    {
        session.setScene(traced);
        session.setView(cornellView(size, size));
        session.setOptions(optionsOf(kind, 3));
    }

    RenderProgress renderTo(int passes)
    {
        StopRule rule;
        rule.passes = passes;
        return session.render(rule);
    }

    std::shared_ptr<const TracedScene> traced;
    RenderSession session;
};

} // namespace

TEST_CASE("session: passes add up over calls to the same image as in one call", "[session]")
{
    BoxSession steps, whole;
    const RenderProgress first = steps.renderTo(3);
    CHECK(first.status.ok());
    CHECK(first.restarted);
    CHECK(first.passes == 3);
    const RenderProgress second = steps.renderTo(7);
    CHECK_FALSE(second.restarted);
    CHECK(second.passes == 7);
    CHECK(steps.renderTo(5).passes == 7); // this number has been reached
    const RenderProgress all = whole.renderTo(7);
    CHECK(steps.session.resolveRadiance() == whole.session.resolveRadiance());
    CHECK(second.rays.camera == all.rays.camera);
    CHECK(second.rays.shadow == all.rays.shadow);
    CHECK(second.rays.secondary == all.rays.secondary);
    CHECK(all.rays.camera >= 40u * 40u * 7u);
    CHECK(all.droppedSamples == 0);
    CHECK(all.integrator == IntegratorKind::Path);
    CHECK(all.seconds > 0.0);
}

TEST_CASE("session: a new scene, view or option restarts; the same ones do not",
          "[session][stability 51]")
{
    BoxSession box;
    box.renderTo(2);
    const std::vector<float> before = box.session.resolveRadiance();

    box.session.setScene(box.traced);
    box.session.setView(cornellView(40, 40));
    box.session.setOptions(optionsOf(IntegratorKind::Path, 3));
    CHECK_FALSE(box.renderTo(2).restarted);

    View moved = cornellView(40, 40);
    moved.viewFromWorld[3][0] += 20.0;
    box.session.setView(moved);
    CHECK(box.renderTo(2).restarted);
    CHECK(box.session.resolveRadiance() != before);
    box.session.setView(cornellView(40, 40));
    CHECK(box.renderTo(2).restarted);
    CHECK(box.session.resolveRadiance() == before); // the view came back

    box.session.setOptions(optionsOf(IntegratorKind::Path, 3, 1));
    CHECK(box.renderTo(2).restarted);
    CHECK(box.session.resolveRadiance() != before);

    box.session.setScene(cornellBox().build());
    box.session.setOptions(optionsOf(IntegratorKind::Path, 3));
    CHECK(box.renderTo(2).restarted);
    CHECK(box.session.resolveRadiance() == before); // an equal scene gives an equal image
}

TEST_CASE("session: stops at the estimated error that was asked for", "[session]")
{
    BoxSession box;
    StopRule rule;
    rule.passes = 4096;
    rule.relativeError = 0.12;
    std::vector<double> errors;
    const RenderProgress progress = box.session.render(rule,
                                                       [&](const RenderProgress& p)
                                                       {
                                                           errors.push_back(p.error.relative);
                                                           return true;
                                                       });
    CHECK(progress.status.ok());
    CHECK(progress.error.relative <= 0.12);
    CHECK(progress.error.relative == box.session.estimateError().relative);
    CHECK(progress.passes > 2);
    CHECK(progress.passes < 4096);
    CHECK(errors.front() ==
          std::numeric_limits<double>::infinity()); // one pass does not tell its error
    for (const double error : errors)
        CHECK(error > 0.12); // rendering stopped once the error was reached
}

TEST_CASE("session: errors that end nothing are those of 4 / 5 of the passes", "[session]")
{
    BoxSession box;
    StopRule rule;
    rule.passes = 41;
    std::vector<double> shown, real;
    const RenderProgress progress =
        box.session.render(rule,
                           [&](const RenderProgress& p)
                           {
                               shown.push_back(p.error.relative);
                               real.push_back(box.session.estimateError().relative);
                               return true;
                           });
    REQUIRE(shown.size() == 41);
    int different = 0;
    for (std::size_t i = 0; i < shown.size(); ++i)
    {
        const auto first = real.begin() + static_cast<std::ptrdiff_t>(i * 4 / 5);
        const auto end = real.begin() + static_cast<std::ptrdiff_t>(i + 1);
        CHECK(std::find(first, end, shown[i]) != end);
        different += i > 0 && shown[i] != shown[i - 1];
    }
    CHECK(different < 20);
    CHECK(progress.error.relative == real.back());
}

TEST_CASE("session: stops when its time is over, or when told to", "[session]")
{
    BoxSession box;
    StopRule rule;
    rule.seconds = 0.05;
    const RenderProgress timed = box.session.render(rule);
    CHECK(timed.status.ok());
    CHECK(timed.passes >= 1);

    int calls = 0;
    StopRule endless;
    const RenderProgress told =
        box.session.render(endless, [&](const RenderProgress&) { return ++calls < 3; });
    CHECK(told.passes == timed.passes + 3);
    CHECK(calls == 3);
}

TEST_CASE("session: cancelled again and again, the image is still that of an uninterrupted render",
          "[session]")
{
    constexpr int kPasses = 40;
    BoxSession calm(IntegratorKind::Path, 100), disturbed(IntegratorKind::Path, 100);
    calm.renderTo(kPasses);

    std::atomic<bool> done{false};
    std::thread disturber(
        [&]
        {
            while (!done)
            {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                disturbed.session.cancel();
            }
        });
    int cancelled = 0, largest = 0;
    // The loop ends: a tile that is begun is finished, so each call adds some tiles.
    for (int call = 0; call < 1000000 && disturbed.session.progress().passes < kPasses; ++call)
    {
        const RenderProgress progress = disturbed.renderTo(kPasses);
        cancelled += progress.status.code == StatusCode::Cancelled;
        CHECK((progress.status.ok() || progress.status.code == StatusCode::Cancelled));
        CHECK(progress.passes >= largest);
        largest = progress.passes;
    }
    done = true;
    disturber.join();
    disturbed.renderTo(kPasses);
    CHECK(cancelled > 0);
    CHECK(disturbed.session.progress().passes == kPasses);
    CHECK(disturbed.session.resolveRadiance() == calm.session.resolveRadiance());
    CHECK(disturbed.session.progress().rays.total() == calm.session.progress().rays.total());
}

TEST_CASE("session: without a scene, or with an empty one, there is a status or the background",
          "[session][stability 21]")
{
    RenderSession session(std::make_shared<Workers>(1));
    CHECK(session.render(StopRule()).status.code == StatusCode::EmptyScene);
    CHECK(session.resolveRadiance().empty());
    CHECK(session.resolveChannel(Channel::Normal).empty());

    for (const IntegratorKind kind :
         {IntegratorKind::Path, IntegratorKind::Whitted, IntegratorKind::Debug})
    {
        SceneBuilder empty;
        const Picture picture = render(empty.build(), cornellView(20, 10), optionsOf(kind), 2);
        CHECK(picture.progress.status.ok());
        CHECK(picture.rgba == std::vector<float>(20 * 10 * 4, 0.0f));
        CHECK(picture.progress.droppedSamples == 0);
    }
}

TEST_CASE("session: a scene without lights is black, and covered", "[session][stability 21]")
{
    SceneBuilder builder;
    builder.add(quadMesh({-1000, -1000, 0}, {5000, 0, 0}, {0, 5000, 0}), lambert(Vec3(0.7f)));
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
    {
        const Picture picture = render(builder.build(), cornellView(20, 20), optionsOf(kind), 2);
        CHECK(picture.mean() == Vec3(0.0f));
        CHECK(picture.rgba[3] == 1.0f);
    }
}

TEST_CASE("session: a view that cannot be rendered is reported, and the last image stays",
          "[session][stability 20]")
{
    BoxSession box;
    box.renderTo(2);
    const std::vector<float> before = box.session.resolveRadiance();
    View bad[4] = {cornellView(40, 40), cornellView(40, 40), cornellView(40, 40),
                   cornellView(40, 40)};
    bad[0].width = 0;
    bad[1].height = -1;
    bad[2].clipFromView = Mat4d(0.0);
    bad[3].viewFromWorld[1][1] = std::numeric_limits<double>::quiet_NaN();
    for (const View& view : bad)
    {
        box.session.setView(view);
        const RenderProgress progress = box.renderTo(4);
        CHECK(progress.status.code == StatusCode::InvalidView);
        CHECK_FALSE(progress.status.message.empty());
        CHECK(box.session.resolveRadiance() == before);
        CHECK(box.session.width() == 40);
    }
    View huge = cornellView(40, 40);
    huge.width = 1 << 15;
    huge.height = (1 << 13) + 1;
    box.session.setView(huge);
    CHECK(box.renderTo(4).status.code == StatusCode::OutOfMemory);
    CHECK(box.session.resolveRadiance() == before);

    box.session.setView(cornellView(40, 40));
    const RenderProgress progress = box.renderTo(4);
    CHECK(progress.status.ok());
    CHECK_FALSE(progress.restarted);
    CHECK(progress.passes == 4);
}

TEST_CASE("session: images of any shape", "[session][stability 20]")
{
    const auto traced = cornellBox().build();
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 4096), std::pair(33, 17)})
    {
        for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
        {
            const Picture picture =
                render(traced, cornellView(width, height), optionsOf(kind, 3), 2);
            CHECK(picture.progress.status.ok());
            CHECK(picture.rgba.size() == static_cast<std::size_t>(4 * width * height));
            CHECK(picture.progress.droppedSamples == 0);
        }
    }
}

TEST_CASE("session: camera inside a thing, or on a surface", "[session][stability 22]")
{
    SceneBuilder builder = cornellBox();
    builder.add(boxMesh(Vec3(200.0f), Vec3(300.0f)), glass(1.5f));
    const auto traced = builder.build();
    for (const Vec3d& eye : {Vec3d(250.0), Vec3d(250.0, 0.0, 250.0), Vec3d(300.0, 548.7, 280.0)})
    {
        for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
        {
            const View view =
                perspectiveView(eye, eye + Vec3d(0.3, 0.1, 1.0), {0, 1, 0}, 60.0, 32, 32);
            const Picture picture = render(traced, view, optionsOf(kind), 4);
            CHECK(picture.progress.status.ok());
            CHECK(picture.progress.droppedSamples == 0);
        }
    }
}
