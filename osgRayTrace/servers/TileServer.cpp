// TileServer.cpp - what a render server does for its viewers, whatever connects them. Layer:
// servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/TileServer.h"

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/SteadySeconds.h"
#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/servers/BuildIdentity.h"
#include "osgRayTrace/servers/SceneWire.h"
#include "osgRayTrace/servers/ServerMessages.h"
#include "osgRayTrace/session/TileTracer.h"

#include <algorithm>
#include <deque>
#include <exception>
#include <optional>
#include <unordered_set>
#include <utility>

namespace osgRayTrace::engine
{

/// What the server knows of a viewer.
struct TileServer::Viewer
{
    struct NumberedScene
    {
        uint64_t number;
        std::shared_ptr<const TracedScene> traced;
    };
    /// Views at work may be one version of the scene behind each other.
    static constexpr std::size_t kScenes = 2;
    static constexpr std::size_t kPasses = 64;
    struct NumberedPhotons
    {
        uint64_t number;
        std::shared_ptr<const PhotonPass> pass;
    };
    static constexpr std::size_t kPhotonPasses = 8;

    Viewer(std::string n, const std::shared_ptr<Workers>& workers)
        : name(std::move(n)), tracer(workers)
    {
    }

    std::string name;
    double heard = 0.0;
    SceneReceiver receiver;
    std::deque<NumberedScene> scenes;    ///< oldest first
    std::deque<NumberedPhotons> photons; ///< oldest first
    std::deque<PassOrder> passes;        ///< oldest first, without their scenes
    std::deque<TileOrders> groups;       ///< tiles to trace, oldest first
    std::unordered_set<uint64_t> dropped;
    TileTracer tracer;

    /// Returns how many tiles are in the queue.
    std::size_t queued() const
    {
        std::size_t tiles = 0;
        for (const TileOrders& group : groups)
            tiles += std::max<std::size_t>(group.tiles.size(), 1);
        return tiles;
    }
    const PassOrder* findPass(uint64_t number) const
    {
        for (const PassOrder& pass : passes)
            if (pass.number == number) return &pass;
        return nullptr;
    }
    std::shared_ptr<const PhotonPass> findPhotons(uint64_t number) const
    {
        for (const NumberedPhotons& list : photons)
            if (list.number == number) return list.pass;
        return nullptr;
    }
    std::shared_ptr<const TracedScene> findScene(uint64_t number) const
    {
        for (const NumberedScene& scene : scenes)
            if (scene.number == number) return scene.traced;
        return nullptr;
    }
};

TileServer::TileServer(std::shared_ptr<Workers> workers, Send send, std::function<double()> now)
    : _workers(std::move(workers)),
      _send(std::move(send)),
      _now(now ? std::move(now) : steadySeconds)
{
}

TileServer::~TileServer() = default;

void TileServer::refuse(const std::string& name, const std::string& reason, bool lasts)
{
    _viewers.erase(name);
    _send(name, messageOf(Refusal{reason, lasts}));
}

void TileServer::take(const std::string& name, const Bytes& message)
{
    try
    {
        WireReader in(message);
        MessageKind kind{};
        const bool known = takeKind(in, kind);
        if (known && kind == MessageKind::Hello) return welcome(name, message);
        const auto found = _viewers.find(name);
        if (found == _viewers.end()) return _send(name, plainMessage(MessageKind::Stranger));
        found->second->heard = _now();
        if (known && kind == MessageKind::Bye)
            _viewers.erase(found);
        else if (!known || !takeOrder(*found->second, message))
            refuse(name, found->second->receiver.fault().empty()
                             ? std::string("a message is damaged")
                             : std::string(found->second->receiver.fault()));
    }
    catch (const std::exception& error)
    {
        refuse(name, error.what());
    }
}

void TileServer::welcome(const std::string& name, const Bytes& message)
{
    WireReader in(message);
    MessageKind kind{};
    Hello hello;
    if (!takeKind(in, kind) || !takeMessage(in, hello)) return refuse(name, "a hello is damaged");
    if (hello.identity != buildIdentity())
        return refuse(
            name, "the server is " + buildIdentity() + ", the viewer is " + hello.identity, true);
    forgetSilent();
    if (_viewers.size() >= kMostViewers && !_viewers.count(name))
        return refuse(name, "the server has too many viewers");
    // Whoever says hello begins anew: it has forgotten what it has sent.
    std::unique_ptr<Viewer>& viewer = _viewers[name];
    viewer = std::make_unique<Viewer>(name, _workers);
    viewer->heard = _now();
    _send(name, messageOf(Welcome{hello.number,
                                  static_cast<uint32_t>(std::max(_workers->threads(), 1))}));
}

void TileServer::forgetSilent()
{
    const double now = _now();
    for (auto viewer = _viewers.begin(); viewer != _viewers.end();)
        viewer =
            now - viewer->second->heard > kForgets ? _viewers.erase(viewer) : std::next(viewer);
}

/// Takes a message of a viewer that has said hello. Returns false if it is damaged.
bool TileServer::takeOrder(Viewer& viewer, const Bytes& message)
{
    WireReader in(message);
    MessageKind kind{};
    if (!takeKind(in, kind)) return false;
    if (kind == MessageKind::Scene)
    {
        uint64_t number = 0;
        in(number);
        return in.good() &&
               takeScene(viewer, message.data() + message.size() - in.left(), in.left(), number);
    }
    if (kind == MessageKind::Pass)
    {
        PassOrder order;
        if (!takeMessage(in, order)) return false;
        viewer.passes.push_back(std::move(order));
        if (viewer.passes.size() > Viewer::kPasses) viewer.passes.pop_front();
        return true;
    }
    if (kind == MessageKind::Photons)
    {
        PhotonList list;
        if (!takeMessage(in, list)) return false;
        auto pass = std::make_shared<PhotonPass>();
        pass->map = PhotonMap(list.photons, list.cellSize, *_workers, true);
        if (viewer.photons.size() >= Viewer::kPhotonPasses) viewer.photons.pop_front();
        viewer.photons.push_back({list.number, std::move(pass)});
        return true;
    }
    if (kind == MessageKind::Tiles)
    {
        // What is too much is refused before the tiles' photons take memory.
        const std::size_t queued = viewer.queued();
        TileOrders orders;
        if (queued >= kMostQueued || !takeMessage(in, orders, kMostQueued - queued)) return false;
        viewer.groups.push_back(std::move(orders));
        return true;
    }
    if (kind == MessageKind::Drop)
    {
        uint64_t pass = 0;
        in(pass);
        const auto isOfPass = [&](const TileOrders& group) { return group.pass == pass; };
        if (std::any_of(viewer.groups.begin(), viewer.groups.end(), isOfPass))
            viewer.dropped.insert(pass);
        return in.good();
    }
    return false;
}

bool TileServer::takeScene(Viewer& viewer, const uint8_t* data, std::size_t size, uint64_t number)
{
    const double start = _now();
    const std::shared_ptr<const Scene> scene = viewer.receiver.take(data, size);
    if (!scene) return false;
    std::shared_ptr<const TracedScene> previous =
        viewer.scenes.empty() ? nullptr : viewer.scenes.back().traced;
    if (viewer.scenes.size() >= Viewer::kScenes) viewer.scenes.pop_front();
    viewer.tracer.clear(); // what nobody holds may be changed in place
    viewer.scenes.push_back({number, TracedScene::build(scene, _workers, std::move(previous))});
    _send(viewer.name, messageOf(Ready{number, _now() - start}));
    return true;
}

bool TileServer::work()
{
    forgetSilent();
    // The viewers behind the last one, then those before it.
    Viewer* next = nullptr;
    for (const auto& [name, viewer] : _viewers)
    {
        if (viewer->groups.empty()) continue;
        const bool isAfter = name > _last, nextIsAfter = next && next->name > _last;
        const bool better = !next || (isAfter != nextIsAfter ? isAfter : name < next->name);
        if (better) next = viewer.get();
    }
    if (!next) return false;
    _last = next->name;
    const std::string name = next->name;
    try
    {
        trace(*next);
    }
    catch (const std::exception& error)
    {
        refuse(name, error.what());
    }
    return true;
}

/// Traces the oldest groups of a viewer's tiles that belong to one pass.
void TileServer::trace(Viewer& viewer)
{
    const uint64_t number = viewer.groups.front().pass;
    const auto most = static_cast<std::size_t>(std::max(4 * _workers->threads(), 1));
    std::vector<TileOrders> groups;
    std::size_t count = 0;
    while (!viewer.groups.empty() && viewer.groups.front().pass == number && count < most)
    {
        count += viewer.groups.front().tiles.size();
        groups.push_back(std::move(viewer.groups.front()));
        viewer.groups.pop_front();
    }
    const PassOrder* order = viewer.findPass(number);
    HelpedPass pass = order ? order->pass : HelpedPass();
    if (order) pass.scene = viewer.findScene(order->scene);
    if (order && order->photons != 0) pass.photons.pass = viewer.findPhotons(order->photons);
    const bool complete = pass.scene && (order->photons == 0 || pass.photons.pass);
    const bool wanted = viewer.dropped.count(number) == 0 && complete && viewer.tracer.begin(pass);
    if (viewer.groups.empty()) viewer.dropped.clear();

    const double start = _now();
    const bool hasPhotons = pass.photons.pass != nullptr;
    std::vector<int> tiles;
    std::vector<TilePhotons> photons;
    for (TileOrders& group : groups)
    {
        const bool fits = wanted && group.hasPhotons == hasPhotons;
        const int last = fits ? viewer.tracer.tileCount() : 0;
        std::vector<int32_t> kept;
        for (std::size_t i = 0; i < group.tiles.size(); ++i)
        {
            if (group.tiles[i] < 0 || group.tiles[i] >= last) continue;
            kept.push_back(group.tiles[i]);
            if (hasPhotons) photons.push_back(std::move(group.photons[i]));
        }
        group.tiles = std::move(kept);
        tiles.insert(tiles.end(), group.tiles.begin(), group.tiles.end());
    }
    std::vector<TracedTile> results;
    if (!tiles.empty()) viewer.tracer.trace(tiles, std::move(photons), results);
    _tiles += tiles.size();
    const double seconds = _now() - start;
    const TracedTile* result = results.data();
    for (TileOrders& group : groups)
    {
        TracedTiles traced;
        traced.pass = number;
        traced.group = group.group;
        const auto size = static_cast<double>(group.tiles.size());
        traced.seconds = tiles.empty() ? 0.0 : seconds * size / static_cast<double>(tiles.size());
        traced.depth = pass.wantsDepth;
        traced.surfaces = pass.wantsDepth && pass.wantsSurfaces;
        traced.samples = pass.wantsDepth && pass.wantsSamples;
        traced.photons = hasPhotons;
        traced.tiles = std::move(group.tiles);
        _send(viewer.name, messageOf(traced, result));
        result += traced.tiles.size();
    }
}

} // namespace osgRayTrace::engine
