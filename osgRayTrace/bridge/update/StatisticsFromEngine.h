// StatisticsFromEngine.h - the engine's counts as the public statistics show them. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/bridge/convert/SceneConverter.h"
#include "osgRayTrace/session/RenderProgress.h"
#include "osgRayTrace/session/view/ViewProgress.h"

#include <osgRayTrace/Statistics>

namespace osgRayTrace::engine
{

/// Sets the scene's part of the statistics; the conversion's counts and seconds too.
void setSceneStatistics(Statistics& statistics, const ConversionResult& conversion,
                        const TracedScene& traced);

/// Sets the image's part, ok and message. A render that was cancelled after a complete pass is ok.
void setImageStatistics(Statistics& statistics, const RenderProgress& progress);

/// Sets what the view did to the image between accumulation and display.
void setStageStatistics(Statistics& statistics, const StageReport& report);

/// Sets what is in them of the image's denoising, and warns once if it was not as asked for.
void setDenoiseStatistics(Statistics& statistics, const DenoiseReport& report, double seconds);

} // namespace osgRayTrace::engine
