// ZmqPort.h - where a render server hears its viewers, by ZeroMQ. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/servers/Wire.h"

#include <string>

namespace osgRayTrace::app
{

/// A port to which any number of viewers connect. One thread uses it.
class ZmqPort
{
public:
    /// Listens. secretKeyFile: empty without keys. Throws std::runtime_error.
    ZmqPort(const std::string& address, const std::string& secretKeyFile);
    ~ZmqPort();
    ZmqPort(const ZmqPort&) = delete;
    ZmqPort& operator=(const ZmqPort&) = delete;

    /// Takes the next message that has come. Returns false if there is none.
    bool receive(std::string& viewer, engine::Bytes& message);

    /// Sends a message to a viewer; nothing if it is gone.
    void send(const std::string& viewer, engine::Bytes&& message);

    /// Waits until a message comes, a signal comes, or the time [ms] is over.
    void wait(int milliseconds);

    /// Returns the address with the port that was chosen, if 0 or * was asked for.
    std::string address() const;

    /// Writes a new pair of keys to PREFIX.secret, for the owner alone, and PREFIX.public. Throws
    /// std::runtime_error.
    static void makeKeys(const std::string& prefix);

private:
    void* _context;
    void* _socket;
};

} // namespace osgRayTrace::app
