// ServerPoolTest.cpp - pictures with the help of servers are those without, whatever befalls them.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/Environments.h"
#include "tests/SlitRooms.h"
#include "tests/servers/ThreadServer.h"

#include "osgRayTrace/servers/ServerPool.h"
#include "osgRayTrace/session/TileTracer.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr int kPasses = 3;

/// Returns a session of one thread, with help or without.
std::unique_ptr<RenderSession> sessionOf(const std::shared_ptr<const TracedScene>& scene,
                                         const RenderOptions& options,
                                         const std::shared_ptr<TileHelp>& help,
                                         const View& view = cornellView(70, 50))
{
    auto session = std::make_unique<RenderSession>(std::make_shared<Workers>(1));
    session->setScene(scene);
    session->setView(view);
    session->setOptions(options);
    session->setHelp(help);
    return session;
}

struct Image
{
    std::vector<float> radiance, depth;
    uint64_t rays = 0;
    int passes = 0;
    std::vector<uint32_t> objects; ///< of the surface samples
    bool operator==(const Image& other) const
    {
        return radiance == other.radiance && depth == other.depth && rays == other.rays &&
               passes == other.passes && objects == other.objects;
    }
};

/// Renders an image, in any thread. Its passes are 0 if that fails.
Image rendered(const std::shared_ptr<const TracedScene>& scene, const RenderOptions& options,
               const std::shared_ptr<TileHelp>& help, int passes = kPasses,
               const View& view = cornellView(70, 50))
{
    const auto session = sessionOf(scene, options, help, view);
    StopRule rule;
    rule.passes = passes;
    const RenderProgress progress = session->render(rule);
    Image image;
    image.passes = progress.status.ok() ? progress.passes : 0;
    image.radiance = session->resolveRadiance();
    image.depth = session->resolveChannel(Channel::Depth);
    image.rays = progress.rays.total();
    for (const SurfaceSample& sample : session->surfaceSamples())
        image.objects.push_back(sample.object);
    return image;
}

Image imageOf(const std::shared_ptr<const TracedScene>& scene, const RenderOptions& options,
              const std::shared_ptr<TileHelp>& help, int passes = kPasses,
              const View& view = cornellView(70, 50))
{
    const Image image = rendered(scene, options, help, passes, view);
    REQUIRE(image.passes == passes);
    return image;
}

/// Renders until servers have traced more tiles. Returns false if they never do.
bool waitForHelp(ServerPool& pool, const std::shared_ptr<ServerPool>& help,
                 const std::shared_ptr<const TracedScene>& scene, const RenderOptions& options)
{
    const uint64_t before = pool.tilesTraced();
    for (int i = 0; i < 5000 && pool.tilesTraced() == before; ++i)
    {
        imageOf(scene, options, help);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return pool.tilesTraced() > before;
}

/// Checks that an image is the same with the help of two servers, and that they do help.
void checkServed(const std::shared_ptr<const TracedScene>& scene, const RenderOptions& options,
                 int passes, const View& view)
{
    const Image alone = imageOf(scene, options, nullptr, passes, view);
    const auto pool = std::make_shared<ServerPool>();
    ThreadServer first{Fate{}}, second{Fate{}};
    pool->add("first", first.connect());
    pool->add("second", second.connect());
    REQUIRE(waitForHelp(*pool, pool, scene, options));
    const uint64_t before = pool->tilesTraced();
    CHECK(imageOf(scene, options, pool, passes, view) == alone);
    CHECK(pool->tilesTraced() > before);
}

} // namespace

TEST_CASE("servers: equal images with the help of 0, 1 and 3 servers, bit by bit", "[servers]")
{
    const auto scene = cornellBox().build(1);
    for (const IntegratorKind kind : {IntegratorKind::Path, IntegratorKind::Whitted})
        for (const bool centred : {false, true})
        {
            CAPTURE(int(kind), centred);
            RenderOptions options = optionsOf(kind);
            options.centredFirstPass = centred;
            const Image alone = imageOf(scene, options, nullptr);
            CHECK(imageOf(scene, options, std::make_shared<ServerPool>()) == alone);
            for (const int count : {1, 3})
            {
                const auto pool = std::make_shared<ServerPool>();
                std::vector<std::unique_ptr<ThreadServer>> servers;
                for (int i = 0; i < count; ++i)
                {
                    servers.push_back(std::make_unique<ThreadServer>(Fate{}));
                    pool->add("server", servers.back()->connect());
                }
                REQUIRE(waitForHelp(*pool, pool, scene, options));
                const uint64_t before = pool->tilesTraced();
                CHECK(imageOf(scene, options, pool) == alone);
                CHECK(pool->tilesTraced() > before);
            }
        }
}

TEST_CASE("servers: equal images whatever delays and deaths there are", "[servers]")
{
    const auto scene = cornellBox().build(1);
    const RenderOptions options = optionsOf(IntegratorKind::Whitted);
    const Image alone = imageOf(scene, options, nullptr);
    uint64_t traced = 0;
    for (uint32_t seed = 0; seed < 12; ++seed)
    {
        CAPTURE(seed);
        const auto pool = std::make_shared<ServerPool>();
        std::vector<std::unique_ptr<ThreadServer>> servers;
        for (uint32_t i = 0; i < 3; ++i)
        {
            Fate fate;
            fate.seed = 3 * seed + i;
            fate.longestDelay = i == 0 ? 0.0 : 1e-3 * (seed % 4);
            fate.traces = i == 2 ? -1 : static_cast<int>((7 * seed + 3 * i) % 11);
            fate.returns = (seed + i) % 2 == 0;
            fate.slowness = i == 2 && seed % 3 == 0 ? 0.005 : 0.0;
            servers.push_back(std::make_unique<ThreadServer>(fate));
            pool->add("server " + std::to_string(i), servers.back()->connect());
        }
        for (int i = 0; i < 8; ++i)
        {
            CHECK(imageOf(scene, options, pool) == alone);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        traced += pool->tilesTraced();
    }
    CHECK(traced > 0);
}

TEST_CASE("servers: one that dies is missed once, and its successor helps", "[servers]")
{
    const auto scene = cornellBox().build(1);
    const RenderOptions options = optionsOf(IntegratorKind::Whitted);
    const auto pool = std::make_shared<ServerPool>();
    Fate fate;
    fate.returns = true;
    ThreadServer server(fate);
    pool->add("server", server.connect());
    REQUIRE(waitForHelp(*pool, pool, scene, options));
    server.kill();
    CHECK(waitForHelp(*pool, pool, scene, options));
}

TEST_CASE("servers: one that is silent for long is left, and helps again when it speaks",
          "[servers]")
{
    const auto scene = cornellBox().build(1);
    const RenderOptions options = optionsOf(IntegratorKind::Whitted);
    const Image alone = imageOf(scene, options, nullptr);
    const auto fast = [] // the pool's patience is that of 20 ms
    {
        const auto time = std::chrono::steady_clock::now().time_since_epoch();
        return 50.0 * std::chrono::duration<double>(time).count();
    };
    const auto pool = std::make_shared<ServerPool>(fast);
    Fate fate;
    fate.slowness = 0.1;
    fate.slowGroups = 2;
    ThreadServer server(fate);
    pool->add("server", server.connect());
    std::vector<std::string> notes;
    for (int i = 0; i < 5000 && notes.empty(); ++i)
    {
        CHECK(imageOf(scene, options, pool) == alone);
        notes = pool->takeNotes();
    }
    REQUIRE(!notes.empty());
    CHECK(waitForHelp(*pool, pool, scene, options));
    CHECK(notes.front() == "server server does not answer: the others trace its tiles");
}

TEST_CASE("servers: the viewer traces what a server never sends", "[servers]")
{
    /// A line on which orders of tiles are lost.
    class LossyLink : public Link
    {
    public:
        explicit LossyLink(std::unique_ptr<Link> link) : _link(std::move(link)) {}
        bool send(const Bytes& message) override
        {
            const bool isLost = message[0] == static_cast<uint8_t>(MessageKind::Tiles);
            return isLost || _link->send(message);
        }
        bool receive(Bytes& message) override { return _link->receive(message); }

    private:
        std::unique_ptr<Link> _link;
    };
    const auto scene = cornellBox().build(1);
    const RenderOptions options = optionsOf(IntegratorKind::Whitted);
    const Image alone = imageOf(scene, options, nullptr);
    // The clock stops before the pool takes the server for gone.
    const double begin = 1e-9 * double(std::chrono::steady_clock::now().time_since_epoch().count());
    const auto halfSecond = [begin]
    {
        const auto time = std::chrono::steady_clock::now().time_since_epoch();
        return std::min(1e-9 * double(time.count()) - begin, 0.5);
    };
    const auto pool = std::make_shared<ServerPool>(halfSecond);
    ThreadServer server{Fate{}};
    pool->add("server", std::make_unique<LossyLink>(server.connect()));
    for (int i = 0; i < 20; ++i)
    {
        CHECK(imageOf(scene, options, pool) == alone);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    CHECK(pool->serversIn() == 1);
    CHECK(pool->tilesTraced() == 0);
}

TEST_CASE("servers: scenes that change arrive as changes", "[servers]")
{
    SceneBuilder builder = cornellBox();
    Material moving = lambert(Vec3(0.2f, 0.7f, 0.2f));
    const uint32_t index = builder.add(boxMesh(Vec3(0.0f), Vec3(80.0f)), moving);
    auto scene = std::make_shared<Scene>(*builder.scene);
    scene->changed = 1;
    const RenderOptions options = optionsOf(IntegratorKind::Whitted);
    const auto workers = std::make_shared<Workers>(1);
    const auto pool = std::make_shared<ServerPool>();
    ThreadServer server{Fate{}};
    pool->add("server", server.connect());
    std::shared_ptr<const TracedScene> traced = TracedScene::build(scene, workers);
    REQUIRE(waitForHelp(*pool, pool, traced, options));
    for (int step = 0; step < 10; ++step)
    {
        CAPTURE(step);
        auto next = std::make_shared<Scene>(*scene);
        next->changed = next->instances[index].changed = static_cast<Stamp>(2 + step);
        next->instances[index].placed = true;
        next->instances[index].engineFromLocal.translation = Vec3(40.0f * step, 100.0f, 100.0f);
        if (step == 5) next->materials[1].baseColor = Vec3(0.9f);
        if (step == 5) next->materials[1].changed = next->changed;
        traced = TracedScene::build(next, workers, traced);
        scene = next;
        const Image alone = imageOf(TracedScene::build(next, workers), options, nullptr);
        CHECK(imageOf(traced, options, pool) == alone);
    }
    CHECK(pool->tilesTraced() > 0);
}

TEST_CASE("servers: equal images with photons, guided to what is seen", "[servers]")
{
    SceneBuilder builder = cornellBox();
    builder.add(sphereMesh(Vec3(400, 120, 120), 60.0f, 24), glass(1.5f));
    builder.add(sphereMesh(Vec3(100, 300, 300), 60.0f, 24), mirror(Vec3(0.9f)));
    const auto scene = builder.build(1);
    for (const IntegratorKind kind : {IntegratorKind::PhotonCaustics, IntegratorKind::Sppm})
        for (const RadiusSchedule schedule : {RadiusSchedule::Global, RadiusSchedule::Local})
        {
            CAPTURE(int(kind), int(schedule));
            RenderOptions options = optionsOf(kind);
            options.photons = 3000;
            options.radiusSchedule = schedule;
            checkServed(scene, options, 7, cornellView(70, 50));
        }
}

TEST_CASE("servers: equal images with photons that are sent through openings", "[servers][long]")
{
    const auto scene = rooms().build(1);
    const View view = viewOf(true, 48);
    RenderOptions options = optionsOf(IntegratorKind::Sppm);
    options.photons = 16384;
    const Image alone = imageOf(scene, options, nullptr, 6, view);
    options.photonGuiding = false;
    REQUIRE(imageOf(scene, options, nullptr, 6, view).radiance != alone.radiance); // there are some
    options.photonGuiding = true;
    checkServed(scene, options, 6, view);
}

TEST_CASE("servers: equal images of a room that sees the sky through an opening", "[servers]")
{
    SceneBuilder builder;
    const Material white = lambert(Vec3(0.7f));
    builder.add(quadMesh({0, 0, 0}, {4, 0, 0}, {0, 4, 0}), white);
    builder.add(quadMesh({0, 0, 0}, {0, 0, 3}, {4, 0, 0}), white);
    builder.add(quadMesh({0, 4, 0}, {4, 0, 0}, {0, 0, 3}), white);
    builder.add(quadMesh({0, 0, 0}, {0, 4, 0}, {0, 0, 3}), white);
    builder.add(quadMesh({4, 0, 0}, {0, 0, 3}, {0, 4, 0}), white);
    builder.add(quadMesh({0, 0, 3}, {0, 4, 0}, {3, 0, 0}), white);
    builder.add(quadMesh({3, 1, 3}, {0, 3, 0}, {1, 0, 0}), white);
    Light sky;
    sky.kind = LightKind::Environment;
    sky.radiance = Vec3(1.0f);
    sky.environment.image = sunnySky(64, 32);
    builder.addLight(sky);
    const auto scene = builder.build(1);
    const View view = perspectiveView({1, 0.5, 1.6}, {2, 3, 1}, {0, 0, 1}, 60.0, 48, 40);
    RenderOptions options = optionsOf(IntegratorKind::Path);
    const Image alone = imageOf(scene, options, nullptr, 6, view);
    options.moving = true; // where nothing is learnt
    REQUIRE(imageOf(scene, options, nullptr, 6, view).radiance != alone.radiance);
    options.moving = false;
    checkServed(scene, options, 6, view);
}

TEST_CASE("servers: AUTOMATIC ends photons as without them if they trace all tiles", "[servers]")
{
    /// Traces all tiles at once.
    class TracesAll : public TileHelp, public PassHelp
    {
    public:
        std::unique_ptr<PassHelp> begin(const HelpedPass& pass, const SharedTiles& tiles) override
        {
            std::vector<int> all;
            std::vector<TilePhotons> photons;
            for (int tile = tiles.take(); tile >= 0; tile = tiles.take())
            {
                all.push_back(tile);
                if (pass.photons.pass) photons.push_back(tiles.photonsOf(tile));
            }
            std::vector<TracedTile> results;
            REQUIRE(_tracer.begin(pass));
            _tracer.trace(all, std::move(photons), results);
            for (std::size_t i = 0; i < all.size(); ++i)
                tiles.bring(all[i], results[i]);
            return std::make_unique<TracesAll>();
        }
        void note(const std::string&) override {}
        void exchange() override {}
        int awaited() const override { return 0; }
        std::vector<int> takeLate() override { return {}; }

    private:
        TileTracer _tracer{std::make_shared<Workers>(1)};
    };
    SceneBuilder builder = cornellBox();
    Material brushed = mirror(Vec3(0.95f, 0.9f, 0.8f));
    brushed.roughness = 0.3f;
    builder.add(sphereMesh(Vec3(400, 120, 120), 90.0f, 24), brushed);
    const auto scene = builder.build(1);
    RenderOptions options = optionsOf(IntegratorKind::Automatic);
    options.photons = 3000;
    constexpr int kMoreThanLearning = 6;
    const Image alone = imageOf(scene, options, nullptr, kMoreThanLearning);
    RenderOptions asked = options;
    asked.integrator = IntegratorKind::PhotonCaustics;
    REQUIRE(imageOf(scene, asked, nullptr, kMoreThanLearning) == alone); // they do not end
    CHECK(imageOf(scene, options, std::make_shared<TracesAll>(), kMoreThanLearning) == alone);
}

TEST_CASE("servers: ppm is traced by the viewer alone, which is said once", "[servers]")
{
    const auto scene = cornellBox().build(1);
    RenderOptions options = optionsOf(IntegratorKind::Ppm);
    options.photons = 2000;
    const auto pool = std::make_shared<ServerPool>();
    ThreadServer server{Fate{}};
    pool->add("server", server.connect());
    const Image alone = imageOf(scene, options, nullptr);
    CHECK(imageOf(scene, options, pool) == alone);
    CHECK(imageOf(scene, options, pool) == alone);
    CHECK(pool->takeNotes().size() == 1);
    CHECK(pool->takeNotes().empty());
    CHECK(pool->tilesTraced() == 0);
}

TEST_CASE("servers: two views at once share them", "[servers]")
{
    const auto scene = cornellBox().build(1);
    const RenderOptions options = optionsOf(IntegratorKind::Whitted);
    const Image alone = imageOf(scene, options, nullptr);
    const auto pool = std::make_shared<ServerPool>();
    ThreadServer first{Fate{}}, second{Fate{}};
    pool->add("first", first.connect());
    pool->add("second", second.connect());
    REQUIRE(waitForHelp(*pool, pool, scene, options));
    Image one, other;
    std::thread thread(
        [&]
        {
            for (int i = 0; i < 5; ++i)
                one = rendered(scene, options, pool);
        });
    for (int i = 0; i < 5; ++i)
        other = imageOf(scene, options, pool);
    thread.join();
    CHECK(one == alone);
    CHECK(other == alone);
}
