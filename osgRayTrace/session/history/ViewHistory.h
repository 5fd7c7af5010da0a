// ViewHistory.h - what earlier views of a session's image leave to the present one. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/session/history/Reprojection.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

namespace osgRayTrace::engine
{

class RenderSession;
struct Scene;

/// What of a scene's look depends on the view, more than by the lobes of its surfaces.
struct ViewDependence
{
    bool everywhere = false; ///< lights are fixed to the eye, or textures are placed by it
    bool axes = false;       ///< highlights look along the view's axis, wherever its eye is
};
ViewDependence viewDependence(const Scene& scene);

/// The part of a view's image that is not of this view alone: beside the session's film, which
/// begins anew with each view. Shown is
///
///   (h history + n film) / (h + n),   h = max(0, count - (n - 1) / 2),
///
/// n the film's passes, count the history's samples of the pixel. So while the view moves it is the
/// mean of all samples, and at rest each further pass takes the weight of half a sample from the
/// history: from pass 2 kMostCount + 1 on, and earlier where it holds less, the image is the film's
/// own.
///
/// A history is of one scene and one set of options, and of sessions that keep what their samples
/// meet: who renders calls leave and enter only where nothing but the view changes, or its size,
/// and drop where anything else does. Not thread safe; one for each session.
class ViewHistory
{
public:
    static constexpr float kMostCount = 32.0f; ///< samples a pixel

    /// Before the session's image, of this view, is begun anew for another view: takes what is in
    /// it.
    void leave(RenderSession& session, const View& view, const Workers& workers);

    /// True if what leave took waits for enter.
    bool leaving() const { return _taken; }

    /// After the first pass of the other view: carries what leave took into it. After none, the
    /// view was not left.
    void enter(RenderSession& session, const View& view, const ViewDependence& dependence,
               const Workers& workers);

    void drop();

    /// True if the history adds to an image of so many passes.
    bool counts(int passes) const
    {
        return _share > 0.0 && static_cast<float>(passes - 1) < 2.0f * kMostCount;
    }

    /// Adds the history to the image of the session's film, which has so many passes, and to its
    /// errors: those of all samples together. Below two passes the error is estimated by how film
    /// and history differ; where there is no history it is not known, and then as large as the
    /// radiance.
    void blend(ResolvedImage& image, int passes, const Workers& workers) const;

    /// The session's image with the history, as display values and window depths. For less than
    /// blend and presentImage, and the next leave then finds half of its work done.
    void show(const RenderSession& session, const ToneMap& toneMap, uint8_t* rgba, float* depth);

    double share() const { return _share; }     ///< of pixels with history
    double seconds() const { return _seconds; } ///< that the last leave and enter took

private:
    void blendRows(const RenderSession& session, const ToneMap* toneMap, uint8_t* rgba,
                   float* depth);

    SampledImage _history; ///< of the present view
    SampledImage _left;    ///< what leave took
    View _leftView;
    std::vector<float> _blended; ///< film and history, of so many passes of the film; 0: of none
    int _blendedPasses = 0;
    bool _taken = false; ///< leave was called; enter was not yet
    double _share = 0.0;
    double _seconds = 0.0;
};

} // namespace osgRayTrace::engine
