// RenderSession.h - the progressive image of one view. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Status.h"
#include "osgRayTrace/film/ChangedTiles.h"
#include "osgRayTrace/film/PassSums.h"
#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/integrators/shared/RenderOptions.h"
#include "osgRayTrace/integrators/shared/SampledLights.h"
#include "osgRayTrace/scene/Light.h"
#include "osgRayTrace/scene/View.h"
#include "osgRayTrace/session/DisplayTarget.h"
#include "osgRayTrace/session/RenderProgress.h"
#include "osgRayTrace/session/image/Channel.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace osgRayTrace::engine
{

struct SurfaceMap; // where the surfaces of a view's pixels are
class TracedScene; // accel: a Scene with its Embree structures
class Workers;     // base: the threads that a render may use

class PhotonPasses;
class TileHelp;      // those who trace tiles elsewhere
struct TileSamples;  // samples of single pixels
struct SessionState; // the image, and what it is of

/// The progressive image of one view. A session is not thread safe but for cancel(); different
/// sessions may render at once.
class RenderSession
{
public:
    /// Makes a session without an image. The views of a scene share photons, so that each pass of
    /// photons is traced once; if photons is null, the session has its own.
    explicit RenderSession(std::shared_ptr<Workers> workers,
                           std::shared_ptr<PhotonPasses> photons = {});
    ~RenderSession();
    RenderSession(const RenderSession&) = delete;
    RenderSession& operator=(const RenderSession&) = delete;

    /// These functions set what to render, and are cheap: render() decides whether the image
    /// restarts or continues.
    void setScene(std::shared_ptr<const TracedScene> scene);
    void setView(const View& view);
    void setOptions(const RenderOptions& options);

    /// Sets who traces tiles of the passes that are added from now on, beside this session's
    /// threads; null: nobody does. Images are the same bit by bit.
    void setHelp(std::shared_ptr<TileHelp> help);

    /// Sets whether the images that are begun from now on keep what their first samples meet:
    /// surfaces().
    void setKeepsSurfaces(bool keeps);

    /// Sets whether the next image that is begun, if it is of the same view, keeps the window
    /// depths and the surfaces of the image before it in tiles that have no pass yet.
    void setContinuesView(bool continues);

    /// Sets which of many independent sequences of random numbers the next image that is begun
    /// takes: images that are averaged need different sequences. Sequence 0 is that of the options'
    /// seed. Photons are the same for all sequences.
    void setSequence(uint32_t sequence);

    /// Sets whether all passes of the images that are begun from now on look through the middles of
    /// the pixels, where first hits are sampled, and not through other points: see Upsample.h.
    void setCentred(bool centred);

    /// Sets how the images that are begun from now on add up their passes.
    void setSums(FilmSums kind);

    /// Sets the first pass that images have: what others begin with is left to other sessions.
    /// Passes that later ones depend on, those of photons, are traced all the same.
    void setFirstPass(int pass);

    /// Begins the next image with passes that were made elsewhere, for the same scene, view and
    /// options; render() adds those that are missing. Needs exact sums.
    void resume(PassSums sums);

    /// Returns the sums of the image, which are exact; nothing if tiles have different passes, or
    /// if there is no image.
    std::optional<PassSums> passSums() const;

    /// Returns the passes that all tiles of the image have.
    const PassSet& passes() const;

    /// Adds passes to the image until the rule says stop, cancel() is called or keepGoing, called
    /// after each pass on this thread, returns false. The tiles of a pass that cancel() cut short
    /// keep the pass, and the next render() does the rest of the tiles. Never throws: failures are
    /// in the status, and the last image stays. A display target gets the image as resolveDisplay
    /// would write it, for less: each tile's part is written while the tile is still in the cache.
    /// Nothing is written if no pass is made.
    RenderProgress render(const StopRule& rule,
                          const std::function<bool(const RenderProgress&)>& keepGoing = {},
                          const DisplayTarget* display = nullptr);

    /// Stops a running render() within a tile. Any thread may call it.
    void cancel();

    /// Returns the error of the image as it is, worked out now.
    ErrorEstimate estimateError() const;

    /// Returns the exposure that the mean of the image asks for [EV]; see meteredEv.
    std::optional<float> meteredEv(int mostTiles) const;

    /// Lets go of the scene and of the image; memory for images is kept.
    void clear();

    /// Returns the number of tiles without the pass at work, or of all tiles if no pass is at work.
    int tilesLeft() const;

    /// Returns the passes of a tile: one more than progress().passes if it has the pass at work.
    int tilePasses(int tile) const;

    /// Returns the scene that the image is of, and its lights as placed for the image's view. There
    /// is an image.
    const TracedScene& imageScene() const;
    const std::vector<Light>& imageLights() const;

    /// These functions return the state after the last render(). Width and height are those of the
    /// image, which may be older than setView's.
    const RenderProgress& progress() const;
    int width() const;
    int height() const;

    /// Returns linear RGBA radiance, premultiplied, row 0 at the bottom: width*height*4 floats.
    std::vector<float> resolveRadiance() const;

    /// Writes linear RGBA radiance to memory of the caller, with window depths if depth is not
    /// null. As soon as some rows are there, any thread calls take(first row, row past the last)
    /// for these rows.
    void resolveRows(float* radiance, float* depth,
                     const std::function<void(std::size_t, std::size_t)>& take) const;

    /// Writes display values, row 0 at the bottom: width*height*4 bytes to rgba and, if depth is
    /// not null, width*height window depths to depth. Runs on the session's threads.
    void resolveDisplay(const ToneMap& toneMap, uint8_t* rgba, float* depth) const;

    /// Writes what resolveDisplay writes, but leaves tiles without a pass as they are.
    void resolveOver(const ToneMap& toneMap, uint8_t* rgba, float* depth) const;

    /// Returns channel values, row 0 at the bottom, width*height*channelSize(channel) floats.
    std::vector<float> resolveChannel(Channel channel) const;

    /// Returns the image with what more than a tone map needs, or an empty one without an image.
    ResolvedImage resolvedImage() const;

    /// Returns what is seen through the middle of each pixel, row 0 at the bottom. The first call
    /// for an image traces a ray for each pixel; the samples are kept as long as the image. Empty
    /// without an image.
    const std::vector<SurfaceSample>& surfaceSamples() const;

    /// These functions return what the pixels of the image show, and those of the last image before
    /// it for which surfaces() was called. The surfaces are taken from the samples of the first
    /// pass and, if these tell of an edge, from rays through the middles of pixels. The map is of a
    /// view of no size if the samples were not kept.
    const SurfaceMap& surfaces();
    const SurfaceMap& lastSurfaces() const;

    /// Returns what the first samples of the pixels met, without smooth and interior pixels. If the
    /// image was begun without keeping it, rays through the middles of the pixels find it now.
    const SurfaceMap& firstSurfaces();

    /// Replaces these surfaces, in blocks of 4 x 4 pixels, by those that rays through the middles
    /// of the pixels meet. blocks: lower left pixels, each once. firstSurfaces() has been called.
    void findMiddles(const std::vector<std::pair<int, int>>& blocks);

    /// Makes samples of single pixels of the image that are independent of those of the film, which
    /// stays as it is. The pixels have one each before any has two. It ends early if shouldStop,
    /// which any thread calls before each tile, returns true. There is an image, by an integrator
    /// without photons.
    void samplePixels(std::vector<TileSamples>& tiles, const std::function<bool()>& shouldStop);

    /// Makes the same view of another size, mostly a larger one, from an image and samples of this
    /// one's, filtered or not: see Upsample.h. Vectors of result that have the size already are
    /// used again. The result is empty without an image.
    UpsampleCounts upsample(const ResolvedImage& image, const std::vector<SurfaceSample>& samples,
                            int width, int height, ResolvedImage& result,
                            double mostTraced = 1.0) const;

    /// Writes the upsampled image as display values and window depths, for less than upsample(), to
    /// a target of that size. Nothing is written without an image.
    UpsampleCounts presentUpsampled(const ResolvedImage& image,
                                    const std::vector<SurfaceSample>& samples, int width,
                                    int height, const DisplayTarget& display,
                                    double mostTraced = 1.0) const;

private:
    std::unique_ptr<SessionState> _state;
};

} // namespace osgRayTrace::engine
