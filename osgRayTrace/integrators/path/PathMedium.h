// PathMedium.h - takes paths through participating media to the next surface. Layer: integrators.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/path/PathBounce.h"

namespace osgRayTrace::engine
{

struct MediumSegments;

/// The number of collisions after which a path that meets no surface ends. What such paths still
/// carried is lost: TileCounts::cutWalks.
constexpr uint32_t kMostCollisions = 10000;

/// Takes the active paths of a block, whose rays have found their closest hits, through media until
/// they meet a surface or leave the scene. Adds the light that media emit and scatter towards the
/// rays. Collisions change rays, hits, throughputs and flags; boundaries of media are passed; paths
/// may end. All collisions on the way to the next surface belong to the ray of this number. Returns
/// the paths that have collided. last: rays of this number find emission alone. use: of the photons
/// that the rays look up within media.
LaneMask travelMedia(Tile& tile, PathBlock& block, int number, bool last, PhotonUse use);

/// Adds what photon beams bring to the stretches of lanes, which belong to rays of this number.
/// fromCamera: the stretches are those of camera rays that have met nothing yet.
void addBeams(Tile& tile, const PathBlock& block, const MediumSegments& segments, LaneMask lanes,
              int number, bool fromCamera);

/// Sets the bodies of the paths that scatter() has sent through the surface of one.
void enterBodies(const Tile& tile, PathBlock& block, const Bounce& bounce);

/// Multiplies the light samples of surfaces by what media leave of them.
void dimSamples(const Tile& tile, const PathBlock& block, const Bounce& bounce, LaneMask visible,
                LightLanes& samples);

} // namespace osgRayTrace::engine
