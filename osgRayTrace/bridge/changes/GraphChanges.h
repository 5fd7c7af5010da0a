// GraphChanges.h - what has changed in a scene graph since it was converted. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/changes/ConversionReason.h"
#include "osgRayTrace/bridge/common/ObjectIdentity.h"

#include <osg/Geometry>
#include <osg/Matrixd>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// One path to a geometry.
struct ChangedUse
{
    const osg::Geometry* geometry = nullptr;
    uint32_t use = 0;  ///< number of this path among those to the geometry, in traversal order
    uint32_t uses = 0; ///< that there are
};

/// One whose transforms changed.
struct MovedUse : ChangedUse
{
    osg::Matrixd worldFromLocal;
};

/// One that has other state, or other arrays.
struct StateChange : MovedUse
{
    osg::NodePath path; ///< from the first node that was found to the geometry
};

/// Nodes that came or went.
struct GraphSplice
{
    std::vector<ChangedUse> removed;   ///< numbers and uses as they were before
    osg::NodePath removedFrom;         ///< to the parent of the node that went
    std::vector<Kept<osg::Node>> gone; ///< what removed points to
    osg::NodePath added;               ///< to the node that came; empty: none
    std::vector<ChangedUse> uses;      ///< of what came, in traversal order, as they are then
};

/// Pointers into the graph: valid as long as nobody changes it. The numbers of uses in moved,
/// deformed and stateChanges are those after all splices.
struct GraphChanges
{
    bool convert = false; ///< the graph is to be converted again: there is more than what follows
    bool record = false;  ///< and to be recorded again
    ConversionReason reason;          ///< why convert is set: the first reason that was found
    std::vector<GraphSplice> splices; ///< in the order in which they are to be made
    std::vector<MovedUse> moved;
    std::vector<const osg::Geometry*> deformed; ///< other positions, normals or primitives
    std::vector<StateChange> stateChanges;
    bool lights = false; ///< values of lights of any kind

    bool none() const
    {
        return !convert && splices.empty() && moved.empty() && deformed.empty() &&
               stateChanges.empty() && !lights;
    }
};

} // namespace osgRayTrace::engine
