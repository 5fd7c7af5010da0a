// ViewRegistryTest.cpp - which passes are the same view. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/ViewRegistry.h"

#include "tests/Catch.h"

#include <glm/gtc/matrix_transform.hpp>

using namespace osgRayTrace::engine;

namespace
{

using Registry = ViewRegistry<int>;

std::shared_ptr<int> acquire(Registry& registry, const PassIdentity& pass)
{
    return registry.acquire(pass, [] { return std::make_shared<int>(0); }).state;
}

/// Returns one of several objects that stand for cameras and stages.
HostName nameOf(int number)
{
    static const std::vector<int> objects(16);
    return {std::shared_ptr<const void>(), &objects[std::size_t(number)]};
}

PassIdentity pass(int camera, int stage, uint64_t frame, std::array<int, 4> viewport = {0, 0, 8, 8})
{
    PassIdentity identity;
    identity.camera = nameOf(camera);
    identity.renderStage = nameOf(stage);
    identity.frameNumber = frame;
    identity.viewport = viewport;
    return identity;
}

/// Returns the view of an eye, with the given near and far planes.
View viewAt(double eye, double near = 1.0, double far = 100.0)
{
    View view;
    view.width = view.height = 8;
    view.viewFromWorld[3][0] = eye;
    view.clipFromView = glm::frustum(-0.1 * near, 0.2 * near, -0.1 * near, 0.1 * near, near, far);
    // The rays are the same, digit by digit, whatever the near plane.
    view.clipFromView[0][0] = view.clipFromView[1][1] = 7.0;
    view.clipFromView[2][0] = 0.25;
    view.clipFromView[2][1] = 0.0;
    return view;
}

PassIdentity at(PassIdentity identity, const View& view)
{
    identity.view = view;
    return identity;
}

Registry::Pass acquireSlice(Registry& registry, const PassIdentity& pass)
{
    return registry.acquire(pass, [] { return std::make_shared<int>(0); });
}

} // namespace

TEST_CASE("view registry: a camera keeps its state, others have theirs", "[session]")
{
    Registry registry;
    const auto a = acquire(registry, pass(0, 0, 1));
    const auto b = acquire(registry, pass(1, 1, 1));
    CHECK(a != b);
    CHECK(acquire(registry, pass(0, 0, 2)) == a);
    CHECK(acquire(registry, pass(1, 1, 2)) == b);

    PassIdentity otherContext = pass(0, 0, 2);
    otherContext.contextId = 1;
    CHECK(acquire(registry, otherContext) != a);
}

TEST_CASE("view registry: eyes are told apart by the order of their render stages", "[session]")
{
    Registry registry;
    const auto left = acquire(registry, pass(0, 0, 1));
    const auto right = acquire(registry, pass(0, 1, 1));
    CHECK(left != right);
    // osgViewer's threaded renderers alternate two sets of stages.
    CHECK(acquire(registry, pass(0, 2, 2)) == left);
    CHECK(acquire(registry, pass(0, 3, 2)) == right);
    CHECK(acquire(registry, pass(0, 0, 3)) == left);
    CHECK(acquire(registry, pass(0, 1, 3)) == right);
    CHECK(registry.states().size() == 2u);
}

TEST_CASE("view registry: without frame numbers views stay the same", "[session]")
{
    Registry registry;
    const auto left = acquire(registry, pass(0, 0, 0));
    const auto right = acquire(registry, pass(0, 1, 0));
    for (int i = 0; i < 500; ++i)
    {
        REQUIRE(acquire(registry, pass(0, 0, 0)) == left);
        REQUIRE(acquire(registry, pass(0, 1, 0)) == right);
    }
}

TEST_CASE("view registry: a resized viewport keeps the state, two viewports have two", "[session]")
{
    Registry registry;
    const auto a = acquire(registry, pass(0, 0, 1));
    CHECK(acquire(registry, pass(0, 0, 2, {0, 0, 9, 9})) == a);
    CHECK(registry.states().size() == 1u);

    const auto b = acquire(registry, pass(0, 0, 2, {9, 0, 9, 9}));
    CHECK(b != a);
    CHECK(acquire(registry, pass(0, 0, 3, {0, 0, 9, 9})) == a);
    CHECK(acquire(registry, pass(0, 0, 3, {9, 0, 9, 9})) == b);
}

TEST_CASE("view registry: what is no longer drawn expires, whatever the frame numbers", "[session]")
{
    Registry registry;
    std::weak_ptr<int> gone = acquire(registry, pass(0, 0, 1));
    // There are two viewers, each with its own frame numbers, far apart.
    const auto a = acquire(registry, pass(1, 1, 1000000));
    const auto b = acquire(registry, pass(2, 2, 7));
    for (uint64_t i = 1; i < 2 * Registry::kExpiry; ++i)
    {
        REQUIRE(acquire(registry, pass(1, 1, 1000000 + i)) == a);
        REQUIRE(acquire(registry, pass(2, 2, 7 + i)) == b);
        if (i == Registry::kExpiry / 2) CHECK_FALSE(gone.expired());
    }
    CHECK(gone.expired());
    CHECK(registry.states().size() == 2u);
}

TEST_CASE("view registry: an eye that does not draw leaves the other one its image", "[session]")
{
    Registry registry;
    const auto left = acquire(registry, at(pass(0, 0, 1), viewAt(-0.03)));
    const auto right = acquire(registry, at(pass(0, 1, 1), viewAt(0.03)));
    CHECK(acquire(registry, at(pass(0, 1, 2), viewAt(0.03))) == right); // the left one is not drawn
    CHECK(acquire(registry, at(pass(0, 0, 3), viewAt(-0.03))) == left);
    CHECK(acquire(registry, at(pass(0, 1, 3), viewAt(0.03))) == right);
    // While the head moves, eyes are told apart by their order.
    CHECK(acquire(registry, at(pass(0, 0, 4), viewAt(-0.02))) == left);
    CHECK(acquire(registry, at(pass(0, 1, 4), viewAt(0.04))) == right);
    CHECK(registry.states().size() == 2u);
}

TEST_CASE("view registry: what a pass draws several times has a view for each", "[session]")
{
    Registry registry;
    std::vector<std::shared_ptr<int>> first;
    for (int i = 0; i < 3; ++i)
        first.push_back(acquire(registry, at(pass(0, 0, 1), viewAt(i))));
    CHECK(registry.states().size() == 3u);
    // The views are at rest, then they move, and each is found again.
    for (uint64_t frame = 2; frame < 6; ++frame)
        for (int i = 0; i < 3; ++i)
            CHECK(acquire(registry, at(pass(0, 0, frame), viewAt(i + 10.0 * (frame / 3)))) ==
                  first[static_cast<std::size_t>(i)]);
    // Tiles of a large picture are drawn without a new frame, and their views do not pile up.
    for (int tile = 0; tile < 100; ++tile)
        acquire(registry, at(pass(0, 0, 6), viewAt(1000.0 + tile)));
    CHECK(registry.states().size() <= Registry::kMostTimes);
}

TEST_CASE("view registry: slices of an eye's depths share its state, eyes do not", "[session]")
{
    // Cameras 1 and 2 are slices; each is drawn for both eyes.
    Registry registry;
    const View far = viewAt(-1.0, 10.0, 100.0), near = viewAt(-1.0, 1.0, 10.0);
    const View rightFar = viewAt(1.0, 10.0, 100.0), rightNear = viewAt(1.0, 1.0, 10.0);
    std::shared_ptr<int> left, right;
    for (const uint64_t frame : {1u, 2u, 3u, 0u, 0u, 0u}) // 0: the viewer counts no frames
    {
        CAPTURE(frame);
        const auto a = acquireSlice(registry, at(pass(1, 1, frame), far));
        const auto b = acquireSlice(registry, at(pass(2, 1, frame), near));
        const auto c = acquireSlice(registry, at(pass(1, 2, frame), rightFar));
        const auto d = acquireSlice(registry, at(pass(2, 2, frame), rightNear));
        CHECK_FALSE(a.shared);
        CHECK(b.shared);
        CHECK_FALSE(c.shared);
        CHECK(d.shared);
        CHECK(a.state == b.state);
        CHECK(c.state == d.state);
        CHECK(a.state != c.state);
        CHECK(b.slices.size() == 2u);
        if (left)
        {
            CHECK(a.state == left);
            CHECK(c.state == right);
            CHECK(a.slices.size() == 2u); // known from the last frame
        }
        left = a.state;
        right = c.state;
    }
    CHECK(registry.states().size() == 2u);

    // Slices in different viewports, windows or frames are views of their own.
    CHECK_FALSE(acquireSlice(registry, at(pass(2, 1, 4, {8, 0, 8, 8}), near)).shared);
    PassIdentity window = at(pass(2, 1, 4), near);
    window.contextId = 1;
    CHECK_FALSE(acquireSlice(registry, window).shared);
    CHECK_FALSE(acquireSlice(registry, at(pass(2, 1, 5), near)).shared);
}

TEST_CASE("view registry: slices that are culled before the first draws are known to it",
          "[session]")
{
    Registry registry;
    for (uint64_t frame = 1; frame < 4; ++frame)
    {
        // The head moves, and the planes move with it.
        const double eye = 0.1 * double(frame), middle = 10.0 + double(frame);
        const View far = viewAt(eye, middle, 100.0),
                   near = viewAt(eye, 1.0 / double(frame), middle);
        registry.record(at(pass(1, 1, frame), far));
        registry.record(at(pass(2, 1, frame), near));
        const auto a = acquireSlice(registry, at(pass(1, 1, frame), far));
        const auto b = acquireSlice(registry, at(pass(2, 1, frame), near));
        REQUIRE(a.slices.size() == 2u);
        CHECK(b.shared);
        // The first slice traces what the second one needs.
        CHECK(viewOfSlices(a.slices) == viewOfSlices(b.slices));
    }
}

TEST_CASE("view registry: views of a context that is closed are forgotten", "[session]")
{
    Registry registry;
    PassIdentity other = pass(0, 0, 1);
    other.contextId = 1;
    const auto kept = acquire(registry, other);
    std::weak_ptr<int> gone = acquire(registry, pass(0, 0, 1));
    registry.forgetContext(0);
    CHECK(gone.expired());
    other.frameNumber = 2;
    CHECK(acquire(registry, other) == kept);
    CHECK(registry.states().size() == 1u);
}

TEST_CASE("view registry: a camera made for each picture does not pile up", "[session]")
{
    Registry registry;
    for (uint64_t frame = 1; frame <= 1000; ++frame)
    {
        PassIdentity identity = pass(0, 0, frame);
        identity.camera = std::make_shared<int>();
        acquire(registry, identity);
    }
    CHECK(registry.states().size() <= Registry::kMostSingles);
    CHECK(registry.states().size() >
          1u); // the cameras are told apart, though malloc reuses addresses
}
