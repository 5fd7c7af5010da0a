// PassContext.h - what a pass over the image of one view works with. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/integrators/shared/RenderOptions.h"
#include "osgRayTrace/photons/PhotonUse.h"
#include "osgRayTrace/sampling/Sampler.h"
#include "osgRayTrace/scene/View.h"

#include <vector>

namespace osgRayTrace::engine
{

class PhotonMap;

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

} // namespace osgRayTrace::engine
