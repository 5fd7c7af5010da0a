// SharedScene.h - rank 0 gives the scene to the ranks that have not read it. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/group/Group.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// A scene on its way, as bytes that a Renderer packs and unpacks.
struct SentScene
{
    int width = 0, height = 0; ///< of the picture
    std::vector<unsigned char> bytes;
};

/// Why a scene could not be given to all.
struct SendFailure
{
    int exitCode = 0; ///< 0: all have it
    std::string text; ///< one sentence
};

/// Gives the scene to all other ranks, from rank 0: each is asked whether it has room first. They
/// call receiveScene(). now is a clock [s]: a rank that does not answer within a minute is named.
SendFailure sendScene(Group& group, SentScene& scene, const std::function<double()>& now);

/// Waits on another rank for rank 0's scene, which may take long to read. Returns nothing if rank 0
/// wants no passes, as when it cannot read the model. Throws std::runtime_error if there is not
/// enough memory.
std::optional<SentScene> receiveScene(Group& group);

} // namespace osgRayTrace::app
