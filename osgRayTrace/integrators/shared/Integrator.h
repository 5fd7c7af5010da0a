// Integrator.h - the interface of the estimators of radiance. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/PassContext.h"
#include "osgRayTrace/integrators/shared/TileResult.h"

namespace osgRayTrace::engine
{

/// The estimator of one pass for one tile of one view. An integrator has no state: any thread may
/// call it for any tile.
class Integrator
{
public:
    virtual ~Integrator() = default;

    /// Traces one sample of every pixel of the tile, also of pixels outside of the image. (left,
    /// bottom) is the tile's first pixel.
    virtual void renderTile(const PassContext& context, int left, int bottom,
                            TileResult& result) const = 0;
};

} // namespace osgRayTrace::engine
