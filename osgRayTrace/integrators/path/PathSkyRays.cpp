// PathSkyRays.cpp - more rays that look for a sky that is hard to find. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// Samples of the sky leave directions that are no brighter than its mean to the rays that surfaces
// send on [Karlik19]. In a room few of these rays find a window, which makes most of the
// noise. So diffuse surfaces that the eye sees send n rays more, of the same density, which add the
// light of the sky and end. The path's own ray adds its share, 1 / (n + 1), if it meets the sky
// next:
//
//   L_sky = 1 / (n + 1) * sum over n + 1 rays of albedo w_bsdf L(omega) V(omega)
//
// n depends on the rays of the blocks of the tile that were there before in the same pass. They
// belong to other pixels, whose numbers are independent, so the mean is the same for any rule.
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr int kSkyRays = 4;         ///< rays of a pixel where the sky is hard to find
constexpr float kHardToFind = 0.3f; ///< share of the rays that find it
constexpr int kVain = 128;          ///< without any find among so many rays, a tile sends no more

/// The rays' dimensions lie apart from those of bounces and of samples of the sky.
constexpr uint32_t kSkyRaysDimension = 0x20000u;

/// Returns how many rays each pixel of the next block sends.
int raysOf(const SkyRays& sky)
{
    if (sky.found == 0) return sky.asked < kVain ? 1 : 0;
    const float share = static_cast<float>(sky.found) / static_cast<float>(sky.asked);
    return share < kHardToFind ? kSkyRays : 0;
}

/// Returns the lanes that scatter as Lambert's surfaces do, textured ones among them. Blocks some
/// of whose paths go on below surfaces have none: light is added in their bounces more than once.
LaneMask diffuseLanes(const Bounce& bounce)
{
    if (bounce.subsurface || bounce.below) return 0;
    LaneMask lanes = bounce.diffuse;
    for (const int i : lanesIn(bounce.general & ~bounce.transmissive))
        lanes |= static_cast<LaneMask>(bounce.bsdfs[i].isDiffuse()) << i;
    return lanes;
}

/// Sets rays of the lanes with densities cos / pi; their radiance is 1.
void skyRays(const SurfaceLanes& surface, const Vec3Lanes& normal, LaneMask lanes,
             const FloatLanes& u, const FloatLanes& v, LightLanes& samples)
{
    samples.lit = samples.tinted = 0;
    for (const int i : lanesIn(lanes))
    {
        const PlainVec3 local = squareToCosineHemispherePlain(u[i], v[i]);
        const Vec3 wi = ShadingFrame(laneOf(normal, i)).toWorld(Vec3(local.x, local.y, local.z));
        if (!(local.z > 0.0f) || !isAbove(surface, i, wi)) continue;
        setSample(samples, i, wi, Vec3(1.0f), 1.0f / (local.z * kInvPi));
        setRay(samples.shadow, i, leave(surface, i, wi), wi, kInfinity);
        samples.lit |= 1u << i;
    }
}

} // namespace

void beginSkyRays(Tile& tile, PhotonUse use)
{
    const TracedScene& traced = *tile.context.traced;
    tile.sky.active = traced.lights().shiningEnvironment() && !tile.context.portals &&
                      use == PhotonUse::None && !traced.traits().media && !tile.context.strata &&
                      tile.context.options.shadows;
}

void addSkyRays(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    const LaneMask lanes = diffuseLanes(bounce);
    const int rays = raysOf(tile.sky);
    if (rays == 0 || !lanes) return;
    const PlacedEnvironment& environment = *tile.context.traced->lights().shiningEnvironment();
    const float share = 1.0f / static_cast<float>(rays + 1);
    int asked = 0, found = 0;
    for (int j = 0; j < rays; ++j)
    {
        FloatLanes u, v;
        dimensionPoints(block.seed, tile.context.key.index * kSkyRays + static_cast<uint32_t>(j),
                        bounceDimension(bounce.number, DimensionBsdfDirection) + kSkyRaysDimension,
                        u, v);
        LightLanes samples;
        skyRays(bounce.surface, bounce.normal, lanes, u, v, samples);
        countRays(tile, block, samples.lit);
        const LaneMask visible = visibleLanes(tile.context, samples, tile.counts);
        asked += countLanes(samples.lit);
        found += countLanes(visible);
        for (const int i : lanesIn(visible))
        {
            const Vec3 wi = laneOf(samples.wi, i);
            const float mis = powerHeuristic(1.0f / samples.weight[i],
                                             environmentPdfW(tile.context, environment, wi));
            const Vec3 light = environment.radiance(wi) * (mis * share);
            for (int c = 0; c < 3; ++c)
                samples.radiance[c][i] *= light[c]; // what panes let through
        }
        addLight(tile, block, bounce, samples, visible, kAllLanes);
    }
    tile.sky.asked += asked;
    tile.sky.found += found;
    const uint32_t b = block.flagsOf(firstLane(lanes)).pixel() / kLanes;
    tile.sky.counts[b] = rays;
    tile.sky.lanes[b] = lanes;
}

float shareOfSky(const Tile& tile, PathFlags path, int number)
{
    const uint32_t b = path.pixel() / kLanes, i = path.pixel() % kLanes;
    if (number != 1 || !((tile.sky.lanes[b] >> i) & 1u)) return 1.0f;
    return 1.0f / static_cast<float>(tile.sky.counts[b] + 1);
}

} // namespace osgRayTrace::engine
