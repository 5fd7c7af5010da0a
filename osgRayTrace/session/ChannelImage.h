// ChannelImage.h - normals, distances and the like of a view's first hits. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/Integrator.h"
#include "osgRayTrace/session/RenderSession.h"
#include "osgRayTrace/session/ShownImage.h"

namespace osgRayTrace::engine
{

/// See RenderSession::resolveChannel. context: of the first pass of the film's image.
std::vector<float> channelImage(Channel channel, const Film& film, const PassContext& context,
                                const Workers& workers);

/// See RenderSession::surfaceSamples.
std::vector<SurfaceSample> surfaceSamples(const PassContext& context, const Workers& workers);

} // namespace osgRayTrace::engine
