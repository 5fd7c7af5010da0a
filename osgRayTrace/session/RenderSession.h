// RenderSession.h - the progressive image of one view. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Status.h"
#include "osgRayTrace/film/ChangedTiles.h"
#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/integrators/RenderOptions.h"
#include "osgRayTrace/integrators/SampledLights.h"
#include "osgRayTrace/scene/View.h"
#include "osgRayTrace/session/DenoiseReport.h"
#include "osgRayTrace/session/ShownImage.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

struct SurfaceMap; // where the surfaces of a view's pixels are
class TracedScene; // accel: a Scene with its Embree structures
class Workers;     // base: the threads that a render may use

/// When RenderSession::render returns: whichever is reached first.
struct StopRule
{
    int passes =
        std::numeric_limits<int>::max(); ///< accumulated passes, those of earlier calls included
    int newPasses = std::numeric_limits<int>::max(); ///< of this call
    /// Tiles of this call, summed over its passes; the next render() does the rest of a pass. Tiles
    /// are then taken in an order that is even over the image.
    int newTiles = std::numeric_limits<int>::max();
    /// Of this call, looked at between passes: these are whole, and at least one is made. A limit
    /// that holds within passes is over.
    double seconds = std::numeric_limits<double>::infinity();
    double relativeError =
        0.0; ///< estimated, see RenderProgress; of the accumulated image; 0: not used
    /// If set: asked before each tile, by any thread, and before each pass but the first of the
    /// call. True: no more are begun; those that have the pass keep it, and the next render() does
    /// the rest, as after cancel(). Tiles are then taken in an order that is even over the image,
    /// so that any part of them tells what all of them cost. tiles: begun by this call; seconds:
    /// the least time until it is asked again, known of photons.
    std::function<bool(int tiles, double seconds)> over;
    /// With over: tiles along a side of the squares whose tiles follow each other, see TileOrder.
    /// These squares, and not tiles, are what is even over the image then.
    int groupedTiles = 1;
};

/// Where display values go while an image is made: see RenderSession::resolveDisplay. For an image
/// of the size of the session's view.
struct DisplayTarget
{
    ToneMap toneMap;
    uint8_t* rgba = nullptr;
    float* depth = nullptr; ///< may be null
    /// The image as it was before render() is there: only tiles that get a pass are written. Of an
    /// image without any pass that is whatever shall be seen where there is no tile yet.
    bool holdsImage = false;
    ChangedTiles* changed =
        nullptr; ///< gets a mark for each tile that is written; of that size; may be null
};

/// Why photons do not do what one may expect of them.
enum class PhotonNote : uint8_t
{
    None,
    NoPower,       ///< no light has any: none were emitted
    NoneStored,    ///< they were followed, but met no surface that scatters light
    RadiusLimited, ///< the radius that was set is below the spacing of floats, or larger than the
                   ///< scene
};

struct RayCounts
{
    uint64_t camera = 0;
    uint64_t shadow = 0;
    uint64_t secondary = 0; ///< mirror, glass and bounce rays
    uint64_t photon = 0;    ///< from the lights, of passes that this view looked up photons of
    uint64_t total() const { return camera + shadow + secondary + photon; }
};

/// Of the accumulated image.
struct RenderProgress
{
    Status status;
    IntegratorKind integrator = IntegratorKind::Automatic; ///< the one that was chosen
    int passes = 0;                                        ///< complete ones
    double seconds = 0.0;                                  ///< spent in passes since the restart
    /// Last estimate of sqrt(mean((x - r)^2 / (R^2 + 0.01))) over pixels and RGB, r the converged
    /// image and R its mean over the pixel's tile of 16 x 16: an error in terms of the brightness
    /// around. Infinite below 2 passes. Made after each pass if the rule or keepGoing asks for it.
    double relativeError = std::numeric_limits<double>::infinity();
    RayCounts rays;
    uint64_t droppedSamples = 0; ///< not finite, or above 1e30: left out of the image and counted
    double denoiseSeconds =
        0.0; ///< of the last image that was denoised, noted by who does it: see Denoiser
    DenoiseReport denoised;     ///< what it went through
    bool restarted = false;     ///< this call began a new image
    int newTiles = 0;           ///< of this call, summed over its passes
    double imageShare = 0.0;    ///< of the tiles: those that have a pass; 1 as soon as passes is
    SampledLightCounts lights;  ///< of its passes
    double photonSeconds = 0.0; ///< that photons took in this call, traced or waited for
    double firstPhotonSeconds = 0.0;          ///< of these, those of its first pass
    float photonRadius = 0.0f;                ///< of the last pass [length]; 0 without photons
    PhotonNote photonNote = PhotonNote::None; ///< of all passes together
    uint64_t storedPhotons = 0;               ///< in the map of the last pass
    uint64_t photonBytes = 0;                 ///< of the maps that are kept, for all views
    double reprojectedShare =
        0.0; ///< of the pixels: those that earlier views add to; by ViewTracer
    double reprojectSeconds = 0.0; ///< to carry those into this view
    uint64_t hitPointBytes =
        0; ///< that this view keeps for photons: hit points, radii, statistics of pixels
};

/// Channels of the first hit, or of the image's statistics, for resolveChannel.
enum class Channel : uint8_t
{
    Depth,    ///< 1 float: window depth in [0,1], 1 where nothing is hit
    Distance, ///< 1 float: along the ray from the eye's near plane or pole [length]; infinity: no
              ///< hit
    Normal,   ///< 3 floats: world space, unit, facing the viewer
    Albedo,   ///< 3 floats: linear
    Position, ///< 3 floats: world space (float)
    Id,       ///< 1 float: instance index + 1, 0 where nothing is hit
    Error,    ///< 3 floats: estimated standard error of the pixel's linear RGB
};

class PhotonPasses;

/// One for each view. Not thread safe but for cancel(); different sessions may render at once.
class RenderSession
{
public:
    /// photons: shared by the views of a scene, so that each pass of photons is traced once; null:
    /// its own.
    explicit RenderSession(std::shared_ptr<Workers> workers,
                           std::shared_ptr<PhotonPasses> photons = {});
    ~RenderSession();
    RenderSession(const RenderSession&) = delete;
    RenderSession& operator=(const RenderSession&) = delete;

    /// What to render. Cheap; whether this restarts the image or continues it is decided in
    /// render().
    void setScene(std::shared_ptr<const TracedScene> scene);
    void setView(const View& view);
    void setOptions(const RenderOptions& options);

    /// Whether the images that are begun from now on keep what their first samples meet:
    /// surfaces().
    void setKeepsSurfaces(bool keeps);

    /// Which of many independent sequences of random numbers the next image that is begun takes:
    /// those that are averaged need different ones. 0: that of the options' seed. Photons are the
    /// same for all.
    void setSequence(uint32_t sequence);

    /// Adds passes to the image until the rule says stop, cancel() is called or keepGoing, called
    /// after each pass on this thread, returns false. The tiles of a pass that cancel() cut short
    /// keep it, and the next render() does the rest of them. Never throws: failures are in the
    /// status, the last image stays. With a display target the image is there at the end as
    /// resolveDisplay would write it, for less: each tile's part is written while the tile is still
    /// in the cache. Nothing is written if no pass is made.
    RenderProgress render(const StopRule& rule,
                          const std::function<bool(const RenderProgress&)>& keepGoing = {},
                          const DisplayTarget* display = nullptr);

    /// Stops a running render() within a tile. Any thread.
    void cancel();

    /// RenderProgress::relativeError of the image as it is, worked out now.
    double estimateRelativeError() const;

    /// Lets go of the scene and of the image; memory for images is kept.
    void clear();

    /// Without the pass at work; all, if none is.
    int tilesLeft() const;

    /// State after the last render(). Width and height are those of the image, which may be older
    /// than setView's.
    const RenderProgress& progress() const;
    int width() const;
    int height() const;

    /// Linear RGBA radiance, premultiplied, row 0 at the bottom: width*height*4 floats.
    std::vector<float> resolveRadiance() const;

    /// The same to memory of the caller, with window depths if depth is not null. As soon as some
    /// rows are there, take(first row, row past the last) is called for them, by any thread.
    void resolveRows(float* radiance, float* depth,
                     const std::function<void(std::size_t, std::size_t)>& take) const;

    /// Display values, row 0 at the bottom: width*height*4 bytes to rgba and, if not null,
    /// width*height window depths to depth. Runs on the session's threads.
    void resolveDisplay(const ToneMap& toneMap, uint8_t* rgba, float* depth) const;

    /// The same, but tiles without a pass are left as they are.
    void resolveOver(const ToneMap& toneMap, uint8_t* rgba, float* depth) const;

    /// Channel values, row 0 at the bottom, width*height*channelSize(channel) floats.
    std::vector<float> resolveChannel(Channel channel) const;

    /// The image with what more than a tone map needs. Empty without an image.
    ShownImage shownImage() const;

    /// What is seen through the middle of each pixel, row 0 at the bottom. The first time it is
    /// asked for it traces a ray for each; it is kept as long as the image. Empty without an image.
    const std::vector<SurfaceSample>& surfaceSamples() const;

    /// What the pixels of the image show, and of the last image before it that was asked for them:
    /// taken from the samples of the first pass, and where these tell of an edge from rays through
    /// the middles of pixels. Of a view of no size where that was not kept.
    const SurfaceMap& surfaces();
    const SurfaceMap& lastSurfaces() const;

    /// The same view of another size, mostly a larger one, from an image and samples of this one's,
    /// filtered or not: see Upsample.h. Vectors of result that have its size already are used
    /// again. Empty without an image.
    UpsampleCounts upsample(const ShownImage& image, const std::vector<SurfaceSample>& samples,
                            int width, int height, ShownImage& result,
                            double mostTraced = 1.0) const;

    /// The same as display values and window depths, for less; a target of that size. Nothing is
    /// written without an image.
    UpsampleCounts showUpsampled(const ShownImage& image, const std::vector<SurfaceSample>& samples,
                                 int width, int height, const DisplayTarget& display,
                                 double mostTraced = 1.0) const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> _implementation;
};

int channelSize(Channel channel);

} // namespace osgRayTrace::engine
