// ToneCurves.h - curves that bring bright radiance into the range of displays. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/film/ToneMap.h"

namespace osgRayTrace::engine
{

/// Replaces the linear radiance of a tile by what a display is to send, linear in [0,1]. Colours
/// are multiplied with alpha before and after; the curve is that of the colours without it, times
/// exposure.
void applyCurve(ToneCurve curve, float exposure, TileRgba& values);

} // namespace osgRayTrace::engine
