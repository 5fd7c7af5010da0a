// FeaturesMode.h - what a feature costs a scene that does not use it. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

namespace osgRayTrace::bench
{

/// For each feature that SceneTraits knows and that rays have to meet: the Cornell box with one
/// triangle out of sight that has the feature, against the same triangle without. No ray meets it,
/// so all that may differ is the price of a code path that is allowed. Then what the specialised
/// paths gain: the same picture taken the general way; here are instances and lights, which take
/// part in every ray's way wherever they are.
void measureFeatures(Rows& rows);

} // namespace osgRayTrace::bench
