// PassSumsState.h - public sums of passes to the engine's and back. Layer: public API, private.
// SPDX-License-Identifier: MIT
#pragma once

#include <osgRayTrace/PassSums>

#include "osgRayTrace/film/PassSums.h"

#include <optional>
#include <string>

namespace osgRayTrace
{

/// Returns the engine's sums; nothing if sizes or passes cannot be right.
std::optional<engine::PassSums> engineSums(PassSums sums);

/// Returns sums without the text that names the picture.
PassSums publicSums(engine::PassSums sums);

/// Returns the first line in which the picture of the sums is another one; empty if it is this one.
std::string whyNotOf(const PassSums& sums, const std::string& picture);

} // namespace osgRayTrace
