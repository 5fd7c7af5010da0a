// ToneMap.h - from accumulated radiance to display values. Layer: film.
// SPDX-License-Identifier: MIT
#pragma once

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
struct ToneMap
{
    float exposureEv = 0.0f;
    bool displayReferred = false; ///< the film holds display values, not linear radiance
    ToneCurve curve = ToneCurve::Srgb;

    bool operator==(const ToneMap& other) const
    {
        return exposureEv == other.exposureEv && displayReferred == other.displayReferred &&
               curve == other.curve;
    }
    bool operator!=(const ToneMap& other) const { return !(*this == other); }
};

float srgbFromLinear(
    float linear); ///< without clamping; odd: a negative value gives a negative one
float linearFromSrgb(float encoded);

} // namespace osgRayTrace::engine
