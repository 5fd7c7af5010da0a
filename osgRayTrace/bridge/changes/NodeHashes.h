// NodeHashes.h - hashes of the values of a node, a light or an array, to tell changes. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/NodeKind.h"
#include "osgRayTrace/bridge/common/ObjectIdentity.h"
#include "osgRayTrace/bridge/geometry/BufferHashes.h"

#include <osg/ClipNode>
#include <osg/Geometry>
#include <osg/Group>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Returns a hash of the values that decide on the matrix of a transform.
uint64_t matrixHash(NodeKind kind, const osg::Node& node);

/// The addresses in these hashes are those of objects that WatchedGraph keeps alive.

/// Returns a hash of a node's state set, its cull callback, its children, which of them are on, and
/// its frame, for any kind but Geometry and Untracked.
uint64_t nodeHash(NodeKind kind, const osg::Node& node);

/// Returns a hash of the values of a light except for its frame. kept is as in Hasher.
uint64_t lightHash(NodeKind kind, const osg::Node& node, KeptObjects* kept = nullptr);

/// Returns a hash of the planes of a clip node in this place.
uint64_t clipHash(const osg::ClipNode& node, const osg::Matrixd& sceneFromPlanes);

/// Returns a hash of the arrays and primitive sets that a geometry has. attributes is as in
/// forEachBuffer.
uint64_t arraysHash(const osg::Geometry& geometry, bool attributes);

/// Returns a hash of all else that decides on a geometry's conversion, except for its state set.
uint64_t conversionHash(const osg::Geometry& geometry);

/// Returns the hint of a node as a number; most nodes have none.
uint8_t hintHash(const osg::Node& node);

} // namespace osgRayTrace::engine
