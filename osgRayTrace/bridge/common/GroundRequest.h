// GroundRequest.h - where the option "ground" puts the ground. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/NumberText.h"

#include <cmath>
#include <optional>
#include <string>

namespace osgRayTrace::engine
{

/// Holds where a scene gets a ground.
struct GroundRequest
{
    bool wanted = false;
    bool below = false;  ///< true: the ground is right below what is traced
    double height = 0.0; ///< z of the ground, if it is not below [world]

    bool operator==(const GroundRequest& other) const
    {
        return wanted == other.wanted && below == other.below && height == other.height;
    }
};

/// Parses "none" or "", "auto", or a height; nothing if the text is none of these.
inline std::optional<GroundRequest> parseGround(const std::string& text)
{
    if (text.empty() || text == "none") return GroundRequest();
    if (text == "auto") return GroundRequest{true, true, 0.0};
    const std::optional<double> height = parseNumber<double>(text);
    if (!height || !std::isfinite(*height)) return std::nullopt;
    return GroundRequest{true, false, *height};
}

} // namespace osgRayTrace::engine
