// OpeningFinder.h - finds small openings that light comes through to what views see. Layer:
// photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonOpenings.h"
#include "osgRayTrace/photons/PhotonTargets.h"
#include "osgRayTrace/photons/TracedPhotons.h"

#include <memory>
#include <vector>

namespace osgRayTrace::engine
{

// Views tell where they look up photons, and flights tell how photons have come there. A photon at
// a surface is as useful as the place, and as the places to which it goes on: the more a view looks
// there, and the fewer photons end there. Summed up by cells of surfaces, that tells flights that
// enter, from where photons are of little use to where they are of much. Spheres are put where
// these come together, as long as few spheres hold most of them. Nothing is found where most
// photons are useful, as in a room with the camera, and where entering flights do not come
// together.

/// Returns the share of the stored flights that end near seen points.
double seenShare(const Sphere& scene, const std::vector<PhotonFlight>& flights,
                 const std::vector<SeenPoint>& seen);

/// Returns the small openings through which flights go to what views see; null: there are none.
/// photons: number of photons that the flights are of. The result depends on the order of neither
/// the flights' threads nor the views' tiles, as both lists are in order.
std::shared_ptr<const PhotonOpenings> findOpenings(const Sphere& scene,
                                                   const std::vector<PhotonFlight>& flights,
                                                   const std::vector<SeenPoint>& seen,
                                                   double photons);

/// Returns smaller openings within those that were found first, learnt from flights that these have
/// sent; first itself if there are none.
std::shared_ptr<const PhotonOpenings>
refineOpenings(const Sphere& scene, const std::vector<PhotonFlight>& flights,
               const std::vector<SeenPoint>& seen, double photons,
               const std::shared_ptr<const PhotonOpenings>& first);

} // namespace osgRayTrace::engine
