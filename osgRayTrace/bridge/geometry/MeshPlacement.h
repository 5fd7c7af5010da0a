// MeshPlacement.h - a mesh in its own coordinates, and the transform that places it. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/scene/Mesh.h"

#include <osg/Matrixd>

namespace osgRayTrace::engine
{

/// Holds the coordinates of the mesh of a placed geometry: the mesh has its own origin and unit if
/// the geometry's coordinates would lose precision in float.
struct MeshFrame
{
    osg::Matrixd meshFromLocal, localFromMesh;
};

MeshFrame meshFrame(const VertexBounds& bounds);

/// Returns whether the transform reverses windings.
bool isMirrored(const osg::Matrixd& m);

/// Sets the instance's transform. Returns false if Embree cannot invert the transform in float (see
/// TracedScene): the mesh must then be made in engine coordinates.
bool placeInstance(Instance& instance, const osg::Matrixd& engineFromMesh);

} // namespace osgRayTrace::engine
