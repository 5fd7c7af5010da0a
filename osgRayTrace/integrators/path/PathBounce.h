// PathBounce.h - what the parts of the path tracer share: a tile at work, one bounce of a block.
// Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/integrators/path/PathQueue.h"
#include "osgRayTrace/integrators/path/PathReuse.h"
#include "osgRayTrace/integrators/shared/HitPoints.h"
#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/integrators/shared/PhotonGather.h"
#include "osgRayTrace/integrators/shared/SampledLights.h"
#include "osgRayTrace/photons/PhotonTracer.h"
#include "osgRayTrace/sampling/Sobol.h"
#include "osgRayTrace/shading/Bsdf.h"

#include <cmath>

namespace osgRayTrace::engine
{

OSGRAYTRACE_INLINE float powerHeuristic(float a, float b)
{
    const float ratio = b / a; // no overflow of a^2, and 1 for a = infinity
    return 1.0f / (1.0f + ratio * ratio);
}

constexpr int kRouletteBounce = 3; ///< paths are not ended by chance before this bounce

/// Sums of the tile, pixel by pixel; after them those of reused paths. See PathFlags::sum.
struct PixelSums
{
    float r[2 * kTilePixels] = {};
    float g[2 * kTilePixels] = {};
    float b[2 * kTilePixels] = {};
    float a[kTilePixels] = {};

    void add(PathFlags path, Vec3 radiance)
    {
        const uint32_t sum = path.sum();
        r[sum] += radiance.x;
        g[sum] += radiance.y;
        b[sum] += radiance.z;
    }

    /// The light that the reused path of a pixel has found from its second surface on.
    Vec3 reused(PathFlags path) const
    {
        const uint32_t sum = path.reused().sum();
        return Vec3(r[sum], g[sum], b[sum]);
    }
};

struct LightLanes;

struct Tile
{
    Tile(const PassContext& c, int l, int b, TileResult& r)
        : context(c),
          result(r),
          counts(r.counts),
          debug(r.debug),
          deltaLights(sampledDeltaLights(c)),
          left(l),
          bottom(b)
    {
    }

    bool looksUpPhotons() const { return context.photons && context.photonUse != PhotonUse::None; }

    const PassContext& context;
    TileResult& result;
    TileCounts& counts;
    DebugOutputs* debug;
    SampledLights deltaLights; ///< of the pass
    int left, bottom;
    PixelSums sums;
    PathQueue paths;
    ReuseGroups reuse;
    Bsdf bsdfs[kLanes];          ///< of the block at work
    GatherScratch gatherScratch; ///< of all photon look-ups
};

/// What one bounce of a block knows.
struct Bounce
{
    int number = 0;
    SurfaceLanes surface;
    Vec3Lanes normal;          ///< shading, on the side of the ray
    Vec3Lanes albedo;          ///< of diffuse lanes
    LaneMask diffuse = 0;      ///< plain Lambert lanes
    LaneMask general = 0;      ///< all other hits that scatter
    LaneMask smooth = 0;       ///< of these, those with mirror-like lobes only
    LaneMask transmissive = 0; ///< general lanes that transmit
    LaneMask gathering = 0;    ///< lanes that look up photons
    LaneMask rough = 0;        ///< of these, those that look up all photons
    LaneMask terminating = 0;  ///< of these, those that go on by mirror-like lobes only
    Bsdf* bsdfs = nullptr;     ///< of general lanes
};

void countRays(Tile& tile, const PathBlock& block, LaneMask lanes);

/// Two Sobol numbers of a dimension for each lane.
void dimensionPoints(const UintLanes& seeds, uint32_t passIndex, uint32_t dimension, FloatLanes& u,
                     FloatLanes& v);

/// Emission that the path met by chance, weighted against light samples; without that which photons
/// carry.
void addEmission(Tile& tile, const PathBlock& block, const SurfaceLanes& surface, PhotonUse use);

/// What rays that left the scene bring: the environment, weighted against samples of it, without
/// that which photons carry; to the eye and to mirrors it is seen, or else the background. number:
/// of the bounce.
void addEnvironment(Tile& tile, const PathBlock& block, LaneMask missed, int number, PhotonUse use);

/// Adds what the visible lanes get from one light sample. Lanes of withoutMis have no other chance
/// to meet this light: it has its full weight.
void addLight(Tile& tile, const PathBlock& block, const Bounce& bounce, const LightLanes& light,
              LaneMask visible, LaneMask withoutMis);

/// Samples of the environment; none without it. seeds: of light samples.
void sampleEnvironment(Tile& tile, PathBlock& block, const Bounce& bounce, const UintLanes& seeds);

/// One sample of the area lights, of the environment and one of each light without area.
void sampleLights(Tile& tile, PathBlock& block, const Bounce& bounce);

/// Sets the ray of each lane that goes on; the others leave block.active.
void scatter(Tile& tile, PathBlock& block, const Bounce& bounce);

/// Makes groups of the tile's pixels. No path is reused with photons of the local schedule, which
/// are counted pixel by pixel.
void beginReuse(Tile& tile, PhotonUse use);

/// Remembers where the camera rays of block b met diffuse surfaces.
void recordFirstSurfaces(Tile& tile, int b, const Bounce& bounce);

/// Marks for reuse the paths whose second surface is diffuse: what they find from here on is for
/// all pixels of the group that see it.
void reusePaths(Tile& tile, PathBlock& block, const Bounce& bounce);

/// Connects the pixels of a group to the second surfaces of its reused paths.
void connectPaths(Tile& tile);

/// Which lanes look up photons, and which of them end here but for their mirror-like lobes.
void chooseGathering(const PathBlock& block, Bounce& bounce, PhotonUse use);

/// Adds what the photons around the lanes' points send back along their rays.
void addPhotons(Tile& tile, const PathBlock& block, const Bounce& bounce);

/// Appends the lanes of a bounce to the tile's hit points: what addPhotons and sampleLights read of
/// them.
void keepHitPoints(const PathBlock& block, const Bounce& bounce, HitPoints& hits);

/// Photons and light samples at hit points that were kept: what bounces add where nothing is kept.
void gatherAtHitPoints(Tile& tile, const HitPoints& hits);

} // namespace osgRayTrace::engine
