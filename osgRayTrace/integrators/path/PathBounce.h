// PathBounce.h - a tile at work and one bounce of a block of paths. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Surface.h"
#include "osgRayTrace/integrators/path/PathQueue.h"
#include "osgRayTrace/integrators/path/PathReuse.h"
#include "osgRayTrace/integrators/shared/HitPoints.h"
#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/integrators/shared/PhotonGather.h"
#include "osgRayTrace/integrators/shared/SampledLights.h"
#include "osgRayTrace/photons/BeamMap.h"
#include "osgRayTrace/photons/PhotonTracer.h"
#include "osgRayTrace/sampling/Sobol.h"
#include "osgRayTrace/shading/Bsdf.h"
#include "osgRayTrace/shading/LayeredBsdf.h"

#include <cmath>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

OSGRAYTRACE_INLINE float powerHeuristic(float a, float b)
{
    const float ratio = b / a; // avoids an overflow of a^2, and gives 1 for a = infinity
    return 1.0f / (1.0f + ratio * ratio);
}

constexpr int kRouletteBounce = 3; ///< first bounce at which roulette may end paths

/// Paths with a throughput below this bound may be ended by chance. Measurements on the Cornell box
/// find bounds of 0.33 to 0.5 equally good: 1 leaves more noise, and below 0.3 paths cost more.
constexpr float kRouletteThroughput = 0.4f;

/// PixelSums holds the radiance sums of the tile's pixels, followed by the sums of reused paths.
/// PathFlags::sum is the index.
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

    /// Returns the radiance that the pixel's reused path has found from its second surface on.
    Vec3 reused(PathFlags path) const
    {
        const uint32_t sum = path.reused().sum();
        return Vec3(r[sum], g[sum], b[sum]);
    }
};

struct LightLanes;

/// What the tile knows of rays that ask for the sky: see PathSkyRays.cpp.
struct SkyRays
{
    bool active = false;
    int asked = 0, found = 0;         ///< rays of this pass, and those of them that met the sky
    int counts[kTileBlocks] = {};     ///< rays of each pixel of a block's
    LaneMask lanes[kTileBlocks] = {}; ///< pixels that have asked
};

/// A place that a beam of the sky lights: see PathSunSpots.cpp.
struct SunSpot
{
    Vec3 position, normal; ///< the normal is on the lit side
    float offset;          ///< as that of SurfaceLanes
    Vec3 radiance; ///< that it sends back per solid angle of the beam's direction [W/(m^2 sr^2)]
    float byLight; ///< density of light samples at the spot towards the beam [1/sr]
    float byBeam;  ///< density of beams [1/(sr area)]
};

/// The spots of a tile.
struct SunSpots
{
    static constexpr int kBeams = 64;

    bool active = false; ///< the pass knows portals whose beams light spots
    int count = 0;       ///< of spots: beams that ended at surfaces that can be spots
    int outside = 0;     ///< the first ones, whose beams have passed no pane; 0 without panes
    SunSpot spots[kBeams];
};

/// The glossy surfaces that camera rays of a block met, and the paths as they came there.
struct GlossyBlock
{
    LaneMask lanes = 0;
    SurfaceLanes surface;
    Vec3Lanes normal; ///< shading normals on the side of the ray
    PathBlock path;
    std::vector<Bsdf> bsdfs; ///< of the lanes, in their order

    bool has(uint32_t lane) const { return (lanes >> lane) & 1u; }
    const Bsdf& bsdf(int lane) const
    {
        return bsdfs[static_cast<std::size_t>(countLanes(lanes & ((1u << lane) - 1u)))];
    }
};

/// What the tile knows of paths from glossy surfaces to glossy surfaces: see PathChains.cpp.
struct GlossyChains
{
    bool active = false;
    std::unique_ptr<GlossyBlock> first[kTileBlocks]; ///< null: the block has none
    /// Rays of each pixel that met a glossy surface after the first; 0: the path's own ray did not.
    uint8_t rays[kTilePixels] = {};
    LaneMask met[kTileBlocks] = {}; ///< pixels that have such rays
};

/// The light that pixels have from discs that no footprint is compared with.
struct BlurredLight
{
    Vec3 pixels[kTilePixels] = {};
};

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
    SampledLights deltaLights; ///< delta lights of the pass
    int left, bottom;
    PixelSums sums;
    PathQueue paths;
    ReuseGroups reuse;
    SkyRays sky;
    SunSpots spots;
    GlossyChains chains;
    Bsdf bsdfs[kLanes];                    ///< BSDFs of the block at work
    GatherScratch gatherScratch;           ///< scratch of all photon look-ups
    std::unique_ptr<BlurredLight> blurred; ///< null: there is none
    bool hasBeams = false;                 ///< beams are those near the tile's camera rays
    BeamPieces beams, rayBeams;            ///< rayBeams: scratch
};

/// A Bounce holds the surfaces that the rays of a block met, and the sets of lanes by what they do.
struct Bounce
{
    int number = 0;
    SurfaceLanes surface;
    Vec3Lanes normal;          ///< shading normals on the side of the ray
    Vec3Lanes albedo;          ///< albedos of diffuse lanes
    LaneMask diffuse = 0;      ///< plain Lambert lanes
    LaneMask general = 0;      ///< all other lanes that scatter
    LaneMask smooth = 0;       ///< general lanes with mirror-like lobes only
    LaneMask transmissive = 0; ///< general lanes that transmit
    LaneMask gathering = 0;    ///< lanes that look up photons
    LaneMask rough = 0;        ///< gathering lanes that look up all photons
    LaneMask collided = 0;     ///< lanes that media have scattered on their way
    LaneMask behindPanes = 0;  ///< lanes whose rays have passed panes on their way
    LaneMask carried = 0;      ///< glossy lanes whose light from lights photons carry on
    LaneMask terminating = 0;  ///< gathering lanes that go on by mirror-like lobes only
    LaneMask subsurface = 0;   ///< general lanes whose light may enter the body: see PathSubsurface
    bool below = false;        ///< the lanes are where walks below surfaces leave
    Bsdf* bsdfs = nullptr;     ///< BSDFs of general lanes
};

/// Counts a ray of each of the lanes in the debug outputs, if the tile has them.
void countRays(Tile& tile, const PathBlock& block, LaneMask lanes);

/// What parts surfaces with diffuse boundaries, from before light is added until after.
struct SubsurfaceLanes
{
    LaneMask hidden = 0; ///< lanes that light samples and photons find nothing on
    SubsurfaceSplit split[kLanes];
    Vec3 sigma[kLanes]; ///< extinction below the surfaces [1/engine unit]
};

/// Leaves to the lanes of bounce.subsurface what their surfaces scatter by themselves.
void partSubsurface(const Tile& tile, const PathBlock& block, Bounce& bounce,
                    SubsurfaceLanes& lanes);

/// Takes paths, by chance, to where their light leaves the bodies of these surfaces. The lanes of
/// the bounce are then those of that place, and addLightAt has been called for them.
void walkBelowSurfaces(Tile& tile, PathBlock& block, Bounce& bounce, const SubsurfaceLanes& lanes,
                       PhotonUse use);

/// Adds what photons and light samples bring to the surfaces of a bounce, or keeps the surfaces for
/// later.
void addLightAt(Tile& tile, PathBlock& block, Bounce& bounce, PhotonUse use);

/// Sets u and v to the two Sobol numbers of a dimension for each lane.
void dimensionPoints(const UintLanes& seeds, uint32_t passIndex, uint32_t dimension, FloatLanes& u,
                     FloatLanes& v);

/// Adds the emission that the rays of this number met by chance, weighted against light samples.
/// The emission that photons carry is left out.
void addEmission(Tile& tile, const PathBlock& block, const SurfaceLanes& surface, int number,
                 PhotonUse use);

/// Adds the light of rays that left the scene in the bounce of this number. The eye and mirrors see
/// the environment or else the background. Scattered paths get the environment, weighted against
/// its samples and without the light that photons carry.
void addEnvironment(Tile& tile, const PathBlock& block, LaneMask missed, int number, PhotonUse use);

/// Adds the radiance that the visible lanes get from one light sample. The sample has its full
/// weight for lanes of withoutMis, which have no other chance to meet this light.
void addLight(Tile& tile, const PathBlock& block, const Bounce& bounce, const LightLanes& light,
              LaneMask visible, LaneMask withoutMis);

/// Sets the radiance that the lanes send back along their rays from light samples that nothing
/// hides; other lanes get 0. withoutMis: see addLight; diffuse lanes are all of this kind or none.
void scatteredLight(const PathBlock& block, const Bounce& bounce, const LightLanes& light,
                    LaneMask lanes, LaneMask withoutMis, Vec3Lanes& scattered);

/// Asks each of a few area lights for a sample in each of the lanes, and adds the light of one of
/// them: see PathCandidates.cpp.
void sampleFewLights(Tile& tile, PathBlock& block, const Bounce& bounce, LaneMask lanes);

/// Decides whether the pass has rays that ask for the sky.
void beginSkyRays(Tile& tile, PhotonUse use);

/// Sends further rays from the diffuse surfaces that camera rays met, and adds the sky's light.
void addSkyRays(Tile& tile, PathBlock& block, const Bounce& bounce);

/// Returns the share of the sky's light that the path adds itself at the end of the ray of this
/// number; the rays that asked for the sky have added the others.
float shareOfSky(const Tile& tile, PathFlags path, int number);

/// The environment's dimensions lie apart from those of all bounces, so that scenes without an
/// environment keep their sequences.
constexpr uint32_t kEnvironmentDimension = 0x10000u;

/// Adds samples of the environment and of the portals of the pass: see PathSkyPortals.cpp.
void samplePortals(Tile& tile, PathBlock& block, const Bounce& bounce, const UintLanes& seeds);

/// Sends the tile's beams through the portals of the pass, if it has any.
void beginSunSpots(Tile& tile);

/// Adds light of one of the tile's spots to each lane of a bounce, from the second surface on, and
/// from the first one through panes.
void sampleSunSpots(Tile& tile, PathBlock& block, const Bounce& bounce, const UintLanes& seeds);

/// Returns the lanes at the end of rays that samples of spots could have found as well.
LaneMask lanesOnSpots(const Tile& tile, const PathBlock& block, const Bounce& bounce);

/// Returns the share that light samples of such a lane add of light from wi. pdfSky, pdfPortal:
/// densities of these samples [1/sr].
float shareBesideSpots(const Tile& tile, const PathBlock& block, const Bounce& bounce, int i,
                       Vec3 wi, float pdfSky, float pdfPortal);

/// What a bounce tells the rays that leave it of panes that mirror the sky.
struct PaneMarks
{
    UintLanes sides = {};  ///< PathFlags::paneSides of the lanes that scatter
    LaneMask mirrored = 0; ///< lanes at panes whose mirrored sky has been sampled before
};

/// Adds samples of the sky that panes mirror to surfaces before them: see PathPaneMirrors.cpp.
void samplePaneMirrors(Tile& tile, PathBlock& block, const Bounce& bounce, const UintLanes& seeds);

/// Returns the marks of a bounce, from the rays that have come.
PaneMarks paneMarks(const Tile& tile, const PathBlock& block, const Bounce& bounce);

/// Sets them in the flags of the rays that leave.
void markPanes(const PaneMarks& marks, PathBlock& block);

/// Returns the density with which the light samples at a point would have found a direction of the
/// sky [1/sr]. from: begin of the ray that met the sky.
float skyPdfW(const Tile& tile, Vec3 from, Vec3 direction);

/// Adds samples of the environment if it shines. seeds are the seeds of light samples.
void sampleEnvironment(Tile& tile, PathBlock& block, const Bounce& bounce, const UintLanes& seeds);

/// Adds the samples of the LightTree, or else one of the samples of the area lights; the samples of
/// the environment; and one sample of each delta light of the pass that is not in the tree.
void sampleLights(Tile& tile, PathBlock& block, const Bounce& bounce);

/// Sets the ray of each lane that goes on, and removes the other lanes from block.active.
void scatter(Tile& tile, PathBlock& block, const Bounce& bounce);

/// Decides whether paths from glossy surfaces have companions.
void beginChains(Tile& tile, PhotonUse use);

/// Returns the lanes all of whose lobes are narrow, but not mirror-like, and reflect.
LaneMask glossyLanes(const Bounce& bounce);

/// Records the glossy surfaces that the camera rays of block b met, before the paths go on.
void recordGlossy(Tile& tile, int b, const Bounce& bounce);

/// Marks the paths that have met a glossy surface after another one, and counts them for their
/// pixels: what they find from here on is added to sums of their own.
void countChains(Tile& tile, PathBlock& block, const Bounce& bounce);

/// Sends more rays from the glossy surfaces of the pixels that countChains has counted.
void addCompanions(Tile& tile, PhotonUse use);

/// Traces rays from glossy surfaces that camera rays met, and drops those that meet no glossy
/// surface. The others go on as paths of their pixels.
void bounceCompanions(Tile& tile, PathBlock& block, PhotonUse use);

/// Adds the mean light of the paths that countChains has counted to their pixels.
void addChains(Tile& tile);

/// Sets the reuse groups of the tile. No path is reused with PhotonUse::Indirect or with photons of
/// the local schedule, which are counted pixel by pixel.
void beginReuse(Tile& tile, PhotonUse use);

/// Records the diffuse surfaces that the camera rays of block b met.
void recordFirstSurfaces(Tile& tile, int b, const Bounce& bounce);

/// Marks for reuse the paths whose second surface is diffuse: all pixels of the group that see this
/// surface get the light that the path finds from here on.
void reusePaths(Tile& tile, PathBlock& block, const Bounce& bounce);

/// Connects the pixels of a group to the second surfaces of its reused paths.
void connectPaths(Tile& tile);

/// Sets bounce.gathering, bounce.rough, bounce.terminating and bounce.carried: the lanes that look
/// up photons, those that go on by mirror-like lobes only, and those on which photons have the
/// light that comes straight from lights.
void chooseGathering(const PathBlock& block, Bounce& bounce, PhotonUse use);

/// Adds the radiance that the photons around the lanes' points send back along the lanes' rays.
void addPhotons(Tile& tile, const PathBlock& block, const Bounce& bounce);

/// The radiance by the photons that project into the pixels of some lanes.
struct FootprintSums
{
    LaneMask chosen = 0;   ///< lanes whose pixels take the photons of their footprint
    LaneMask compared = 0; ///< lanes whose pixels take those of a disc, and compare both
    Vec3Lanes radiance;    ///< of the lanes of both sets
};

/// Sums up the photons in the footprints of the first hits whose pixels take or compare them, as
/// earlier passes have chosen. discs: of any radius, at the lanes that gather.
void gatherFootprints(Tile& tile, const PathBlock& block, const Bounce& bounce,
                      const PhotonQueryLanes& discs, FootprintSums& sums);

/// Takes what discs have blurred out of the tile's sums again, if it is to be taken.
void takeBlur(Tile& tile);

/// Chooses for later passes which pixels of the queries' lanes compare their disc with their
/// footprint, and which take the photons of the footprint. discRadiance is that of the discs.
void chooseFootprints(Tile& tile, const PathBlock& block, const Bounce& bounce,
                      const PhotonQueryLanes& queries, const Vec3Lanes& discRadiance,
                      const FootprintSums& footprints);

/// Returns whether a surface is on a plane as photons have to be that a look-up with this radius
/// finds. distance: from the look-up's centre.
inline bool isOn(const Plane& plane, float radius, float distance, Vec3 point, Vec3 normal)
{
    const float height = std::fabs(heightAbove(plane, point));
    const float cosine = glm::dot(plane.normal, normal);
    if (!(height <= kPlaneShare * radius && cosine >= kLeastNormalCosine)) return false;
    const float gap = height - gapTolerance(point, radius);
    return gap <= 0.0f || gap * gap <= distance * distance * (1.0f - cosine * cosine);
}

/// The same for all places within the radius.
inline bool isOn(const Plane& plane, float radius, Vec3 point, Vec3 normal)
{
    return isOn(plane, radius, radius, point, normal);
}

/// Corrects the sums of discs at first hits that reach beyond the edge of their surface.
void correctEdges(Tile& tile, const PathBlock& block, const Bounce& bounce,
                  const PhotonQueryLanes& queries, PhotonSumLanes& sums);

/// Appends the lanes of a bounce to the tile's hit points, with all that addPhotons and
/// sampleLights read of a lane.
void keepHitPoints(const PathBlock& block, const Bounce& bounce, HitPoints& hits);

/// Adds photons and light samples at the kept hit points. Bounces add the same light themselves if
/// no hit points are kept.
void gatherAtHitPoints(Tile& tile, const HitPoints& hits);

} // namespace osgRayTrace::engine
