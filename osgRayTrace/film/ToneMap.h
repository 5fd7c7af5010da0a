// ToneMap.h - from accumulated radiance to display values. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

namespace osgRayTrace::engine
{

/// How bright radiance comes into the range of a display.
enum class ToneCurve
{
    Srgb,    ///< it is clamped
    Neutral, ///< highlights are compressed, colours of surfaces stay [Khronos24]
    Agx,     ///< all is compressed, as by film [Wrensch23]
};

/// Maps linear radiance to display values: encode(curve(2^exposureEv * linear)), clamped to [0,1],
/// where encode is sRGB's transfer function [IEC61966]. A display-referred image is decoded to
/// linear first, so that exposure 0 shows it unchanged. Colours that are multiplied with alpha are
/// divided by alpha first and multiplied again last.
///
/// Over a veiled background, the display values D of a pixel of colours R and coverage alpha are
/// those that a display, which blends D + (1 - alpha) background, shows as
///
///     encode(curve(2^exposureEv * R) + (1 - alpha) * decode(background))
///
/// where the background is a display value. Fog before nothing then looks as fog before a surface
/// of the background's colour does.
struct ToneMap
{
    float exposureEv = 0.0f;
    bool displayReferred = false; ///< the film holds display values, not linear radiance
    ToneCurve curve = ToneCurve::Srgb;
    bool veiled = false;   ///< media dim the background, which is opaque; not if displayReferred
    Vec3 background{0.0f}; ///< display values in [0,1]

    bool operator==(const ToneMap& other) const
    {
        return exposureEv == other.exposureEv && displayReferred == other.displayReferred &&
               curve == other.curve && veiled == other.veiled && background == other.background;
    }
    bool operator!=(const ToneMap& other) const { return !(*this == other); }
};

float srgbFromLinear(
    float linear); ///< without clamping; odd: a negative value gives a negative one
float linearFromSrgb(float encoded);

} // namespace osgRayTrace::engine
