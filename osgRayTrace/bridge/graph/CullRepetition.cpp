// CullRepetition.cpp - places nodes by their paths, and captures them. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/graph/CullRepetition.h"

#include <osg/Transform>

namespace osgRayTrace::engine
{

std::optional<bool> CullRepetition::repeats(const osg::NodePath& path, CullRecord& record,
                                            const CullRecord::SameState& sameState)
{
    if (!_input.pass->isClone) return std::nullopt;
    getNodePath().clear();
    _worldFromLocal.resize(1);
    for (auto node = path.begin(); node + 1 != path.end(); ++node)
    {
        pushOntoNodePath(*node);
        const osg::Transform* transform = (*node)->asTransform();
        if (transform && enterPlace(worldBelow(*transform))) return std::nullopt;
    }
    return _capture.node(path, _worldFromLocal.back(), record, sameState);
}

} // namespace osgRayTrace::engine
