// GroupMessage.cpp - messages as bytes: a head of fixed size, then two texts. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/group/GroupMessage.h"

#include <cstring>
#include <type_traits>

namespace osgRayTrace::app
{

namespace
{

struct Head
{
    std::uint64_t textSize;
    std::uint64_t hostSize;
    RayTotals rays;
    double seconds;
    std::uint64_t bytes;
    std::int32_t kind, first, end, flag;
    Processors processors;
    std::int32_t unused;
};
static_assert(std::is_trivially_copyable_v<Head> && sizeof(Head) == 104, "it has no padding");

} // namespace

std::vector<char> packed(const GroupMessage& m)
{
    const Head head{m.text.size(),
                    m.host.size(),
                    m.rays,
                    m.seconds,
                    m.bytes,
                    static_cast<std::int32_t>(m.kind),
                    m.first,
                    m.end,
                    m.flag,
                    m.processors,
                    0};
    std::vector<char> bytes(sizeof head);
    std::memcpy(bytes.data(), &head, sizeof head);
    bytes.insert(bytes.end(), m.text.begin(), m.text.end());
    bytes.insert(bytes.end(), m.host.begin(), m.host.end());
    return bytes;
}

std::optional<GroupMessage> unpacked(const std::vector<char>& bytes)
{
    Head head;
    if (bytes.size() < sizeof head) return std::nullopt;
    std::memcpy(&head, bytes.data(), sizeof head);
    const std::size_t texts = bytes.size() - sizeof head;
    if (head.textSize > texts || head.hostSize != texts - head.textSize) return std::nullopt;
    if (head.kind < 0 || head.kind > static_cast<std::int32_t>(GroupMessage::Kind::Bye))
        return std::nullopt;

    GroupMessage m(static_cast<GroupMessage::Kind>(head.kind));
    m.first = head.first;
    m.end = head.end;
    m.flag = head.flag;
    m.seconds = head.seconds;
    m.bytes = head.bytes;
    m.rays = head.rays;
    m.processors = head.processors;
    const char* text = bytes.data() + sizeof head;
    m.text.assign(text, head.textSize);
    m.host.assign(text + head.textSize, head.hostSize);
    return m;
}

} // namespace osgRayTrace::app
