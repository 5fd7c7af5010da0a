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

/// What the integrators need of the settings.
RenderOptions renderOptionsFromSettings(const RayTraceSettings& settings);

/// How an image of the scene is shown: the settings' exposure, the scene's colour rule.
ToneMap toneMapFromSettings(const RayTraceSettings& settings, const Scene& scene);

/// How images are denoised before they are shown. Debug channels are not.
DenoiseKind denoiseKind(const RayTraceSettings& settings);

/// Takes over what the image of a view needs of the settings; scene, workers and photons stay.
void setInputs(ViewInputs& inputs, const RayTraceSettings& settings);

} // namespace osgRayTrace::engine
