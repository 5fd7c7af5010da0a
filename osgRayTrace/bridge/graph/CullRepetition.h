// CullRepetition.h - repeats the cull traversals of a conversion. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/graph/CullCapture.h"
#include "osgRayTrace/bridge/graph/PlacedVisitor.h"

#include <optional>

namespace osgRayTrace::engine
{

/// Repeats cull traversals of single nodes. It follows no state: callbacks may change that of the
/// nodes above, and few repetitions show anything new.
class CullRepetition : private PlacedVisitor
{
public:
    /// The input has a view and a pass, and lives as long as this object.
    explicit CullRepetition(const ConversionInput& input)
        : PlacedVisitor(input), _capture(*input.pass, *input.view, input.traversalMask)
    {
    }

    /// Repeats the cull traversal of the last node of a path from the root. Returns
    /// CullRecord::take(); nothing: the node cannot be placed, or the visitor has no clone.
    std::optional<bool> repeats(const osg::NodePath& path, CullRecord& record,
                                const CullRecord::SameState& sameState);

private:
    CullCapture _capture;
};

} // namespace osgRayTrace::engine
