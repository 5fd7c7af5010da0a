// SceneVolumes.h - sets the volumes of a Scene from osgVolume's tiles. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/textures/VolumeImages.h"
#include "osgRayTrace/bridge/common/ConversionReport.h"
#include "osgRayTrace/bridge/graph/CollectedGraph.h"
#include "osgRayTrace/scene/Scene.h"

namespace osgRayTrace::engine
{

/// Sets all volumes of a scene whose unit and colour rule are set. Tiles that cannot be placed or
/// read are counted and named.
void setVolumes(Scene& scene, const std::vector<CollectedTile>& tiles, VolumeImages& images,
                ConversionReport& report);

} // namespace osgRayTrace::engine
