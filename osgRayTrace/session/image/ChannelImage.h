// ChannelImage.h - normals, distances and the like of a view's first hits. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/integrators/shared/Integrator.h"
#include "osgRayTrace/session/image/Channel.h"
#include "osgRayTrace/session/image/ResolvedImage.h"

namespace osgRayTrace::engine
{

/// Returns the image of a channel, as RenderSession::resolveChannel does. context is that of the
/// first pass of the film's image.
std::vector<float> channelImage(Channel channel, const Film& film, const PassContext& context,
                                const Workers& workers);

/// Sets a tile's part of an image's samples. tile holds kTilePixels samples.
void setSurfaceSamples(const SurfaceSample* tile, int left, int bottom, int width, int height,
                       std::vector<SurfaceSample>& samples);

/// Sets the samples as RenderSession::surfaceSamples does.
void surfaceSamples(const PassContext& context, const Workers& workers,
                    std::vector<SurfaceSample>& samples);

} // namespace osgRayTrace::engine
