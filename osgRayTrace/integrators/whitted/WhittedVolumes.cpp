// WhittedVolumes.cpp - volumes that are marched as OpenGL draws them, and densities. Layer:
// integrators.
// SPDX-License-Identifier: MIT
//
// Volumes are put before each other from front to back, each as a whole. The densities and the
// homogeneous media of a ray count as nearer than volumes of other laws.
#include "osgRayTrace/integrators/whitted/WhittedVolumes.h"

#include "osgRayTrace/integrators/shared/MediumNumbers.h"
#include "osgRayTrace/integrators/shared/VolumeLightChoice.h"
#include "osgRayTrace/media/GridMarch.h"

#include <algorithm>
#include <array>

namespace osgRayTrace::engine
{

bool findDensities(const PassContext& context, RayPart& part, const MediumRecord& around,
                   bool fills, Vec3 origin, Vec3 direction, float end,
                   std::optional<GridRay>& grids)
{
    grids.emplace(context.traced->grids(), origin, direction, 0.0f, end, GridKinds::Densities);
    if (grids->isEmpty())
    {
        grids.reset();
        return false;
    }
    if (fills) grids->setAround(around, part);
    part = grids->extent();
    return true;
}

void dimByDensities(const PassContext& context, ShadingBlock& block, int i, const GridRay& grids,
                    Vec3 light)
{
    const MediumNumbers seeds(block.seed[i], context.key.index, block.depth[i], 0);
    NumberStream numbers(seeds.seedOf(MediumFlight));
    const GridWay way = grids.way(numbers);
    const Vec3 weight = laneOf(block.weight, i);
    setLane(block.air, i, weight * way.emitted + light);
    setLane(block.weight, i, weight * way.left);
}

void addVolumes(const WhittedTile& tile, ShadingBlock& block, LaneMask active)
{
    const GridTable& grids = tile.context.traced->grids();
    const VolumeLight light = volumeLight(tile.context);
    const RayBlock& ray = block.rays.ray;
    for (const int i : lanesIn(active))
    {
        const bool hit = (block.surface.hits >> i) & 1u;
        const Vec3 origin(ray.originX[i], ray.originY[i], ray.originZ[i]);
        std::array<MarchedVolume, kMostVolumes> found;
        std::size_t count = 0;
        for (std::size_t k = 0; k < grids.size(); ++k)
        {
            if (grids[k].volume->law == VolumeLaw::Density) continue;
            const MarchedVolume seen = march(grids[k], origin, directionOf(ray, i), 0.0f,
                                             hit ? ray.tFar[i] : kInfinity, light);
            if (seen.opacity > 0.0f) found[count++] = seen;
        }
        if (count == 0) continue;
        std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count),
                  [](const MarchedVolume& a, const MarchedVolume& b) { return a.begin < b.begin; });
        Vec3 weight = laneOf(block.weight, i), air = laneOf(block.air, i);
        for (std::size_t k = 0; k < count; ++k)
        {
            air += weight * found[k].color;
            weight *= 1.0f - found[k].opacity;
        }
        setLane(block.air, i, air);
        setLane(block.weight, i, weight);
        block.dimmed |= 1u << i;
    }
}

} // namespace osgRayTrace::engine
