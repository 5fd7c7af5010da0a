// UpsampleSource.h - the inputs of all blocks of an image that is upsampled. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/session/image/ResolvedImage.h"
#include "osgRayTrace/session/upsample/UpsampleCells.h"

namespace osgRayTrace::engine
{

/// Holds the inputs of all blocks of an image.
struct UpsampleSource
{
    const ResolvedImage& image;
    const SurfaceSample* samples;
    const PassContext& full;
    UpsampleAxis x, y;
};

} // namespace osgRayTrace::engine
