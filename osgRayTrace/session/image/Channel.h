// Channel.h - the channels of an image beside its colours. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

namespace osgRayTrace::engine
{

/// Names the channels of the first hit and of the image's statistics, for resolveChannel.
enum class Channel : uint8_t
{
    Depth,    ///< 1 float: window depth in [0,1], 1 if nothing is hit
    Distance, ///< 1 float: along the ray from the eye's near plane or pole [length]; infinity: no
              ///< hit
    Normal,   ///< 3 floats: world space, unit, facing the viewer
    Albedo,   ///< 3 floats: linear
    Position, ///< 3 floats: world space (float)
    Id,       ///< 1 float: instance index + 1, 0 if nothing is hit
    Error,    ///< 3 floats: estimated standard error of the pixel's linear RGB
};

/// Returns the number of floats for each pixel.
int channelSize(Channel channel);

/// Returns the channel that users call by this name; nothing if no channel has it.
inline std::optional<Channel> channelOf(std::string_view name)
{
    constexpr std::pair<std::string_view, Channel> kNames[] = {
        {"depth", Channel::Depth},   {"distance", Channel::Distance}, {"normal", Channel::Normal},
        {"albedo", Channel::Albedo}, {"position", Channel::Position}, {"id", Channel::Id},
        {"error", Channel::Error},
    };
    for (const auto& [known, channel] : kNames)
        if (known == name) return channel;
    return std::nullopt;
}

} // namespace osgRayTrace::engine
