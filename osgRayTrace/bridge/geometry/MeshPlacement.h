// MeshPlacement.h - a mesh in coordinates of its own and the transform that places it. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/scene/Mesh.h"

#include <osg/Matrixd>

namespace osgRayTrace::engine
{

/// Of a geometry that is placed: its mesh has its own origin and unit where those of the geometry
/// would lose in float.
struct MeshFrame
{
    osg::Matrixd meshFromLocal, localFromMesh;
};

MeshFrame meshFrame(const VertexBounds& bounds);

/// True if the transform turns windings.
bool isMirrored(const osg::Matrixd& m);

/// Sets the instance's transform. False if Embree cannot invert it in float (see TracedScene): then
/// the mesh must be made in engine coordinates.
bool placeInstance(Instance& instance, const osg::Matrixd& engineFromMesh);

} // namespace osgRayTrace::engine
