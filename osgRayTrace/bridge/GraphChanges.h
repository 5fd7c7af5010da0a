// GraphChanges.h - what has changed in a scene graph since it was converted. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/Matrixd>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// One path to a geometry whose transforms changed.
struct MovedUse
{
    const osg::Geometry* geometry = nullptr;
    uint32_t use = 0;  ///< number of this path among those to the geometry, in traversal order
    uint32_t uses = 0; ///< that there are
    osg::Matrixd worldFromLocal;
};

/// Pointers into the graph: valid as long as nobody changes it.
struct GraphChanges
{
    bool convert = false; ///< the graph is to be converted again: there is more than what follows
    bool record = false;  ///< and to be recorded again: other nodes are visible
    std::vector<MovedUse> moved;
    std::vector<const osg::Geometry*> deformed; ///< other positions, normals or primitives

    bool none() const { return !convert && moved.empty() && deformed.empty(); }
};

} // namespace osgRayTrace::engine
