// TileResult.h - the result of a pass for a tile. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/KernelBias.h"
#include "osgRayTrace/integrators/shared/PixelProjection.h"
#include "osgRayTrace/photons/TracedPhotons.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// The counts of one tile and pass.
struct TileCounts
{
    uint64_t cameraRays = 0;
    uint64_t shadowRays = 0;
    uint64_t secondaryRays = 0;
    uint64_t droppedSamples = 0;
    uint64_t collisions = 0; ///< with media
    uint64_t cutWalks = 0;   ///< paths that ended within a medium: see kMostCollisions
    uint64_t openWalks = 0;  ///< walks below surfaces that have left their mesh through a hole
};

/// The values that the debug channels show, by pixel of the tile: block * kLanes + lane.
struct DebugOutputs
{
    float rays[kTilePixels] = {};
    float dropped[kTilePixels] = {};
};

/// The radiance that a photon guided to a bin of PhotonGuide added to a pixel.
struct SeenPhoton
{
    uint32_t bin = kInvalid;
    float radiance = 0.0f; ///< luminance of that radiance
};

/// The photons that the first hits of a pixel take.
enum class PixelLookup : uint8_t
{
    Undecided, ///< those in a disc, which has been too large for the pixel so far
    Disc,      ///< those in a disc: the pixel sees more than a plane
    Compared,  ///< those in a disc, which is compared with the pixel's footprint
    Footprint, ///< those that project into the pixel: the disc has been seen to blur the image
};

/// Whether the discs of a pixel's first hits reach beyond an edge: see PathDiscEdges.cpp.
enum class DiscEdge : uint8_t
{
    Unknown, ///< no photons have been found yet
    None,
    Straight, ///< the surface ends at one line
    Near,
};

/// Light is taken to be smooth in a disc as long as the sum of its differences to the footprint is
/// at most so many of its standard errors.
constexpr float kSmoothSignificance = 1.5f;

/// What a pixel sees and how it takes photons there, as earlier passes have chosen: see
/// PathFootprints.cpp.
struct SeenPlane
{
    /// That of the first hit with photons. In pixels that are compared, or take the photons of
    /// their footprint, it is the plane for that.
    Plane plane;
    Plane line; ///< where the plane ends if edge is Straight: the part above it is empty
    PixelLookup lookup = PixelLookup::Undecided;
    DiscEdge edge = DiscEdge::Unknown;
    // Passes of those that may choose: before the pixel compared, and those that it compared.
    uint8_t undecided = 0, compared = 0;
    /// Area of the disc over that of the footprint, both as in the first pass; 0: not known yet.
    float discPixels = 0.0f;
    // Sums over the passes that were compared, of the luminance by the disc less that by the
    // footprint, and of its square.
    float difference = 0.0f, squares = 0.0f;

    /// Whether the disc is compared, ends at no edge, and has not been seen to blur.
    bool isSmooth() const
    {
        return lookup == PixelLookup::Compared && edge <= DiscEdge::None &&
               difference * difference <= kSmoothSignificance * kSmoothSignificance * squares;
    }
};

/// The photon look-ups of each pixel's camera path.
struct GatheredPhotons
{
    /// The radius [length]. On input it is that for this pass, or 0 if none is known yet; on output
    /// it is the one that was chosen.
    float radius[kTilePixels] = {};

    /// The planes of the tile's kTilePixels pixels; null: all look-ups are discs.
    SeenPlane* planes = nullptr;
    bool choosesPlanes = false; ///< whether this pass may change the planes

    /// Square of the radii of this pass over those of the first pass, and the same where light is
    /// smooth: such discs shrink late.
    float shrink2 = 1.0f, smoothShrink2 = 1.0f;
    float shrink2Of(const SeenPlane& pixel) const
    {
        return pixel.isSmooth() ? smoothShrink2 : shrink2;
    }

    /// Pixels that still compare take their footprint in this pass if their disc is smaller than so
    /// many footprints: such small discs spare little noise or none.
    float smallDisc = 0.0f;

    bool isSmall(const SeenPlane& pixel) const
    {
        return pixel.lookup == PixelLookup::Compared && pixel.discPixels > 0.0f &&
               pixel.discPixels * shrink2Of(pixel) < smallDisc;
    }

    // If separate is set (for the local radius schedule), the photons that were found come out in
    // count and flux, and are not part of the image.
    bool separate = false;
    uint32_t count[kTilePixels] = {};
    Vec3 flux[kTilePixels] = {}; ///< flux times the path's throughput [W/sr]

    /// The radiance that photons have added at the pixels' first hits, whatever they looked up. It
    /// is recorded if wantsFirstHits is set.
    bool wantsFirstHits = false;
    Vec3 atFirstHits[kTilePixels] = {};

    /// If balances is set, pixels that compare their disc with their footprint do so in this pass,
    /// too, and leaked is the radiance by their discs less that by their footprints, summed over
    /// them.
    bool balances = false;
    Vec3 leaked{0.0f};

    /// If wantsBlur is set, discs that no footprint is compared with are compared with discs of
    /// half their radius: blurred is the radiance by the former, summed over the tile, and blur an
    /// estimate of what the light's curvature adds to that. If takesBlur is set, the pixels lose
    /// this pass's share of blur in blurred, and earlierBlur besides, of their light by such discs.
    bool wantsBlur = false, takesBlur = false;
    Vec3 earlierBlur{0.0f};
    Vec3 blur{0.0f}, blurred{0.0f};

    /// The luminance that photons have added to the pixels of the tile, summed up.
    float carried = 0.0f;

    /// The block of the tile whose pixels compare discs of several radii (see DiscDifferences), and
    /// the differences of its lanes. -1: no block does.
    int comparedBlock = -1;
    Vec3 differences[kComparedDiscs][kLanes] = {};

    /// The photons that were found by the pixels whose number plus seenFirst is a multiple of
    /// seenStride. If seenStride is 0, no photons are wanted.
    std::vector<SeenPhoton> seen;
    uint32_t seenFirst = 0, seenStride = 0;

    /// The points at which the pixels whose number is a multiple of pointStride looked up photons.
    /// If pointStride is 0, none are wanted.
    std::vector<SeenPoint> points;
    uint32_t pointStride = 0;
};

struct HitPoints;
struct SurfaceSample;

/// The surfaces that the camera rays of a block met first. Normals and objects are 0 in lanes that
/// met nothing.
struct SurfaceBlock
{
    Vec3Lanes normal; ///< unit shading normals, towards the viewer
    FloatLanes
        along; ///< s of CameraRays at the surface's plane in the pixel's middle; infinity: nothing
    FloatLanes lobe;  ///< width of the narrowest lobe [radians]; see SurfaceSample
    UintLanes object; ///< instance + 1
};

/// The records of the first hits of the camera rays of a pass. They are written if
/// PassContext::wantsDepth.
struct FirstHitOutputs
{
    float depth[kTilePixels];         ///< window depth at pixel centres
    SurfaceBlock* surfaces = nullptr; ///< kTileBlocks surfaces; null: not wanted
    SurfaceSample* samples = nullptr; ///< kTilePixels samples; null: not wanted
};

/// The data that look-ups of photons read and write. They are needed if PassContext::photonUse is
/// not None.
struct PhotonOutputs
{
    GatheredPhotons* gathered = nullptr;
    /// The hit points of passes that share camera paths. The paths are followed anew if pathKey is
    /// another. Null: no passes share paths.
    HitPoints* hitPoints = nullptr;
};

struct TileResult
{
    RgbaLanes* rgba = nullptr; ///< kTileBlocks of radiance and coverage, one sample a pixel; finite
    TileCounts counts;
    FirstHitOutputs firstHits;
    PhotonOutputs photons;
    DebugOutputs* debug = nullptr; ///< null: not wanted
    /// The pixels that are wanted, as lanes of the tile's kTileBlocks blocks; null: all. The others
    /// may be left out, and what rgba has of them means nothing. Passes that record first hits or
    /// look up photons trace all pixels.
    const LaneMask* wanted = nullptr;
};

} // namespace osgRayTrace::engine
