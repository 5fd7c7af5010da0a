// GroundPlane.h - the ground of a scene that has been converted. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/GroundRequest.h"
#include "osgRayTrace/scene/Scene.h"

namespace osgRayTrace::engine
{

/// Returns Scene::ground for a scene with all of its instances. A ground below is 1e-4 of the
/// scene's diagonal lower than the lowest vertex, so that it is apart from a model's own floor;
/// area lights do not count. Scenes without triangles have none.
float groundOf(const GroundRequest& request, const Scene& scene);

/// Says once that nothing can cast a shadow on the ground that a scene has, if that is so. The
/// lights of the scene must be there.
void warnWithoutShadows(const Scene& scene);

} // namespace osgRayTrace::engine
