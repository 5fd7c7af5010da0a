// KeptSamples.h - how many samples pixels keep when some instances of the scene have changed.
// Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/history/SceneChange.h"
#include "osgRayTrace/session/image/SurfaceMap.h"

#include <vector>

namespace osgRayTrace::engine
{

/// A pixel behind which smooth surfaces show others keeps no more samples than this.
constexpr float kSmoothKept = 4.0f;

/// Lowers the counts of samples of the pixels of a view, for the same view of the changed scene:
///
/// - to 0 if a changed box is seen in the pixel, or hides one of the lights from its surface (what
///   has moved may take its samples along, see MovedSamples.h);
/// - to 1 / (8 s^2) if changed boxes take the share s of what lights the surface otherwise, and to
///   0 if that is less than one sample. For diffuse light, s is the sum of A / (pi d^2) over the
///   boxes above the surface, where A is the mean projected area of a box, a quarter of its
///   surface, and d its distance. Lobes around the mirror direction see a box in
///   the share of their width that it takes. What is stale then remains below half the noise of as
///   many samples whose deviation is their mean;
/// - to kSmoothKept if the surface is a mirror or clear glass;
/// - to 0 if there are too many boxes and lights to look at, see ChangedSight.h.
///
/// Each pixel has the least of its limit and those of the eight pixels around it, as it may show
/// their surfaces in part. map: surfaces of the view before the change. lights: those of the scene,
/// placed for the view. Runs on all threads; the result does not depend on their number.
void limitKept(const SurfaceMap& map, const Scene& scene, const std::vector<Light>& lights,
               const SceneChange& change, const Workers& workers, std::vector<float>& count);

} // namespace osgRayTrace::engine
