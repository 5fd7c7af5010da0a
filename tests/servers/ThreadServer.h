// ThreadServer.h - a render server on a thread, with a slow line and a short life. Layer: tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/servers/Link.h"

#include <cstdint>
#include <memory>

namespace osgRayTrace::engine::test
{

/// What happens to a server and to its messages, by a seed.
struct Fate
{
    uint32_t seed = 0;
    double longestDelay = 0.0; ///< of a message [s]; messages of a line keep their order
    int traces = -1;           ///< groups of tiles after which the server dies; -1: it lives
    bool returns = false;      ///< whether a new one takes the dead one's place
    double slowness = 0.0;     ///< [s] more for each group
    int slowGroups = 1 << 30;  ///< groups for which it is slow
};

/// A server on a thread of its own, which ends with the object.
class ThreadServer
{
public:
    explicit ThreadServer(const Fate& fate);
    ~ThreadServer();

    /// Returns the viewer's end of a line to the server. The server may go first.
    std::unique_ptr<Link> connect();

    /// Lets the server die now.
    void kill();

private:
    struct Line;
    void run(const Fate& fate);

    std::shared_ptr<Line> _line;
    std::shared_ptr<Workers> _workers;
    struct Thread;
    std::unique_ptr<Thread> _thread;
};

} // namespace osgRayTrace::engine::test
