// Enclosures.h - leaves out proxies of skies, which would keep the light off. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/graph/CollectedGraph.h"
#include "osgRayTrace/bridge/graph/ConversionInput.h"
#include "osgRayTrace/scene/Scene.h"

#include <vector>

namespace osgRayTrace::engine
{

/// A dome may end this share of its size above what stands in it.
constexpr double kEnclosureMargin = 0.1;

/// Drops each proxy that encloses all the rest of the graph and cuts the rest off from a light
/// outside, as the dome of a sky does. The bounds of the geometries must be set, and the unit not
/// yet applied.
void dropEnclosures(CollectedGraph& graph, const ConversionInput& input);

/// Returns whether a use may enclose all of a scene, for which it would have no proxy (see
/// Enclosures.h): no mesh of the scene is known to have a corner outside its box. A mesh is asked
/// for its first corner alone. Only instances that have changed since a stamp are asked; 0: all.
bool mayEnclose(const Scene& scene, const VertexBounds& bounds, const osg::Matrixd& engineFromLocal,
                Stamp since = 0);

/// Drops what has a proxy, but may enclose the scene as far as mayEnclose() can tell: patches would
/// find it changed.
void dropDoubtful(std::vector<Enclosure>& enclosures, const Scene& scene);

} // namespace osgRayTrace::engine
