// TileServer.h - what a render server does for its viewers, whatever connects them. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/servers/Wire.h"

#include <functional>
#include <memory>
#include <string>
#include <unordered_map>

namespace osgRayTrace::engine
{

/// Keeps the scene of each viewer, and traces the tiles that they ask for. Viewers take turns. One
/// thread uses it.
class TileServer
{
public:
    using Send = std::function<void(const std::string& viewer, Bytes&& message)>;

    /// send: sends a message to a viewer, which may be gone. now: a clock [s], which tests replace.
    TileServer(std::shared_ptr<Workers> workers, Send send, std::function<double()> now = {});
    ~TileServer();

    /// Takes a message of a viewer. Does what takes little time; a damaged message ends the
    /// connection.
    void take(const std::string& viewer, const Bytes& message);

    /// Traces some of the tiles that are asked for, and sends them. Returns false if there are
    /// none.
    bool work();

    uint64_t tilesTraced() const { return _tiles; } ///< of all viewers that there were
    int viewers() const { return static_cast<int>(_viewers.size()); }

    /// Viewers that say nothing for so long [s] are forgotten, with their scenes. They may come
    /// back.
    static constexpr double kForgets = 600.0;
    static constexpr std::size_t kMostViewers = 64;
    /// A viewer may have so many tiles in the queue, counting groups without tiles as one.
    static constexpr std::size_t kMostQueued = 8192;

private:
    struct Viewer;

    void welcome(const std::string& name, const Bytes& message);
    bool takeOrder(Viewer& viewer, const Bytes& message);
    bool takeScene(Viewer& viewer, const uint8_t* data, std::size_t size, uint64_t number);
    void trace(Viewer& viewer);
    void refuse(const std::string& name, const std::string& reason, bool lasts = false);
    void forgetSilent();

    std::shared_ptr<Workers> _workers;
    Send _send;
    std::function<double()> _now;
    std::unordered_map<std::string, std::unique_ptr<Viewer>> _viewers;
    uint64_t _tiles = 0;
    std::string _last; ///< the viewer whose turn was last
};

} // namespace osgRayTrace::engine
