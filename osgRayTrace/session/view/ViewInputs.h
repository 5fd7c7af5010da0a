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
class PhotonPasses; // photons: the maps that all views of a scene share

/// Plain data: a copy stays what it is while the scene and the settings go on.
struct ViewInputs
{
    /// Null: there is no scene yet, or none that can be traced.
    std::shared_ptr<const TracedScene> scene;
    std::shared_ptr<Workers> workers;
    std::shared_ptr<PhotonPasses> photons; ///< shared by all views of the scene
    RenderOptions options;
    float exposureEv = 0.0f; ///< [f-stops]
    DenoiseKind denoise = DenoiseKind::Off;
    bool reprojects = false; ///< a view that moves takes along what its image has accumulated
    int maxPasses = 1;
    int passesPerFrame = 1; ///< without a frame budget
};

/// How an image of the scene is shown: the inputs' exposure, the scene's colour rule. There must be
/// a scene.
ToneMap toneMapOf(const ViewInputs& inputs);

/// True if the image of one is as good for the other.
bool sameImage(const ViewInputs& a, const ViewInputs& b);

} // namespace osgRayTrace::engine
