// FeaturesMode.h - the cost of a feature for a scene that does not use it. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/Rows.h"

#include <string>

namespace osgRayTrace::bench
{

/// Measures each feature that SceneTraits knows and that rays have to meet: the Cornell box with
/// one triangle out of sight that has the feature, against the same triangle without. No ray meets
/// the triangle, so that all that may differ is the price of a code path that is allowed. Further
/// rows tell the gain of the specialised paths: the same picture is rendered in the general way.
/// Instances and lights are among these rows, because they take part in every ray's way wherever
/// they are. The rows on proxies tell what rays cost that pass a block which OSG would draw, and
/// the last ones what captures cost updates of a scene without such content. Only features whose
/// name holds this text are measured.
void measureFeatures(const std::string& only, Rows& rows);

} // namespace osgRayTrace::bench
