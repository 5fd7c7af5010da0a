// Cluster.cpp - the least of all offers, and the master's text. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "Cluster.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::calvr
{

namespace
{

constexpr int kMostPasses = 1024;       // of setPassesPerFrame
constexpr int kMostTextBytes = 1 << 20; // more is no text of ours: the nodes are out of step

} // namespace

int affordablePasses(double passSeconds, double budgetSeconds)
{
    if (!(passSeconds > 0.0) || !std::isfinite(passSeconds)) return 1;
    const double passes = std::floor(budgetSeconds / passSeconds);
    if (!(passes >= 1.0)) return 1;
    return static_cast<int>(std::min(passes, static_cast<double>(kMostPasses)));
}

int agreedPasses(const std::vector<int>& offers)
{
    int least = kMostPasses + 1;
    for (const int offer : offers)
        if (offer > kNoSay) least = std::min(least, offer);
    return least > kMostPasses ? 1 : least;
}

PassAgreement::PassAgreement(Connections& connections)
    : _connections(connections),
      _offers(static_cast<size_t>(std::max(connections.slaveCount(), 0)), kNoSay)
{
    _offers.reserve(_offers.size() + 1);
}

int PassAgreement::agree(int offer)
{
    const int alone = std::max(offer, 1);
    int agreed = alone;
    if (!_connections.isMaster())
    {
        const bool sent = _connections.sendToMaster(offer);
        const bool read = _connections.readFromMaster(&agreed, sizeof agreed);
        return sent && read ? std::clamp(agreed, 1, kMostPasses) : alone;
    }
    if (_offers.empty()) return alone;

    const bool read = _connections.readFromSlaves(_offers);
    _offers.push_back(offer);
    agreed = agreedPasses(_offers);
    _offers.pop_back();
    const bool sent = _connections.sendToSlaves(&agreed, sizeof agreed);
    return read && sent ? agreed : alone;
}

std::string mastersText(Connections& connections, const std::string& own)
{
    int bytes = static_cast<int>(std::min(own.size(), static_cast<size_t>(kMostTextBytes)));
    if (connections.isMaster())
    {
        if (connections.slaveCount() > 0 && connections.sendToSlaves(&bytes, sizeof bytes) &&
            bytes > 0)
            connections.sendToSlaves(own.data(), bytes);
        return own;
    }

    if (!connections.readFromMaster(&bytes, sizeof bytes) || bytes < 0 || bytes > kMostTextBytes)
        return own;
    std::string text(static_cast<size_t>(bytes), '\0');
    if (bytes > 0 && !connections.readFromMaster(text.data(), bytes)) return own;
    return text;
}

} // namespace osgRayTrace::calvr
