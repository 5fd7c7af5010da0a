// StatesAbove.h - collects the state that a scene graph inherits. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/StateStack.h"
#include "osgRayTrace/bridge/graph/ConversionInput.h"

namespace osgRayTrace::engine
{

/// Returns the state above the scene graph: the state that osgViewer and osgUtil::SceneView set,
/// and the inherited state of the input.
StateStack statesAbove(const ConversionInput& input);

} // namespace osgRayTrace::engine
