// ServerPool.h - the render servers that help the views of a scene. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/servers/RemoteServer.h"
#include "osgRayTrace/session/TileHelp.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

namespace osgRayTrace::engine
{

/// Shares the tiles of passes between this process and its servers. Each server has few tiles at a
/// time, and gets more when it sends some: so each traces in proportion to its speed, whatever that
/// is now. What a server is late with, the viewer traces itself. There is no thread of the pool:
/// the threads that trace exchange messages between tiles.
class ServerPool : public TileHelp
{
public:
    /// now: a clock [s], which tests replace.
    explicit ServerPool(std::function<double()> now = {});
    ~ServerPool() override;

    /// Adds a server by a connection to it.
    void add(const std::string& address, std::unique_ptr<Link> link);

    std::unique_ptr<PassHelp> begin(const HelpedPass& pass, const SharedTiles& tiles) override;

    void note(const std::string& sentence) override;

    /// Returns sentences for the user about what has happened since the last call, once each.
    std::vector<std::string> takeNotes();

    /// Returns how many servers may be given tiles, and how many tiles servers have traced.
    int serversIn() const;
    uint64_t tilesTraced() const;

private:
    class Work;
    struct Arrived
    {
        RemoteServer* server;
        Bytes message;
        std::vector<int32_t> tiles; ///< the tiles that are taken from it
    };

    void addNote(const std::string& note);
    void receiveAll(double now);
    void takeTraced(RemoteServer& server, Bytes&& message, double now);
    void giveTiles(Work& work, double now);
    void giveTiles(Work& work, RemoteServer& server, double speedShare, double now);
    void checkSilence(double now);

    std::function<double()> _now;
    mutable std::mutex _mutex; // the threads that trace lock it; it guards all below
    std::vector<std::unique_ptr<RemoteServer>> _servers;
    std::unordered_map<uint64_t, Work*> _works; ///< passes at work, by number
    uint64_t _passes = 0;
    uint64_t _groups = 0;
    uint64_t _traced = 0;
    std::vector<std::string> _notes, _said;
};

} // namespace osgRayTrace::engine
