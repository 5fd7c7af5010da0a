// FreshSamples.h - more samples for the pixels of an image that have few. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/session/history/Reprojection.h"

#include <functional>

namespace osgRayTrace::engine
{

class RenderSession;

/// Pixels with fewer samples than kFreshEnough get up to kMostFresh more in a frame.
constexpr int kFreshEnough = 8, kMostFresh = 4;

/// All fresh samples of an image together are at most this share of a pass: if more are wanted,
/// each pixel gets one less, or two, until they are not.
constexpr double kFreshShare = 0.25;

/// Adds samples of the session's image to the pixels of image that have few, as kFreshEnough and
/// kMostFresh say. image: samples of the same view and scene, beside those of the film. most: no
/// pixel gets more samples than this altogether. Tiles without a pass get none. shouldStop, called
/// by any thread, ends it early; pixels have then one sample each before any has two. Runs on all
/// threads; unless shouldStop says stop, the result does not depend on their number.
void addFreshSamples(RenderSession& session, float most, const std::function<bool()>& shouldStop,
                     const Workers& workers, SampledImage& image);

} // namespace osgRayTrace::engine
