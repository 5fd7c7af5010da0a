// PassPartsTest.cpp - passes that are made apart, or with interruptions, add up to the same bits.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"

#include <memory>
#include <string>
#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kPasses = 19; // more than those on which photons depend

/// The Cornell box with a ball of glass, which makes caustics, and a view that its walls do not
/// fill: some pixels meet no surface in the first passes.
std::shared_ptr<const TracedScene> ballScene()
{
    static const std::shared_ptr<const TracedScene> scene = []
    {
        SceneBuilder builder = cornellBox();
        builder.add(sphereMesh(Vec3(300.0f, 420.0f, 150.0f), 80.0f, 8), glass(1.5f));
        return builder.build();
    }();
    return scene;
}

RenderOptions ballOptions(IntegratorKind kind)
{
    RenderOptions options = optionsOf(kind, 4);
    options.photons = 3000;
    return options;
}

std::unique_ptr<RenderSession> newSession(IntegratorKind kind, int threads)
{
    auto session = std::make_unique<RenderSession>(std::make_shared<Workers>(threads));
    session->setScene(ballScene());
    View view = cornellView(37, 29);
    view.clipFromView = glm::scale(Mat4d(1.0), Vec3d(0.6, 0.6, 1.0)) * view.clipFromView;
    session->setView(view);
    session->setOptions(ballOptions(kind));
    session->setSums(FilmSums::Exact);
    return session;
}

/// Makes the passes from first to end, first those of sums if there are any.
PassSums made(IntegratorKind kind, int first, int end, int threads,
              const PassSums* before = nullptr)
{
    const auto session = newSession(kind, threads);
    session->setFirstPass(first);
    if (before) session->resume(*before);
    StopRule rule;
    rule.passes = end;
    const RenderProgress progress = session->render(rule);
    CHECK(progress.status.ok());
    const std::optional<PassSums> sums = session->passSums();
    REQUIRE(sums);
    CHECK(progress.passes == sums->passes.count());
    return *sums;
}

bool areEqual(const PassSums& a, const PassSums& b)
{
    return a.passes == b.passes && a.low == b.low && a.high == b.high && a.depth == b.depth;
}

struct Case
{
    const char* name;
    IntegratorKind kind;
};

const Case kCases[] = {{"whitted", IntegratorKind::Whitted},
                       {"path", IntegratorKind::Path},
                       {"ppm", IntegratorKind::Ppm},
                       {"sppm", IntegratorKind::Sppm},
                       {"photon-caustics", IntegratorKind::PhotonCaustics}};

} // namespace

TEST_CASE("parts: passes of several sessions are those of one, in any order", "[session][parts]")
{
    for (const Case& c : kCases)
    {
        CAPTURE(c.name);
        const PassSums whole = made(c.kind, 0, kPasses, 1);
        // The passes on which later ones depend, 16, end within the second part.
        const int cuts[][2] = {{0, 2}, {2, 17}, {17, kPasses}};
        for (const auto& order : {std::vector<int>{0, 1, 2}, {2, 0, 1}})
        {
            PassSums sums;
            for (const int part : order)
            {
                const PassSums more = made(c.kind, cuts[part][0], cuts[part][1], part + 1);
                if (sums.width == 0)
                    sums = more;
                else
                    addSums(more, sums);
            }
            CHECK(areEqual(sums, whole));
        }
    }
}

TEST_CASE("parts: an image that goes on from its sums is that without interruption",
          "[session][parts]")
{
    for (const Case& c : kCases)
    {
        CAPTURE(c.name);
        const PassSums whole = made(c.kind, 0, kPasses, 2);
        for (const int cut : {1, 5, 17})
        {
            const PassSums before = made(c.kind, 0, cut, 1);
            CHECK(areEqual(made(c.kind, 0, kPasses, 3, &before), whole));
        }
        // The sums of other passes have holes, which are filled.
        const PassSums middle = made(c.kind, 3, 6, 1);
        CHECK(areEqual(made(c.kind, 0, kPasses, 2, &middle), whole));
        // Nothing is left to do.
        CHECK(areEqual(made(c.kind, 0, kPasses, 1, &whole), whole));
    }
}

TEST_CASE("parts: a pass that was only learnt from is made for the film later, and is the same",
          "[session][parts]")
{
    const auto madeInOrder = [](std::vector<int> order)
    {
        const auto session = newSession(IntegratorKind::Sppm, 2);
        std::size_t next = 0;
        StopRule rule;
        rule.nextPass = [&] { return next < order.size() ? order[next++] : -1; };
        CHECK(session->render(rule).status.ok());
        const std::optional<PassSums> sums = session->passSums();
        REQUIRE(sums);
        CHECK(sums->passes.count() == int(order.size()));
        return *sums;
    };
    const PassSums sweep = madeInOrder({3, 5, 20});
    for (const auto& order : {std::vector<int>{20, 5, 3}, {5, 20, 3}, {3, 20, 5}})
        CHECK(areEqual(madeInOrder(order), sweep));
}

TEST_CASE("parts: a cancelled pass has no sums until it is whole", "[session][parts]")
{
    for (const Case& c : kCases)
    {
        CAPTURE(c.name);
        const auto session = newSession(c.kind, 2);
        StopRule few;
        few.passes = kPasses;
        few.newTiles = 4; // of 6 tiles
        for (int call = 0; call < 3 * kPasses; ++call)
        {
            session->render(few);
            const bool whole = session->tilesLeft() == 6;
            CHECK(session->passSums().has_value() == whole);
        }
        CHECK(areEqual(*session->passSums(), made(c.kind, 0, kPasses, 1)));
    }
}

TEST_CASE("parts: learning passes that are cut short are made again", "[session][parts]")
{
    for (const IntegratorKind kind : {IntegratorKind::Sppm, IntegratorKind::PhotonCaustics})
    {
        const auto session = newSession(kind, 2);
        session->setFirstPass(17);
        StopRule few;
        few.passes = kPasses;
        few.newTiles = 4;
        // A call that ends within a learning pass gets no further.
        session->render(few);
        CHECK(session->progress().passes == 0);
        StopRule all;
        all.passes = kPasses;
        session->render(all);
        CHECK(areEqual(*session->passSums(), made(kind, 17, kPasses, 1)));
    }
}

TEST_CASE("parts: sums of another size begin no image", "[session][parts]")
{
    const auto session = newSession(IntegratorKind::Path, 1);
    PassSums other = made(IntegratorKind::Path, 0, 1, 1);
    other.width = 29;
    other.height = 37;
    session->resume(other);
    StopRule one;
    one.passes = 1;
    CHECK(session->render(one).status.code == StatusCode::InvalidView);
    CHECK(session->render(one).status.ok());
}

TEST_CASE("parts: exact images are the fast ones but for rounding", "[session][parts]")
{
    for (const Case& c : kCases)
    {
        CAPTURE(c.name);
        const auto fast = newSession(c.kind, 2), exact = newSession(c.kind, 2);
        fast->setSums(FilmSums::Fast);
        StopRule rule;
        rule.passes = kPasses;
        fast->render(rule);
        exact->render(rule);
        CHECK_FALSE(fast->passSums());
        const std::vector<float> a = fast->resolveRadiance(), b = exact->resolveRadiance();
        REQUIRE(a.size() == b.size());
        for (std::size_t i = 0; i < a.size(); ++i)
            REQUIRE(std::fabs(a[i] - b[i]) <= 1e-6f * (1.0f + std::fabs(b[i])));
    }
}
