// PassContext.h - the input of a pass over the image of one view. Layer: integrators.
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
struct VolumePhotons;
class PixelProjection;
class SkyPortals;

/// The input of a pass over the image of one view. All threads share it, and none changes it.
struct PassContext
{
    const TracedScene* traced = nullptr;
    const std::vector<Light>* lights = nullptr; ///< scene lights, placed for the view if eye-space
    CameraRays camera;
    int width = 0, height = 0;            ///< size of the image [pixels]
    Vec3 eye{0.0f};                       ///< the view's origin, engine space
    Vec3 towardsViewer{0.0f, 0.0f, 1.0f}; ///< the view's +z axis, unit, engine space
    Mat3 eyeFromEngine{1.0f};             ///< rotation into the view's axes
    RenderOptions options;                ///< options with the chosen integrator, never Automatic
    PassKey key;
    PassKey pathKey;             ///< key of camera paths; for PPM that of sharedPaths()
    float coneScale = 1.0f;      ///< width of ray cones over that of pixels: see RayCones.h
    bool wantsDepth = true;      ///< true in the first pass: first hits are recorded
    bool throughCentres = false; ///< true: camera rays are those of firstHits

    PhotonUse photonUse = PhotonUse::None;
    /// The environment's strata, if options.environmentSampling is Structured; null: none.
    const std::vector<EnvironmentStratum>* strata = nullptr;
    const SkyPortals* portals = nullptr; ///< openings of the scene to the sky; null: not known

    const PhotonMap* photons = nullptr;          ///< photons of the pass, if photonUse is not None
    const PixelProjection* projection = nullptr; ///< of the camera; set if photons are
    float leastPhotonRadius = 0.0f;              ///< least radius of look-ups in this pass [length]
    float largestPhotonRadius = 0.0f;
    /// Photons of the pass within media; null: there are none.
    const VolumePhotons* volumePhotons = nullptr;
    float beamRadius = 0.0f;  ///< of the kernel of beams in this pass [length]
    float pointRadius = 0.0f; ///< of spheres in dense media in this pass [length]
    float leastSine = 1e-3f;  ///< see BeamQuery
};

} // namespace osgRayTrace::engine
