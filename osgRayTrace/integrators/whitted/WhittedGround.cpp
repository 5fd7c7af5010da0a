// WhittedGround.cpp - shadows on the ground before what the rays of a block see. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/shared/ShadowCatcher.h"
#include "osgRayTrace/integrators/whitted/WhittedTile.h"

namespace osgRayTrace::engine
{

void passGround(WhittedTile& tile, ShadingBlock& block, LaneMask active)
{
    if (!tile.context.traced->traits().media) block.dimmed = 0;
    CaughtShadows caught;
    catchShadows(tile.context, {block.rays, active, block.seed, 0}, tile.result.counts, caught);
    for (const int i : lanesIn(caught.lanes))
    {
        setLane(block.weight, i, laneOf(block.weight, i) * caught.share[i]);
        if (!((block.dimmed >> i) & 1u)) setLane(block.air, i, Vec3(0.0f));
    }
    block.dimmed |= caught.lanes;
}

} // namespace osgRayTrace::engine
