// Link.h - a connection to a render server, whatever carries it. Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/servers/Wire.h"

#include <string>

namespace osgRayTrace::engine
{

/// Carries messages whole and in order, or not at all: a connection may be lost and made again at
/// any time. One thread at a time may use a link. No function waits or throws.
class Link
{
public:
    virtual ~Link() = default;

    /// Sends a message. Returns false if there is nobody to send it to now.
    virtual bool send(const Bytes& message) = 0;

    /// Takes the next message that has come. Returns false if there is none.
    virtual bool receive(Bytes& message) = 0;
};

/// Opens a link to an address, which the caller deletes; null if the address is not good, and fault
/// says why.
using OpenLink = Link* (*)(const std::string& address, std::string& fault);

} // namespace osgRayTrace::engine
