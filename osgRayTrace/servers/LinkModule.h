// LinkModule.h - connections to render servers by a module that is loaded when they are wanted.
// Layer: servers.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/servers/ServerPool.h"

#include <memory>
#include <string>

namespace osgRayTrace::engine
{

/// Returns the servers that a text names, see parseServers; null if it names none. What is wrong
/// with the module or with an address is among the notes.
std::shared_ptr<ServerPool> openServers(const std::string& text);

} // namespace osgRayTrace::engine
