// ViewInputs.h - what the image of a view is made from, besides its matrices. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/integrators/shared/RenderOptions.h"
#include "osgRayTrace/session/denoise/DenoiseReport.h"

#include <memory>

namespace osgRayTrace::engine
{

class TracedScene;  // accel: a Scene with its Embree structures
class Workers;      // base: the threads that a render may use
class TileHelp;     // session: those who trace tiles elsewhere
class PhotonPasses; // photons: the maps that all views of a scene share

/// ViewInputs is plain data: a copy stays as it is while the scene and the settings go on.
struct ViewInputs
{
    /// The scene is null if there is none yet, or none that can be traced.
    std::shared_ptr<const TracedScene> scene;
    std::shared_ptr<Workers> workers;
    std::shared_ptr<PhotonPasses> photons; ///< shared by all views of the scene
    std::shared_ptr<TileHelp> help;        ///< null: all tiles are traced here
    RenderOptions options;
    float exposureEv = 0.0f;   ///< [f-stops]
    bool autoExposure = false; ///< the mean of the image adds to exposureEv
    ToneCurve toneCurve = ToneCurve::Srgb;
    DenoiseKind denoise = DenoiseKind::Off;
    bool reprojects =
        false; ///< whether a view that moves takes along what its image has accumulated
    /// Whether a view that does not move keeps what it has accumulated where nothing near has
    /// changed, if little changes in the scene.
    bool keepsUnchanged = false;
    int maxPasses = 1;
    int passesPerFrame = 1; ///< passes of a frame without a budget
};

/// Returns how an image of the scene is shown: by the inputs' exposure, the scene's colour rule,
/// and the background if media veil it. The inputs have a scene.
ToneMap toneMapOf(const ViewInputs& inputs);

/// Returns true if the image of one is as good for the other.
bool sameImage(const ViewInputs& a, const ViewInputs& b);

} // namespace osgRayTrace::engine
