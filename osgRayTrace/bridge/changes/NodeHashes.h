// NodeHashes.h - numbers made of the values of a node, a light or an array, to tell whether they
// have changed. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/NodeKind.h"
#include "osgRayTrace/bridge/common/ObjectIdentity.h"
#include "osgRayTrace/bridge/geometry/BufferHashes.h"

#include <osg/Geometry>
#include <osg/Group>

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// What decides on the matrix of a transform.
uint64_t matrixHash(NodeKind kind, const osg::Node& node);

/// The addresses in hashes are those of objects that WatchedGraph keeps alive.

/// Its state set, its children and which of them are on, its frame; of any kind but Geometry and
/// Untracked.
uint64_t nodeHash(NodeKind kind, const osg::Node& node);

/// The values of a light, its frame apart. kept: as in Hasher.
uint64_t lightHash(NodeKind kind, const osg::Node& node, KeptObjects* kept = nullptr);

/// Which arrays and primitive sets it has.
uint64_t arraysHash(const osg::Geometry& geometry);

/// What else decides on its conversion, its state set apart.
uint64_t conversionHash(const osg::Geometry& geometry);

/// The hint of a node as a number: most have none.
uint8_t hintHash(const osg::Node& node);

} // namespace osgRayTrace::engine
