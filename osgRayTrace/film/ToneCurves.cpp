// ToneCurves.cpp - the curves of Khronos and of AgX. Layer: film.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/film/ToneCurves.h"

#include "osgRayTrace/film/PowerLanes.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr float kBrightest = 1e9f; ///< of exposed radiance: products of three stay finite

struct Rgb
{
    float r, g, b;
};

OSGRAYTRACE_INLINE float least(float a, float b)
{
    return a < b ? a : b;
}

OSGRAYTRACE_INLINE float largest(float a, float b)
{
    return a > b ? a : b;
}

/// Returns an exposed value within [0, kBrightest]; NaN becomes 0.
OSGRAYTRACE_INLINE float exposed(float value, float scale)
{
    const float x = value * scale;
    return x > 0.0f ? least(x, kBrightest) : 0.0f;
}

/// Keeps hues, and the colours of surfaces in even light: only highlights are compressed and
/// desaturated [Khronos24].
OSGRAYTRACE_INLINE Rgb neutral(Rgb c)
{
    constexpr float kStart = 0.8f - 0.04f, kDesaturation = 0.15f;
    const float low = least(c.r, least(c.g, c.b));
    const float offset = low < 0.08f ? low - 6.25f * low * low : 0.04f;
    const Rgb x{c.r - offset, c.g - offset, c.b - offset};
    const float peak = largest(x.r, largest(x.g, x.b));
    const float above = largest(peak - kStart, 0.0f);
    constexpr float kRoom = 1.0f - kStart;
    const float newPeak = 1.0f - kRoom * kRoom / (above + kRoom);
    const float scale = newPeak / largest(peak, kStart);
    const float grey = 1.0f - 1.0f / (kDesaturation * (largest(peak, kStart) - newPeak) + 1.0f);
    const bool isHighlight = peak >= kStart;
    const float keep = isHighlight ? scale * (1.0f - grey) : 1.0f;
    const float add = isHighlight ? newPeak * grey : 0.0f;
    return {x.r * keep + add, x.g * keep + add, x.b * keep + add};
}

/// Returns AgX's contrast of a logarithm in [0,1] [Wrensch23].
OSGRAYTRACE_INLINE float agxContrast(float x)
{
    return -0.00232f +
           x * (0.1191f + x * (0.4298f + x * (-6.868f + x * (31.96f + x * (-40.14f + x * 15.5f)))));
}

OSGRAYTRACE_INLINE float agxLogarithm(float x)
{
    constexpr float kLeast = -12.47393f, kMost = 4.026069f;
    const float log = log2Lanes(largest(x, 1e-30f));
    return (least(largest(log, kLeast), kMost) - kLeast) / (kMost - kLeast);
}

/// Returns x^2.2 for x that may be a little below 0 or above 1: the display that AgX is made for.
OSGRAYTRACE_INLINE float agxDisplay(float x)
{
    return exp2Lanes(2.2f * log2Lanes(largest(least(x, 1.0f), 1e-6f)));
}

/// Desaturates what is bright, as film does, by a curve of each channel between two changes of
/// primaries [Wrensch23].
OSGRAYTRACE_INLINE Rgb agx(Rgb c)
{
    const float r =
        agxContrast(agxLogarithm(0.842479062f * c.r + 0.0784336f * c.g + 0.0792237451f * c.b));
    const float g =
        agxContrast(agxLogarithm(0.0423282422f * c.r + 0.878468636f * c.g + 0.0791661275f * c.b));
    const float b =
        agxContrast(agxLogarithm(0.0423756549f * c.r + 0.0784336f * c.g + 0.879142974f * c.b));
    return {agxDisplay(1.19687901f * r - 0.0980208811f * g - 0.0990297441f * b),
            agxDisplay(-0.0528968518f * r + 1.15190313f * g - 0.0989611768f * b),
            agxDisplay(-0.0529716355f * r - 0.0980434501f * g + 1.15107367f * b)};
}

template <Rgb (*curve)(Rgb)>
OSGRAYTRACE_INLINE void applyLane(float exposure, int i, RgbaLanes& block)
{
    const float alpha = block.a[i] > 0.0f ? block.a[i] : 1.0f;
    const float scale = exposure / alpha;
    const Rgb shown =
        curve({exposed(block.r[i], scale), exposed(block.g[i], scale), exposed(block.b[i], scale)});
    block.r[i] = shown.r * alpha;
    block.g[i] = shown.g * alpha;
    block.b[i] = shown.b * alpha;
}

OSGRAYTRACE_KERNEL
void applyNeutral(float exposure, RgbaLanes* __restrict blocks)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
            applyLane<neutral>(exposure, i, blocks[b]);
    }
}

OSGRAYTRACE_KERNEL
void applyAgx(float exposure, RgbaLanes* __restrict blocks)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
            applyLane<agx>(exposure, i, blocks[b]);
    }
}

} // namespace

void applyCurve(ToneCurve curve, float exposure, TileRgba& values)
{
    switch (curve)
    {
    case ToneCurve::Srgb:
        return;
    case ToneCurve::Neutral:
        applyNeutral(exposure, values);
        return;
    case ToneCurve::Agx:
        applyAgx(exposure, values);
        return;
    }
}

} // namespace osgRayTrace::engine
