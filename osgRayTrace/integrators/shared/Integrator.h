// Integrator.h - the seam between a session and the algorithms that make pictures. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/PassContext.h"
#include "osgRayTrace/integrators/shared/TileResult.h"

namespace osgRayTrace::engine
{

/// One pass for one tile of one view. Stateless: any thread may call it for any tile.
class Integrator
{
public:
    virtual ~Integrator() = default;

    /// left, bottom: the tile's first pixel. Every pixel of the tile gets one sample, also those
    /// outside of the image.
    virtual void renderTile(const PassContext& context, int left, int bottom,
                            TileResult& result) const = 0;
};

} // namespace osgRayTrace::engine
