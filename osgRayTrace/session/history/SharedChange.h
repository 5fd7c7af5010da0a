// SharedChange.h - what differs between two versions of a scene, found once for all views. Layer:
// session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/history/SceneChange.h"

#include <memory>

namespace osgRayTrace::engine
{

class TracedScene;

/// Returns the sceneChange of two versions, or null if there is none. All views and images that
/// compare these versions share the result; threads that ask meanwhile wait for it. Any thread may
/// call this function.
std::shared_ptr<const SceneChange> sharedChange(const std::shared_ptr<const TracedScene>& before,
                                                const std::shared_ptr<const TracedScene>& after);

} // namespace osgRayTrace::engine
