// ServerAddresses.h - where render servers are, as the setting `servers` names them. Layer:
// servers.
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

/// Reads "none", or addresses with commas between them: "tcp://host:port", each with "#FILE" behind
/// it if FILE has the server's public key. Nothing if the text is neither.
std::optional<std::vector<std::string>> parseServers(const std::string& text);

} // namespace osgRayTrace::engine
