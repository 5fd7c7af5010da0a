// RenderSession.h - the progressive image of one view. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Status.h"
#include "osgRayTrace/film/ChangedTiles.h"
#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/integrators/shared/RenderOptions.h"
#include "osgRayTrace/integrators/shared/SampledLights.h"
#include "osgRayTrace/scene/View.h"
#include "osgRayTrace/session/DisplayTarget.h"
#include "osgRayTrace/session/RenderProgress.h"
#include "osgRayTrace/session/image/Channel.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

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

class PhotonPasses;
struct SessionState; // the image, and what it is of

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
    ResolvedImage resolvedImage() const;

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
    UpsampleCounts upsample(const ResolvedImage& image, const std::vector<SurfaceSample>& samples,
                            int width, int height, ResolvedImage& result,
                            double mostTraced = 1.0) const;

    /// The same as display values and window depths, for less; a target of that size. Nothing is
    /// written without an image.
    UpsampleCounts presentUpsampled(const ResolvedImage& image,
                                    const std::vector<SurfaceSample>& samples, int width,
                                    int height, const DisplayTarget& display,
                                    double mostTraced = 1.0) const;

private:
    std::unique_ptr<SessionState> _state;
};

} // namespace osgRayTrace::engine
