// StatesAbove.h - the state that a scene graph inherits. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/bridge/graph/ConversionInput.h"

namespace osgRayTrace::engine
{

/// State above the scene graph, as osgViewer and osgUtil::SceneView set it, and what is inherited.
StateStack statesAbove(const ConversionInput& input);

} // namespace osgRayTrace::engine
