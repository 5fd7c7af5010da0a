// ViewHistory.h - the samples of earlier views that go on counting in a session's image. Layer:
// session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/session/history/MovedSamples.h"
#include "osgRayTrace/session/history/Reprojection.h"
#include "osgRayTrace/session/history/SceneChange.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

#include <functional>

namespace osgRayTrace::engine
{

class RenderSession;
struct Scene;

/// Tells how a scene's look depends on the view beyond the lobes of its surfaces.
struct ViewDependence
{
    bool everywhere = false; ///< lights are fixed to the eye, or textures are placed by the eye
    bool axes = false;       ///< highlights look along the view's axis, wherever the eye is
};
ViewDependence viewDependence(const Scene& scene);

/// Holds the part of a view's image that comes from earlier views, or from earlier versions of the
/// scene, beside the session's film, which begins anew with each of them. The displayed image is
///
///   (h history + n film) / (h + n),   h = max(0, count - max(0, n - 1) / 2),
///
/// Here n is the number of the film's passes and count the number of the history's samples of the
/// pixel. While the view moves, the image is therefore the mean of all samples. At rest each
/// further pass takes the weight of half a sample from the history. From pass 2 m + 1 on, where m
/// is the largest count, and earlier if the history holds less, the image is the film's own.
///
/// A history belongs to one set of options, and sessions that keep the surfaces of their samples.
/// Whoever renders calls leave and enter only if nothing but the view or its size changes, keep if
/// nothing but the scene does, and drop if anything else does. A history is not thread safe; each
/// session has its own, in ImageStages, which assert that one thread at a time is inside.
class ViewHistory
{
public:
    static constexpr float kMostCount = 32.0f; ///< samples a pixel of an earlier view
    static constexpr float kMostKept = 64.0f;  ///< samples a pixel of an earlier scene

    /// Takes the samples of the session's image, which is of this view, before the image is begun
    /// anew for another view.
    void leave(RenderSession& session, const View& view, const Workers& workers);

    /// Returns whether the samples that leave took wait for enter.
    bool leaving() const { return _taken; }

    /// Carries the samples that leave took into the other view, after its first pass. If enter is
    /// called before any pass, the view was not left.
    void enter(RenderSession& session, const View& view, const ViewDependence& dependence,
               const Workers& workers);

    /// Takes the samples of the session's image, before the image is begun anew for the same view
    /// of a scene that differs by the change, as far as they may be kept: see KeptSamples.h.
    /// most: largest count. Returns false, and drops all, if few pixels keep any.
    bool keep(RenderSession& session, const SceneChange& change, float most,
              const Workers& workers);

    /// Gives the pixels of objects that have moved what the objects had accumulated, after the
    /// first pass or part of a pass that follows keep: see MovedSamples.
    void followMoved(RenderSession& session, const Workers& workers);

    /// Traces more samples for the pixels that have few, after followMoved: see FreshSamples.h.
    void refresh(RenderSession& session, const std::function<bool()>& shouldStop,
                 const Workers& workers);

    /// Returns whether the history is of an earlier version of the scene.
    bool isKept() const { return _isKept; }

    /// Returns a mark for each tile of the session's image that has pixels without kept samples.
    const std::vector<uint8_t>& lackingTiles() const { return _lacking; }

    /// Returns how many pixels keep no samples, those of objects that have moved among them.
    std::size_t lackingPixels() const { return _lackingPixels; }

    /// Returns whether kept samples and the passes of tiles together make a whole image.
    bool isWhole(const RenderSession& session) const;

    void drop();

    /// Returns whether the history adds to an image of so many passes.
    bool counts(int passes) const
    {
        return _share > 0.0 && static_cast<float>(passes - 1) < 2.0f * _most;
    }

    /// Adds the history to the image of the session's film, and sets its errors to those of all
    /// samples together; kept samples, which may be stale, leave the errors of the film. Below two
    /// passes the error is estimated by how film and history differ. Pixels without history then
    /// have no known error, and it is set as large as the radiance; in tiles without a pass the
    /// deviation of a sample is taken to be as large as the radiance.
    void blend(const RenderSession& session, ResolvedImage& image, const Workers& workers) const;

    /// Writes the session's image with the history as display values and window depths. This costs
    /// less than blend and presentImage, and half of the next leave's work is then done.
    void show(const RenderSession& session, const ToneMap& toneMap, uint8_t* rgba, float* depth);

    double share() const { return _share; }     ///< share of pixels with history
    double seconds() const { return _seconds; } ///< time that the last leave and enter took [s]

private:
    void blendRows(const RenderSession& session, const ToneMap* toneMap, uint8_t* rgba,
                   float* depth);
    void takeSamples(const RenderSession& session, const Workers& workers);
    std::size_t findLacking(const RenderSession& session, const Workers& workers);

    SampledImage _history; ///< history of the present view
    SampledImage _left;    ///< samples that leave took
    MovedSamples _moved;   ///< between keep and followMoved
    View _leftView;
    /// Mean of film and history for so many passes of the film's tiles; 0 passes: not known.
    std::vector<float> _blended;
    int64_t _blendedPasses = 0;     ///< summed over the tiles
    bool _taken = false;            ///< true between leave and enter
    bool _isKept = false;           ///< whether the history is of an earlier version of the scene
    float _most = kMostCount;       ///< largest count
    std::vector<uint8_t> _lacking;  ///< 1: the tile has pixels without kept samples
    std::size_t _lackingPixels = 0; ///< pixels without kept samples
    double _share = 0.0;
    double _seconds = 0.0;
};

} // namespace osgRayTrace::engine
