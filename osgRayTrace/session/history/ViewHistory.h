// ViewHistory.h - the samples of earlier views that go on counting in a session's image. Layer:
// session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/session/history/Reprojection.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

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

/// Holds the part of a view's image that comes from earlier views, beside the session's film, which
/// begins anew with each view. The displayed image is
///
///   (h history + n film) / (h + n),   h = max(0, count - (n - 1) / 2),
///
/// Here n is the number of the film's passes and count the number of the history's samples of the
/// pixel. While the view moves, the image is therefore the mean of all samples. At rest each
/// further pass takes the weight of half a sample from the history. From pass 2 kMostCount + 1 on,
/// and earlier if the history holds less, the image is the film's own.
///
/// A history belongs to one scene, one set of options, and sessions that keep the surfaces of their
/// samples. Whoever renders calls leave and enter only if nothing but the view or its size changes,
/// and drop if anything else does. A history is not thread safe; each session has its own.
class ViewHistory
{
public:
    static constexpr float kMostCount = 32.0f; ///< samples a pixel

    /// Takes the samples of the session's image, which is of this view, before the image is begun
    /// anew for another view.
    void leave(RenderSession& session, const View& view, const Workers& workers);

    /// Returns whether the samples that leave took wait for enter.
    bool leaving() const { return _taken; }

    /// Carries the samples that leave took into the other view, after its first pass. If enter is
    /// called before any pass, the view was not left.
    void enter(RenderSession& session, const View& view, const ViewDependence& dependence,
               const Workers& workers);

    void drop();

    /// Returns whether the history adds to an image of so many passes.
    bool counts(int passes) const
    {
        return _share > 0.0 && static_cast<float>(passes - 1) < 2.0f * kMostCount;
    }

    /// Adds the history to the image of the session's film, which has so many passes, and sets its
    /// errors to those of all samples together. Below two passes the error is estimated by how film
    /// and history differ. Pixels without history then have no known error, and it is set as large
    /// as the radiance.
    void blend(ResolvedImage& image, int passes, const Workers& workers) const;

    /// Writes the session's image with the history as display values and window depths. This costs
    /// less than blend and presentImage, and half of the next leave's work is then done.
    void show(const RenderSession& session, const ToneMap& toneMap, uint8_t* rgba, float* depth);

    double share() const { return _share; }     ///< share of pixels with history
    double seconds() const { return _seconds; } ///< time that the last leave and enter took [s]

private:
    void blendRows(const RenderSession& session, const ToneMap* toneMap, uint8_t* rgba,
                   float* depth);

    SampledImage _history; ///< history of the present view
    SampledImage _left;    ///< samples that leave took
    View _leftView;
    /// Mean of film and history for so many passes of the film; 0 passes: not known.
    std::vector<float> _blended;
    int _blendedPasses = 0;
    bool _taken = false; ///< true between leave and enter
    double _share = 0.0;
    double _seconds = 0.0;
};

} // namespace osgRayTrace::engine
