// Integrator.h - the seam between a session and the algorithms that make pictures. Layer:
// integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/integrators/RenderOptions.h"
#include "osgRayTrace/photons/PhotonTracer.h"
#include "osgRayTrace/sampling/Sampler.h"
#include "osgRayTrace/scene/View.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

/// What a pass over the image of one view works with. Shared by all threads, not changed by them.
struct PassContext
{
    const TracedScene* traced = nullptr;
    const std::vector<Light>* lights = nullptr; ///< the scene's, eye-space ones placed for the view
    CameraRays camera;
    int width = 0, height = 0;            ///< of the image [pixels]
    Vec3 towardsViewer{0.0f, 0.0f, 1.0f}; ///< the view's +z axis, unit, engine space
    Mat3 eyeFromEngine{1.0f};             ///< rotation into the view's axes
    RenderOptions options;                ///< integrator is the chosen one, never Automatic
    PassKey key;
    PassKey pathKey;             ///< of camera paths; for PPM that of sharedPaths()
    bool wantsDepth = true;      ///< of the first pass
    bool throughCentres = false; ///< camera rays are those of firstHits

    PhotonUse photonUse = PhotonUse::None;
    /// The environment's, if options.environmentSampling is Structured; null: none.
    const std::vector<EnvironmentStratum>* strata = nullptr;

    const PhotonMap* photons = nullptr; ///< of the pass; if photonUse
    float leastPhotonRadius = 0.0f;     ///< range of the radii of lookups in this pass [length]
    float largestPhotonRadius = 0.0f;
};

/// For one tile and pass.
struct TileCounts
{
    uint64_t cameraRays = 0;
    uint64_t shadowRays = 0;
    uint64_t secondaryRays = 0;
    uint64_t droppedSamples = 0;
};

/// By pixel of the tile, for the debug channels: index is block * kLanes + lane.
struct TileDiagnostics
{
    float rays[kTilePixels] = {};
    float dropped[kTilePixels] = {};
};

/// What a photon that was aimed at a bin of PhotonAim added to the radiance of a pixel.
struct SeenPhoton
{
    uint32_t bin = kInvalid;
    float radiance = 0.0f; ///< its luminance
};

/// Photon lookups of each pixel's camera path.
struct GatheredPhotons
{
    /// [length] In: radius for this pass, 0 if it is not known yet; then out: the one that was
    /// chosen.
    float radius[kTilePixels] = {};

    // For the local radius schedule, out: what was found, which is then not part of the image.
    bool separate = false;
    uint32_t count[kTilePixels] = {};
    Vec3 flux[kTilePixels] = {}; ///< times the path's throughput [W/sr]

    /// Photons of the pixels that, and seenFirst, are a multiple of seenStride; 0: they are not
    /// wanted.
    std::vector<SeenPhoton> seen;
    uint32_t seenFirst = 0, seenStride = 0;
};

struct HitPoints;
struct SurfaceSample;

/// What the camera rays of a block met first. Where that is nothing, normals and objects are 0.
struct SurfaceBlock
{
    Vec3Lanes normal; ///< shading, unit, towards the viewer
    FloatLanes
        along;       ///< s of CameraRays where the pixel's middle sees its plane; infinity: nothing
    FloatLanes lobe; ///< width of its narrowest lobe [radians]; see SurfaceSample
    UintLanes object; ///< instance + 1
};

struct TileResult
{
    RgbaLanes* rgba = nullptr; ///< kTileBlocks of radiance and coverage, one sample a pixel; finite
    float depth[kTilePixels];  ///< window depth at pixel centres; if wanted
    SurfaceBlock* surfaces = nullptr; ///< kTileBlocks, written with depth; null: nobody wants them
    SurfaceSample* samples = nullptr; ///< kTilePixels, written with depth; null: nobody wants them
    TileCounts counts;
    TileDiagnostics* diagnostics = nullptr; ///< null: nobody wants them
    GatheredPhotons* gathered = nullptr;    ///< needed if photonUse
    HitPoints* hitPoints =
        nullptr; ///< of passes that share camera paths: followed if pathKey is another
};

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

/// kind is not Automatic.
std::unique_ptr<Integrator> newIntegrator(IntegratorKind kind);

/// Photons that the integrator looks up.
PhotonUse photonUse(IntegratorKind kind);

/// Replaces Automatic by the cheapest integrator that is right for the scene: Whitted for scenes of
/// fixed-function materials, path tracing as soon as a material is physical, with photons for the
/// caustics if something is mirror-like or transmits.
IntegratorKind chooseIntegrator(IntegratorKind wanted, const SceneTraits& traits);

} // namespace osgRayTrace::engine
