// GroupMessage.h - what ranks tell each other. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// Rays of the camera, shadow, secondary and photon rays, and samples left out; since the begin.
using RayTotals = std::array<std::uint64_t, 5>;

/// Says how many processors a rank may use.
struct Processors
{
    std::int32_t own = 1;     ///< those that the rank may use
    std::int32_t core = 1;    ///< those of one core
    std::int32_t machine = 1; ///< those of its machine

    bool operator==(const Processors& o) const
    {
        return own == o.own && core == o.core && machine == o.machine;
    }
};

struct GroupMessage
{
    enum class Kind : std::int32_t
    {
        // From any rank to rank 0.
        Hello,  ///< the scene is there: text names the picture, host and processors tell where
        Want,   ///< passes [first, end) are done, in seconds; more are wanted
        Ready,  ///< the sums of passes text are ready for round first; flag: they have a high part
        Failed, ///< the rank can make no passes, because of text; first: exit code
        Stop,   ///< the rank was told to end
        Alive,  ///< nothing else; as a question of rank 0, too
        Room,   ///< there is memory for the scene

        // From rank 0 to any rank.
        Scene, ///< make room for the bytes of a scene; the picture has first x end pixels
        Bytes, ///< the scene comes now
        Take,  ///< make passes [first, end)
        Round, ///< get ready for round first, with all passes taken; flag: leave those not begun
        Sum,   ///< add up; flag: the high parts as well; first: the rank of the depths
        End,   ///< make no more passes
        Abort, ///< leave at once: a rank is dead
        Bye,   ///< leave; the last kind
    };

    explicit GroupMessage(Kind k = Kind::Alive) : kind(k) {}

    Kind kind;
    std::int32_t first = 0;
    std::int32_t end = 0;
    std::int32_t flag = 0;
    double seconds = 0.0;
    std::uint64_t bytes = 0; ///< of the scene
    RayTotals rays{};
    Processors processors;
    std::string text;
    std::string host;
};

/// Returns the message as bytes, for processes of the same build.
std::vector<char> packed(const GroupMessage& message);

/// Returns the message of such bytes; nothing for others.
std::optional<GroupMessage> unpacked(const std::vector<char>& bytes);

} // namespace osgRayTrace::app
