// ServerAddresses.cpp - where render servers are, as the setting `servers` names them. Layer:
// servers.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/servers/ServerAddresses.h"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace osgRayTrace::engine
{

namespace
{

bool isAddress(const std::string& text)
{
    constexpr std::string_view kStart = "tcp://";
    const std::string endpoint = text.substr(0, text.find('#'));
    if (text.size() > endpoint.size() && text.size() == endpoint.size() + 1) return false;
    const std::size_t colon = endpoint.rfind(':');
    if (endpoint.compare(0, kStart.size(), kStart) != 0 || colon <= kStart.size()) return false;
    const std::string port = endpoint.substr(colon + 1);
    return !port.empty() && port.size() <= 5 &&
           std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; });
}

} // namespace

std::optional<std::vector<std::string>> parseServers(const std::string& text)
{
    std::vector<std::string> addresses;
    if (text.empty() || text == "none") return addresses;
    std::istringstream words(text);
    std::string word;
    while (std::getline(words, word, ','))
    {
        if (!isAddress(word)) return std::nullopt;
        addresses.push_back(word);
    }
    if (text.back() == ',') return std::nullopt;
    return addresses;
}

} // namespace osgRayTrace::engine
