// GraphHash.h - checks cheaply whether a scene graph has changed. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/ObjectIdentity.h"
#include "osgRayTrace/bridge/common/ViewingConditions.h"
#include "osgRayTrace/bridge/graph/PathBudget.h"

#include <osg/Matrixd>
#include <osg/Node>

#include <cstdint>
#include <unordered_set>

namespace osgRayTrace::engine
{

class BufferVersions;

/// Returns a number that changes with the children that are active for the eye, their order and
/// masks, with transforms, and with the modified counts and bounds of geometry. The number also
/// changes with state sets and with the values of the attributes and lights that are traced,
/// including those of the inherited state. Vertex data that is written without Array::dirty(), and
/// images without Image::dirty(), go unseen: dirtyScene() is for such changes. The graph is only
/// read. sceneFromLocal belongs to the place of root. kept is as in Hasher. versions stand for the
/// modified counts of arrays and primitive sets, so that equal values are no change; this is
/// slower. Nodes beyond budget go unseen; null: the call has a budget of its own. Of the followed
/// nodes and what is below them, nodes, masks and hints alone count, unless they have special
/// nodes.
uint64_t graphHash(osg::Node& root, const ViewingConditions& conditions,
                   const osg::Matrixd& sceneFromLocal = osg::Matrixd(), KeptObjects* kept = nullptr,
                   BufferVersions* versions = nullptr, PathBudget* budget = nullptr,
                   const std::unordered_set<const osg::Node*>* followed = nullptr);

/// Returns a number that changes with what of such a graph decides on which of its parts OSG draws:
/// with its nodes, masks, hints and state, and not with arrays, bounds and transforms.
uint64_t structureHash(osg::Node& root, const ViewingConditions& conditions, PathBudget& budget);

/// Returns whether a node or one below it is a light or places state for others.
bool hasSpecialNodes(osg::Node& node);

} // namespace osgRayTrace::engine
