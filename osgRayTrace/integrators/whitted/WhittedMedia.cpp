// WhittedMedia.cpp - absorption, emission and single scattering along the rays of a block. Layer:
// integrators.
// SPDX-License-Identifier: MIT
//
// Whitted's integrator has no walks: media take light from rays by exp(-sigmaT t) and add what they
// scatter once of the light of lights, sampled as in path tracing. Light that is scattered more
// than once is left out, and within bodies with a boundary that bends light also what is scattered
// once.
#include "osgRayTrace/integrators/shared/SegmentLights.h"
#include "osgRayTrace/integrators/whitted/WhittedTile.h"
#include "osgRayTrace/integrators/whitted/WhittedVolumes.h"
#include "osgRayTrace/media/Transmittance.h"

#include <memory>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the medium of a ray: that of the body whose inner side the ray meets, or else what is
/// around bodies. Nothing if the body bends light, which attenuate() knows of.
MediumStack bodiesOf(const MediumTable& media, const SurfaceLanes& surface, int i, bool& known)
{
    known = true;
    const bool inner = ((surface.hits & ~surface.front) >> i) & 1u;
    const MediumId body = inner ? media.interiorOf(surface.material[i]) : kOutside;
    if (body == kOutside) return {};
    known = media.isInterface(surface.material[i]);
    return MediumStack().entered(body);
}

} // namespace

void addAir(WhittedTile& tile, ShadingBlock& block, LaneMask active)
{
    const PassContext& context = tile.context;
    const MediumTable& media = context.traced->media();
    const RayBlock& ray = block.rays.ray;
    MediumSegments segments;
    segments.ray = &ray;
    segments.withMis = false;
    segments.throughput = block.weight;
    block.dimmed = 0;
    const std::unique_ptr<GridLanes> grids =
        context.traced->traits().volumes ? std::make_unique<GridLanes>() : nullptr;
    segments.grids = grids.get();
    LaneMask filled = 0; // lanes of homogeneous media alone
    for (const int i : lanesIn(active))
    {
        setLane(block.air, i, Vec3(0.0f));
        bool known;
        segments.bodies[i] = bodiesOf(media, block.surface, i, known);
        const MediumId medium = segments.media[i] = media.at(segments.bodies[i]);
        const bool isClear = !known || media[medium].isClear;
        if (isClear && !grids) continue;
        const bool hit = (block.surface.hits >> i) & 1u;
        const Vec3 origin(ray.originX[i], ray.originY[i], ray.originZ[i]);
        const float end = hit ? ray.tFar[i] : kInfinity;
        if (!isClear)
            segments.parts[i] = media.clipped(medium, origin, directionOf(ray, i), 0.0f, end);
        if (grids && findDensities(context, segments.parts[i], media[isClear ? kOutside : medium],
                                   !isClear, origin, directionOf(ray, i), end, (*grids)[i]))
        {
            block.dimmed |= 1u << i;
            if ((*grids)[i]->scatters()) segments.lanes |= 1u << i;
            continue;
        }
        if (segments.parts[i].isEmpty()) continue;
        block.dimmed |= 1u << i;
        filled |= 1u << i;
        if (media[medium].scatters) segments.lanes |= 1u << i;
    }
    const int samples = segments.lanes ? lightSampleCount(context.options) : 0;
    Vec3Lanes light;
    for (int i = 0; i < kLanes; ++i)
        setLane(light, i, Vec3(0.0f));
    for (int k = 0; k < samples; ++k)
    {
        for (const int i : lanesIn(segments.lanes))
            segments.numbers[i] = MediumNumbers(block.seed[i],
                                                context.key.index * static_cast<uint32_t>(samples) +
                                                    static_cast<uint32_t>(k),
                                                block.depth[i], 0);
        addSegmentLights(context, tile.deltaLights, segments, tile.result.counts, light);
    }
    const float share = samples > 0 ? 1.0f / static_cast<float>(samples) : 0.0f;
    for (const int i : lanesIn(block.dimmed & ~filled))
        dimByDensities(context, block, i, *(*grids)[i], laneOf(light, i) * share);
    for (const int i : lanesIn(filled))
    {
        const MediumRecord& medium = media[segments.media[i]];
        const float length = segments.lengthOf(i, medium);
        const Vec3 weight = laneOf(block.weight, i);
        const Vec3 emitted = weight * emittedAlong(medium.emission, medium.sigmaT, length);
        setLane(block.air, i, emitted + laneOf(light, i) * share);
        setLane(block.weight, i, weight * transmittance(medium.sigmaT, length));
    }
    if (grids) addVolumes(tile, block, active);
}

void dimSamples(const WhittedTile& tile, LaneMask visible, LightLanes& samples)
{
    MediumLanes bodies; // shadow rays that begin within a body find it at its inner side
    dimByMedia(tile.context, bodies, visible, samples);
}

} // namespace osgRayTrace::engine
