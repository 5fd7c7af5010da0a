// ViewRegistryTest.cpp - which passes are the same view. Layer: tests.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/ViewRegistry.h"

#include "tests/Catch.h"

using namespace osgRayTrace::engine;

namespace
{

using Registry = ViewRegistry<int>;

std::shared_ptr<int> acquire(Registry& registry, const PassIdentity& pass)
{
    return registry.acquire(pass, [] { return std::make_shared<int>(0); });
}

/// Names for cameras and stages.
const char kNames[16] = {};

PassIdentity pass(int camera, int stage, uint64_t frame, std::array<int, 4> viewport = {0, 0, 8, 8})
{
    PassIdentity identity;
    identity.camera = &kNames[camera];
    identity.renderStage = &kNames[stage];
    identity.frameNumber = frame;
    identity.viewport = viewport;
    return identity;
}

} // namespace

TEST_CASE("view registry: a camera keeps its state, others have theirs", "[bridge]")
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

TEST_CASE("view registry: eyes are told apart by the order of their render stages", "[bridge]")
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

TEST_CASE("view registry: without frame numbers views stay the same", "[bridge]")
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

TEST_CASE("view registry: a resized viewport keeps the state, two viewports have two", "[bridge]")
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

TEST_CASE("view registry: what is no longer drawn expires, whatever the frame numbers", "[bridge]")
{
    Registry registry;
    std::weak_ptr<int> gone = acquire(registry, pass(0, 0, 1));
    // Two viewers, each with its own frame numbers, far apart.
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
