// StatisticsFromEngine.h - sets the public statistics from the engine's counts. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"
#include "osgRayTrace/session/RenderProgress.h"
#include "osgRayTrace/session/view/ViewProgress.h"

#include <osgRayTrace/Statistics>

namespace osgRayTrace::engine
{

/// Sets the scene's part of the statistics, including the conversion's counts and seconds.
void setSceneStatistics(Statistics& statistics, const ConversionResult& conversion,
                        const TracedScene& traced);

/// Sets the image's part, ok and message. A render that was cancelled after a complete pass is ok.
void setImageStatistics(Statistics& statistics, const RenderProgress& progress);

/// Sets what the view did to the image between accumulation and display.
void setStageStatistics(Statistics& statistics, const StageReport& report);

/// Sets the denoising part, and warns once if the denoiser was not the one that was asked for.
void setDenoiseStatistics(Statistics& statistics, const DenoiseReport& report, double seconds);

} // namespace osgRayTrace::engine
