// ServerPool.cpp - the render servers that help the views of a scene. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/ServerPool.h"

#include "osgRayTrace/base/SteadySeconds.h"

#include <algorithm>
#include <utility>

namespace osgRayTrace::engine
{

/// A pass at work. All but the tiles' functions is guarded by the pool's mutex.
class ServerPool::Work : public PassHelp
{
public:
    Work(ServerPool& pool, const HelpedPass& pass, const SharedTiles& tiles)
        : _pool(pool), _tiles(tiles)
    {
        order.pass = pass;
    }
    ~Work() override
    {
        const std::lock_guard<std::mutex> lock(_pool._mutex);
        for (const auto& server : _pool._servers)
            server->drop(order.number);
        _pool._works.erase(order.number);
    }

    void exchange() override;
    int awaited() const override
    {
        const std::lock_guard<std::mutex> lock(_pool._mutex);
        return awaitedTiles + static_cast<int>(arrived.size());
    }
    std::vector<int> takeLate() override;

    int take() const { return _tiles.take(); }
    int left() const { return _tiles.left(); }
    std::vector<TilePhotons> photonsOf(const std::vector<int32_t>& tiles) const
    {
        std::vector<TilePhotons> photons;
        if (!order.pass.photons.pass) return photons;
        for (const int32_t tile : tiles)
            photons.push_back(_tiles.photonsOf(tile));
        return photons;
    }

    /// Takes tiles out of those that are awaited; returns those that were.
    std::vector<int32_t> takeAwaited(const std::vector<int32_t>& tiles)
    {
        std::vector<int32_t> taken;
        for (const int32_t tile : tiles)
            if (isAwaited[static_cast<std::size_t>(tile)])
            {
                isAwaited[static_cast<std::size_t>(tile)] = false;
                taken.push_back(tile);
            }
        awaitedTiles -= static_cast<int>(taken.size());
        return taken;
    }
    void await(int32_t tile)
    {
        const auto index = static_cast<std::size_t>(tile);
        if (isAwaited.size() <= index) isAwaited.resize(index + 1);
        isAwaited[index] = true;
        ++awaitedTiles;
    }
    PassOrder order;
    std::vector<bool> isAwaited; ///< by tile
    int awaitedTiles = 0;
    std::vector<Arrived> arrived;

private:
    void bring(const Arrived& arrival);
    std::vector<int32_t> lateTiles(double now) const;

    ServerPool& _pool;
    const SharedTiles& _tiles;
};

void ServerPool::Work::exchange()
{
    std::vector<Arrived> mine;
    {
        const std::unique_lock<std::mutex> lock(_pool._mutex, std::try_to_lock);
        if (!lock.owns_lock()) return; // another thread does it
        const double now = _pool._now();
        _pool.receiveAll(now);
        _pool.giveTiles(*this, now);
        mine.swap(arrived);
    }
    for (const Arrived& arrival : mine)
        bring(arrival);
}

/// Hands tiles over to the session. What is damaged, and what a server no longer had the pass for,
/// is awaited again, from nobody.
void ServerPool::Work::bring(const Arrived& arrival)
{
    TracedTiles traced;
    WireReader in(arrival.message);
    MessageKind kind{};
    const HelpedPass& pass = order.pass;
    bool good = takeKind(in, kind) && takeMessage(in, traced);
    const bool fits = traced.depth == pass.wantsDepth &&
                      traced.surfaces == (pass.wantsDepth && pass.wantsSurfaces) &&
                      traced.samples == (pass.wantsDepth && pass.wantsSamples) &&
                      traced.photons == (pass.photons.pass != nullptr);
    good = good && (fits || traced.tiles.empty());
    std::vector<int32_t> missing = arrival.tiles;
    TracedTile tile;
    for (std::size_t i = 0; good && i < traced.tiles.size(); ++i)
    {
        good = takeTile(in, traced, tile);
        const auto wanted = std::find(missing.begin(), missing.end(), traced.tiles[i]);
        if (!good || wanted == missing.end()) continue;
        missing.erase(wanted);
        _tiles.bring(traced.tiles[i], tile);
    }
    const std::lock_guard<std::mutex> lock(_pool._mutex);
    _pool._traced += arrival.tiles.size() - missing.size();
    for (const int32_t lostTile : missing)
        await(lostTile);
    if (!good)
    {
        arrival.server->refuse("it sends damaged tiles");
        _pool.addNote("server " + arrival.server->address() + " sends damaged tiles and is left");
    }
}

/// Returns the tiles that servers have had for too long; and those that no server has, whatever has
/// become of it: they come from nobody any more.
std::vector<int32_t> ServerPool::Work::lateTiles(double now) const
{
    std::vector<int32_t> late;
    std::vector<int32_t> given;
    for (const auto& server : _pool._servers)
        for (const RemoteServer::Group& group : server->groups())
        {
            if (group.pass != order.number) continue;
            if (now > server->lateAfter(group))
                late.insert(late.end(), group.tiles.begin(), group.tiles.end());
            for (const int32_t tile : group.tiles)
                if (isAwaited[static_cast<std::size_t>(tile)]) given.push_back(tile);
        }
    if (static_cast<int>(given.size()) == awaitedTiles) return late;
    std::vector<bool> isLost = isAwaited;
    for (const int32_t tile : given)
        isLost[static_cast<std::size_t>(tile)] = false;
    for (std::size_t tile = 0; tile < isLost.size(); ++tile)
        if (isLost[tile]) late.push_back(static_cast<int32_t>(tile));
    return late;
}

std::vector<int> ServerPool::Work::takeLate()
{
    const std::lock_guard<std::mutex> lock(_pool._mutex);
    const double now = _pool._now();
    const std::vector<int32_t> taken = takeAwaited(lateTiles(now));
    _pool.checkSilence(now);
    return {taken.begin(), taken.end()};
}

ServerPool::ServerPool(std::function<double()> now) : _now(now ? std::move(now) : steadySeconds) {}

ServerPool::~ServerPool() = default;

void ServerPool::add(const std::string& address, std::unique_ptr<Link> link)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _servers.push_back(std::make_unique<RemoteServer>(address, std::move(link)));
    _servers.back()->tend(_now());
}

std::unique_ptr<PassHelp> ServerPool::begin(const HelpedPass& pass, const SharedTiles& tiles)
{
    auto work = std::make_unique<Work>(*this, pass, tiles);
    bool anybody = false;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        work->order.number = ++_passes;
        const double now = _now();
        receiveAll(now);
        checkSilence(now);
        for (const auto& server : _servers)
        {
            server->tend(now);
            if (server->isUnreached(now))
                addNote("server " + server->address() +
                        " is not reached: does it run there, and do the keys fit?");
            server->prepareScene(pass.scene, now);
            anybody = anybody || server->isIn();
        }
        if (anybody) _works[work->order.number] = work.get();
    }
    return anybody ? std::move(work) : nullptr;
}

void ServerPool::addNote(const std::string& note)
{
    if (std::find(_said.begin(), _said.end(), note) != _said.end()) return;
    _said.push_back(note);
    _notes.push_back(note);
}

void ServerPool::note(const std::string& sentence)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    addNote(sentence);
}

std::vector<std::string> ServerPool::takeNotes()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return std::exchange(_notes, {});
}

int ServerPool::serversIn() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return static_cast<int>(std::count_if(_servers.begin(), _servers.end(),
                                          [](const auto& server) { return server->isIn(); }));
}

uint64_t ServerPool::tilesTraced() const
{
    const std::lock_guard<std::mutex> lock(_mutex);
    return _traced;
}

void ServerPool::receiveAll(double now)
{
    Bytes message;
    for (const auto& server : _servers)
        while (server->receive(message))
        {
            WireReader in(message);
            MessageKind kind{};
            const bool known = takeKind(in, kind);
            if (known && kind == MessageKind::Traced)
                takeTraced(*server, std::move(message), now);
            else
            {
                if (!known || !server->take(kind, in, now))
                    server->refuse("it sends damaged messages");
                if (!server->refusal().empty())
                    addNote("server " + server->address() + " does not help: " + server->refusal());
            }
            message.clear();
        }
}

/// Keeps an answer for the pass that it belongs to.
void ServerPool::takeTraced(RemoteServer& server, Bytes&& message, double now)
{
    WireReader in(message);
    MessageKind kind{};
    TracedTiles head;
    if (!takeKind(in, kind) || !takeHead(in, head)) return;
    const std::optional<RemoteServer::Group> group = server.takeGroup(head, now);
    const auto work = _works.find(head.pass);
    if (!group || work == _works.end()) return;
    std::vector<int32_t> tiles = work->second->takeAwaited(group->tiles);
    if (!tiles.empty())
        work->second->arrived.push_back({&server, std::move(message), std::move(tiles)});
}

void ServerPool::checkSilence(double now)
{
    for (const auto& server : _servers)
        if (server->checkSilence(now))
            addNote("server " + server->address() + " does not answer: the others trace its tiles");
}

/// Gives each server as many tiles as it may have. The last tiles of a pass go out in small groups,
/// so that nobody waits long for them.
void ServerPool::giveTiles(Work& work, double now)
{
    double speeds = 0.0;
    for (const auto& server : _servers)
        if (server->isIn()) speeds += server->speed();
    for (const auto& server : _servers)
    {
        if (!server->isIn()) continue;
        const std::optional<uint64_t> scene = server->sceneNumber(work.order.pass.scene);
        if (!scene) continue;
        work.order.scene = *scene;
        giveTiles(work, *server, speeds > 0.0 ? server->speed() / speeds : 1.0, now);
    }
}

void ServerPool::giveTiles(Work& work, RemoteServer& server, double speedShare, double now)
{
    while (true)
    {
        const int left = work.left();
        if (left < 1) return;
        const auto fair = static_cast<int>(0.5 * left * speedShare);
        const int most = std::min(server.credit(), std::max(fair, server.threads()));
        const int size = std::max(most / 4, 1);
        if (most - server.given() < size) return;
        RemoteServer::Group group;
        group.pass = work.order.number;
        group.number = ++_groups;
        group.sent = now;
        for (int i = 0; i < size; ++i)
        {
            const int tile = work.take();
            if (tile < 0) break;
            group.tiles.push_back(tile);
            work.await(tile);
        }
        if (group.tiles.empty()) return;
        std::vector<TilePhotons> photons = work.photonsOf(group.tiles);
        if (!server.sendTiles(work.order, std::move(group), std::move(photons))) return;
    }
}

} // namespace osgRayTrace::engine
