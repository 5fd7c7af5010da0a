// PreparedScene.h - a scene of the report, ready to be traced. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/ReportScene.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/session/RenderSession.h"

#include <memory>

namespace osgRayTrace::bench
{

/// Holds linear RGB, row 0 at the bottom, width * height * 3 values.
struct Pixels
{
    int width = 0, height = 0;
    std::vector<float> rgb;
};

struct PreparedScene
{
    std::shared_ptr<engine::Workers> workers;
    std::shared_ptr<const engine::TracedScene> traced;
    engine::View view;
    double buildSeconds = 0.0; ///< time of conversion and BVH [s]
};

/// Prepares a scene in the way of every user: the graph below a transform, the converter, the BVHs,
/// with the eye as the origin.
PreparedScene prepare(const ReportScene& scene, const Placement& placement, int width,
                      std::shared_ptr<engine::Workers> workers);

int heightOf(const ReportScene& scene, int width);

/// Returns a hash of geometry, materials, lights and camera as they are traced: it changes if the
/// picture can.
uint64_t hashOf(const PreparedScene& scene, const Method& method);

/// Returns a session that renders the method with a seed.
std::unique_ptr<engine::RenderSession> newSession(const PreparedScene& scene, const Method& method,
                                                  uint32_t seed);

/// Continues the picture. Throws EngineError if that fails.
engine::RenderProgress renderOn(engine::RenderSession& session, const engine::StopRule& rule);

Pixels pixelsOf(const engine::RenderSession& session);

} // namespace osgRayTrace::bench
