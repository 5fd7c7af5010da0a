// RemoteServer.cpp - a render server as a viewer knows it. Layer: servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/RemoteServer.h"

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/photons/PhotonPasses.h"
#include "osgRayTrace/servers/BuildIdentity.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kAskInterval = 0.5;   ///< [s]
constexpr double kHelloInterval = 0.3; ///< [s]
/// A server that has tiles and says nothing for so long is silent [s]; one that prepares scenes
/// for other views may take as long as it took for the last one of this viewer.
constexpr double kSilence = 1.0;
constexpr double kUnreached = 5.0;  ///< [s]
constexpr double kAskAgain = 30.0;  ///< after a refusal [s]
constexpr double kLeastTime = 1e-7; ///< of a tile [s]: what a server tells is not trusted
/// Scenes from this size on [bytes] are awaited; what is smaller is mostly prepared within a frame.
constexpr std::size_t kLargeScene = std::size_t(1) << 20;
/// The server keeps so many scenes of a viewer: see TileServer.
constexpr std::size_t kScenes = 2, kPhotonPasses = 8;
/// A server has tiles for so long, beside the time that messages take [s].
constexpr double kAhead = 0.004;
constexpr int kMostTiles = 1024;
/// So many at most if it has very many threads: see TileServer::kMostQueued.
constexpr int kMostOfAll = 4096;

/// Moves a mean towards a value: fast at first, and faster to slowness than to speed.
void follow(double& mean, double value)
{
    mean = mean == 0.0 ? value : mean + (value > mean ? 0.3 : 0.15) * (value - mean);
}

} // namespace

RemoteServer::RemoteServer(std::string address, std::unique_ptr<Link> link)
    : _address(std::move(address)), _link(std::move(link))
{
}

RemoteServer::~RemoteServer()
{
    if (_state == State::In) _link->send(plainMessage(MessageKind::Bye));
}

bool RemoteServer::send(const Bytes& message)
{
    if (_link->send(message)) return true;
    leave();
    return false;
}

void RemoteServer::tend(double now)
{
    const bool waits = _state == State::In && (_silent || _awaitedScene != 0);
    const bool asks = waits && now - _heard > kAskInterval;
    if (asks && now - _helloAt > kAskInterval)
    {
        _helloAt = now;
        send(dropMessage(0)); // a process that has taken the server's place answers Stranger
    }
    if (_state == State::Refused && _asksAgain && now - _refusedAt > kAskAgain) _state = State::Out;
    if (_firstTended < 0.0) _firstTended = now;
    if (_state != State::Out || now - _helloAt < kHelloInterval) return;
    _helloAt = now;
    _link->send(messageOf(Hello{++_hellos, buildIdentity()}));
}

void RemoteServer::leave()
{
    if (_state == State::In) _state = State::Out;
    _helloAt = -1e9;
    _firstHello = _hellos + 1;
    _sender.reset();
    _scenes.clear();
    _awaitedScene = _readyScene = 0;
    _passes.clear();
    _photons.clear();
    _groups.clear();
    _given = 0;
    _silent = false;
}

void RemoteServer::refuse(const std::string& reason)
{
    leave();
    _state = State::Refused;
    _refusal = reason;
    _asksAgain = false;
}

bool RemoteServer::isUnreached(double now) const
{
    return _state == State::Out && !_wasHeard && now - _firstTended > kUnreached;
}

/// Lets a server be silent that has tiles. Its scenes stay: it may be busy with those of others.
bool RemoteServer::checkSilence(double now)
{
    if (!isIn() || _groups.empty() || _awaitedScene != 0) return false;
    const double since = std::max(_heard, _groups.front().sent);
    _silent = now - since > kSilence + 2.0 * _sceneSeconds;
    return _silent;
}

void RemoteServer::hear(double now)
{
    _heard = now;
    _wasHeard = true;
    _silent = false;
}

bool RemoteServer::take(MessageKind kind, WireReader& in, double now)
{
    hear(now);
    if (kind == MessageKind::Welcome)
    {
        Welcome welcome;
        if (!takeMessage(in, welcome)) return false;
        // Older hellos may have been answered by a process that is gone.
        if (_state != State::Out || welcome.number < _firstHello) return true;
        _state = State::In;
        _refusal.clear();
        _threads = static_cast<int>(welcome.threads);
        _sender = std::make_unique<SceneSender>();
        return true;
    }
    if (kind == MessageKind::Refusal)
    {
        Refusal refusal;
        if (!takeMessage(in, refusal)) return false;
        refuse(refusal.reason);
        _asksAgain = !refusal.lasts;
        _refusedAt = now;
        return true;
    }
    if (kind == MessageKind::Ready)
    {
        Ready ready;
        if (!takeMessage(in, ready)) return false;
        _readyScene = std::max(_readyScene, ready.scene);
        for (const SentScene& sent : _scenes)
            if (sent.number == ready.scene)
                _sceneSeconds = std::min(ready.seconds, std::max(now - sent.sent, 0.0));
        if (_awaitedScene <= _readyScene) _awaitedScene = 0;
        return true;
    }
    if (kind == MessageKind::Stranger)
    {
        leave();
        return true;
    }
    return false;
}

std::optional<uint64_t>
RemoteServer::sceneNumber(const std::shared_ptr<const TracedScene>& scene) const
{
    if (!isIn() || _awaitedScene != 0) return std::nullopt;
    for (const SentScene& sent : _scenes)
        if (sent.scene.lock() == scene) return sent.number;
    return std::nullopt;
}

void RemoteServer::prepareScene(const std::shared_ptr<const TracedScene>& scene, double now)
{
    const auto isIt = [&](const SentScene& sent) { return sent.scene.lock() == scene; };
    const bool has = std::any_of(_scenes.begin(), _scenes.end(), isIt);
    if (!isIn() || has || _awaitedScene != 0) return; // one at a time
    const Bytes bytes = _sender->message(scene->scene());
    const uint64_t number = ++_sceneNumbers;
    if (!send(sceneMessage(number, bytes))) return;
    if (_scenes.size() >= kScenes) _scenes.pop_front();
    _scenes.push_back({scene, number, now});
    if (_readyScene == 0 || bytes.size() >= kLargeScene) _awaitedScene = number;
}

/// Sends the photons of a pass unless the server has them, and sets their number.
bool RemoteServer::sendPhotons(PassOrder& order)
{
    order.photons = 0;
    const std::shared_ptr<const PhotonPass>& pass = order.pass.photons.pass;
    if (!pass) return true;
    for (const SentPhotons& sent : _photons)
        if (sent.pass.lock() == pass) order.photons = sent.number;
    if (order.photons != 0) return true;
    order.photons = ++_photonNumbers;
    if (!send(photonsMessage(order.photons, order.pass.photons))) return false;
    if (_photons.size() >= kPhotonPasses) _photons.pop_front();
    _photons.push_back({pass, order.photons});
    return true;
}

bool RemoteServer::sendTiles(PassOrder& order, Group group, std::vector<TilePhotons> photons)
{
    constexpr std::size_t kMostPasses = 1024;
    if (_passes.count(order.number) == 0)
    {
        if (_passes.size() >= kMostPasses) _passes.clear();
        if (!sendPhotons(order) || !send(messageOf(order))) return false;
        _passes.insert(order.number);
    }
    const bool hasPhotons = order.pass.photons.pass != nullptr;
    if (!send(messageOf(
            TileOrders{group.pass, group.number, group.tiles, hasPhotons, std::move(photons)})))
        return false;
    _given += static_cast<int>(group.tiles.size());
    _groups.push_back(std::move(group));
    return true;
}

std::optional<RemoteServer::Group> RemoteServer::takeGroup(const TracedTiles& head, double now)
{
    hear(now);
    const auto found = std::find_if(_groups.begin(), _groups.end(),
                                    [&](const Group& group) { return group.number == head.group; });
    if (found == _groups.end() || found->pass != head.pass) return std::nullopt;
    Group group = std::move(*found);
    const bool isOldest = found == _groups.begin();
    _groups.erase(found);
    const auto tiles = static_cast<int>(group.tiles.size());
    _given -= tiles;
    const double seconds = std::min(head.seconds, std::max(now - group.sent, 0.0));
    if (seconds > 0.0 && tiles > 0) follow(_tileSeconds, std::max(seconds / tiles, kLeastTime));
    // What is left of the oldest group's time, after its own tracing, is that of messages; groups
    // that wait behind others would count their waiting, too.
    if (isOldest && _groups.empty()) follow(_latency, std::max(now - group.sent - seconds, 1e-5));
    return group;
}

void RemoteServer::drop(uint64_t pass)
{
    const bool has = std::any_of(_groups.begin(), _groups.end(),
                                 [&](const Group& group) { return group.pass == pass; });
    if (has) send(dropMessage(pass));
    _passes.erase(pass);
}

double RemoteServer::speed() const
{
    return _tileSeconds > 0.0 ? 1.0 / _tileSeconds : 0.0;
}

int RemoteServer::credit() const
{
    const int least = std::min(2 * _threads, kMostOfAll);
    if (_tileSeconds == 0.0) return least;
    const double ahead = std::min(2.0 * _latency, 0.05) + kAhead;
    const double tiles = std::min(std::ceil(ahead / _tileSeconds), double(kMostTiles));
    return std::max(static_cast<int>(tiles), least);
}

double RemoteServer::lateAfter(const Group& group) const
{
    constexpr double kUnknown = 0.1, kGrace = 0.010;
    if (_tileSeconds == 0.0) return group.sent + kUnknown;
    const double expected = 2.0 * (std::min(_latency, 0.05) + _given * _tileSeconds) + kGrace;
    // Means may be far off: nobody waits longer for a server that says nothing.
    return std::min(group.sent + expected, std::max(group.sent, _heard) + kSilence);
}

} // namespace osgRayTrace::engine
