// Cluster.cpp - the least of all offers, and the master's text. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "Cluster.h"

#include <algorithm>

namespace osgRayTrace::calvr
{

namespace
{

constexpr int kMostTextBytes = 1 << 20; // a longer text is none of ours: the nodes are out of step
constexpr int kMessageBytes = static_cast<int>(sizeof(WorkMessage));

WorkMessage messageOf(const std::optional<FrameWork>& work)
{
    WorkMessage message;
    if (!work) return message;
    message.hasSay = 1;
    message.divider = work->divider;
    message.passes = work->passes;
    message.progress = work->progress;
    message.upsampleDivider = work->upsampleDivider;
    return message;
}

} // namespace

FrameWork agreedWork(const std::vector<std::optional<FrameWork>>& offers)
{
    std::optional<FrameWork> agreed;
    for (const std::optional<FrameWork>& offer : offers)
    {
        if (!offer) continue;
        if (!agreed) agreed = offer;
        agreed->divider = std::max(agreed->divider, offer->divider);
        agreed->passes = std::min(agreed->passes, offer->passes);
        agreed->progress = std::min(agreed->progress, offer->progress);
        agreed->upsampleDivider = std::max(agreed->upsampleDivider, offer->upsampleDivider);
    }
    return agreed.value_or(FrameWork());
}

WorkAgreement::WorkAgreement(Connections& connections)
    : _connections(connections),
      _messages(static_cast<size_t>(std::max(connections.slaveCount(), 0))),
      _offers(_messages.size() + 1)
{
}

std::optional<FrameWork> WorkAgreement::read(const WorkMessage& message)
{
    if (message.version != WorkMessage::kVersion) _otherVersion = true;
    if (message.version != WorkMessage::kVersion || message.hasSay == 0) return std::nullopt;
    return FrameWork{message.divider, message.passes, message.progress, message.upsampleDivider};
}

FrameWork WorkAgreement::agree(const std::optional<FrameWork>& offer)
{
    const FrameWork alone = offer.value_or(FrameWork());
    if (!_connections.isMaster())
    {
        const WorkMessage own = messageOf(offer);
        WorkMessage agreed;
        const bool sent = _connections.sendToMaster(&own, kMessageBytes);
        const bool received = _connections.readFromMaster(&agreed, kMessageBytes);
        return sent && received ? read(agreed).value_or(alone) : alone;
    }
    if (_messages.empty()) return alone;

    const bool received = _connections.readFromSlaves(_messages.data(), kMessageBytes);
    _offers[0] = offer;
    for (size_t i = 0; i < _messages.size(); ++i)
        _offers[i + 1] = received ? read(_messages[i]) : std::nullopt;
    const FrameWork agreed = agreedWork(_offers);
    const WorkMessage message = messageOf(agreed);
    const bool sent = _connections.sendToSlaves(&message, kMessageBytes);
    return received && sent ? agreed : alone;
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
