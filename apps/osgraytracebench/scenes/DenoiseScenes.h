// DenoiseScenes.h - the boxes on which the denoiser is measured. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/scenes/BenchScenes.h"

namespace osgRayTrace::bench
{

/// Returns the Cornell box with a floor of rough metal, glossy blocks and lacquered walls.
BenchScene glossyBox(int width, int height);

/// Returns the Cornell box with pictures of tiles, of stripes and of fine noise on its walls, floor
/// and blocks.
BenchScene texturedBox(int width, int height);

} // namespace osgRayTrace::bench
