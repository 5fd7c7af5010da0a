// RenderOptionsFromSettings.h - the engine's options from the public settings. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/ToneMap.h"
#include "osgRayTrace/integrators/shared/RenderOptions.h"
#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/session/denoise/DenoiseReport.h"
#include "osgRayTrace/session/view/ViewInputs.h"

#include <osgRayTrace/RayTraceSettings>

namespace osgRayTrace::engine
{

/// Returns the settings that the integrators need.
RenderOptions renderOptionsFromSettings(const RayTraceSettings& settings);

/// Returns the engine's name of a tone curve.
ToneCurve toneCurve(RayTraceSettings::ToneCurve curve);

/// Returns the tone map of an image of the scene: the settings' exposure and curve, the scene's
/// colour rule.
ToneMap toneMapFromSettings(const RayTraceSettings& settings, const Scene& scene);

/// Lets media veil the clear colour if they veil anything, as far as it is opaque and the image
/// linear.
void setVeiled(bool veils, const osg::Vec4& clearColor, ToneMap& toneMap);

/// Returns how images are denoised before they are displayed. Debug channels are not denoised.
DenoiseKind denoiseKind(const RayTraceSettings& settings);

/// Takes over what the image of a view needs of the settings; scene, workers and photons stay.
void setInputs(ViewInputs& inputs, const RayTraceSettings& settings);

} // namespace osgRayTrace::engine
