// RemoteServer.h - a render server as a viewer knows it. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/servers/Link.h"
#include "osgRayTrace/servers/SceneWire.h"
#include "osgRayTrace/servers/ServerMessages.h"

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

namespace osgRayTrace::engine
{

/// A server's connection, scenes, speed, and the tiles that it has been given. Its pool guards it.
class RemoteServer
{
public:
    /// Tiles that the server was given in one message.
    struct Group
    {
        uint64_t pass = 0;
        uint64_t number = 0;
        std::vector<int32_t> tiles;
        double sent = 0.0; ///< [s]
    };

    RemoteServer(std::string address, std::unique_ptr<Link> link);
    ~RemoteServer();

    const std::string& address() const { return _address; }
    /// Returns whether the server may be given scenes and tiles.
    bool isIn() const { return _state == State::In && !_silent; }
    const std::string& refusal() const { return _refusal; } ///< empty: it has not refused

    /// Says hello to a server that is out, now and then, and asks one that is silent, or prepares a
    /// scene for long, whether it is still there. now: [s], in all functions.
    void tend(double now);

    /// Takes a message that has come, or returns false.
    bool receive(Bytes& message) { return _link->receive(message); }

    /// Takes a message that is not about tiles. Returns false if it makes no sense.
    bool take(MessageKind kind, WireReader& in, double now);

    /// Makes sure that the server has the scene, or is about to have it, unless it is gone.
    void prepareScene(const std::shared_ptr<const TracedScene>& scene, double now);

    /// Returns the number of a scene that the server can trace now; nothing if it cannot.
    std::optional<uint64_t> sceneNumber(const std::shared_ptr<const TracedScene>& scene) const;

    /// Sends a pass, once, and tiles of it. photons: of each tile if the pass has photons. Returns
    /// false if the server is gone.
    bool sendTiles(PassOrder& order, Group group, std::vector<TilePhotons> photons);

    /// Takes the group that an answer is about out of those that are awaited. Nothing: no such
    /// group is.
    std::optional<Group> takeGroup(const TracedTiles& head, double now);

    /// Tells the server that a pass is no longer wanted.
    void drop(uint64_t pass);

    /// Returns how many tiles the server may have at once, and how many it has.
    int credit() const;
    int given() const { return _given; }
    int threads() const { return _threads; }
    double speed() const; ///< tiles a second; 0: not known
    /// Returns when a group that the server has counts as late.
    double lateAfter(const Group& group) const;
    const std::deque<Group>& groups() const { return _groups; }

    /// Lets go of a server for good: it sends what makes no sense.
    void refuse(const std::string& reason);

    /// Returns whether hellos to the server have been in vain for seconds, since the first one.
    bool isUnreached(double now) const;

    /// Returns true once a server that has tiles says nothing for long: it is given none until it
    /// speaks.
    bool checkSilence(double now);

private:
    enum class State
    {
        Out, ///< the server has not answered the last hello
        In,
        Refused, ///< for a while, if _asksAgain
    };
    struct SentScene
    {
        std::weak_ptr<const TracedScene> scene;
        uint64_t number = 0;
        double sent = 0.0; ///< [s]
    };

    struct SentPhotons
    {
        std::weak_ptr<const PhotonPass> pass;
        uint64_t number = 0;
    };

    void leave();
    void hear(double now);
    bool send(const Bytes& message);
    bool sendPhotons(PassOrder& order);

    std::string _address;
    std::unique_ptr<Link> _link;
    State _state = State::Out;
    std::string _refusal;
    uint64_t _hellos = 0;
    uint64_t _firstHello = 1; ///< since the server is out
    double _helloAt = -1e9;
    double _heard = -1e9; ///< when the last message came
    bool _wasHeard = false;
    bool _silent = false;    ///< while In: it has tiles, and has said nothing for long
    bool _asksAgain = false; ///< while Refused
    double _refusedAt = -1.0;
    double _firstTended = -1.0;
    double _sceneSeconds = 0.0; ///< time in which it prepared the last scene
    int _threads = 1;
    std::unique_ptr<SceneSender> _sender;
    std::deque<SentScene> _scenes;    ///< those that the server keeps, oldest first
    std::deque<SentPhotons> _photons; ///< those that the server keeps, oldest first
    uint64_t _sceneNumbers = 0, _photonNumbers = 0;
    uint64_t _awaitedScene = 0; ///< a scene that takes long: tiles wait for it; 0: none does
    uint64_t _readyScene = 0;   ///< the last scene that the server has prepared
    std::unordered_set<uint64_t> _passes;
    std::deque<Group> _groups;
    int _given = 0;
    double _tileSeconds = 0.0; ///< mean wall time of a tile; 0: not known
    double _latency = 1e-3;    ///< mean time of a group besides tracing [s]
};

} // namespace osgRayTrace::engine
