// GroundPlane.cpp - finds the height of the ground. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/convert/GroundPlane.h"

#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

constexpr double kGap = 1e-4; ///< distance of the ground from the model, over the model's diagonal

} // namespace

float groundOf(const GroundRequest& request, const Scene& scene)
{
    if (!request.wanted) return kNoGround;
    if (!request.below) return static_cast<float>((request.height - scene.origin.z) / scene.unit);
    Vec3d low(kInfinity), high(-kInfinity);
    for (const Instance& instance : scene.instances)
    {
        if (instance.light != kInvalid) continue;
        for (const Vec3& position : scene.meshes[instance.mesh]->positions)
        {
            const Vec3d p(instance.placed ? transformPoint(instance.engineFromLocal, position)
                                          : position);
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    if (!(low.z <= high.z)) return kNoGround;
    return static_cast<float>(low.z - kGap * glm::length(high - low));
}

void warnWithoutShadows(const Scene& scene)
{
    if (!hasGround(scene.ground)) return;
    const bool casts = std::any_of(scene.lights.begin(), scene.lights.end(),
                                   [](const Light& light) { return light.castsShadows; });
    if (!casts)
        warnOnce("the ground shows nothing: no light of the scene casts shadows; a sun, an "
                 "environment or headlight-shadows do");
}

} // namespace osgRayTrace::engine
