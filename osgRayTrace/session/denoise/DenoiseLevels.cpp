// DenoiseLevels.cpp - one level of the denoising filter. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseTaps.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Differences of luminance are measured in so many standard deviations [Schied17, eq. 5].
constexpr float kDeviations = 4.0f;
/// This part of the luminance is added to the standard deviations.
constexpr float kLeastContrast = 1e-4f;

struct LevelSums
{
    float r, g, b, variance, weight;
};

/// Holds the light in the middle of the taps.
struct CentreLight
{
    float r, g, b, luminance;
    float perDeviation; ///< factor that makes a difference of luminance fallOff's argument
};

/// Holds the place of a tap, in cells from the middle, and its weight in the kernel.
struct TapPlace
{
    int i; ///< index of the cell in its row
    float dx, dy, kernel;
};

/// Adds a tap of a level. The light is summed as its difference from the middle, so that an even
/// surface stays as it is.
OSGRAYTRACE_INLINE void addTap(const Centre& centre, const CentreLight& middle,
                               const GuideTap& surface, const LightTap& light, TapPlace tap,
                               LevelSums& sums)
{
    const int i = tap.i;
    const float tapR = light.r[i], tapG = light.g[i], tapB = light.b[i];
    const float contrast =
        std::fabs(luminanceOf(tapR, tapG, tapB) - middle.luminance) * middle.perDeviation;
    const float weight =
        tap.kernel * fallOff(contrast + surfaceDistance(centre, surface, i, tap.dx, tap.dy));
    sums.r += weight * (tapR - middle.r);
    sums.g += weight * (tapG - middle.g);
    sums.b += weight * (tapB - middle.b);
    sums.variance += weight * weight * light.variance[i];
    sums.weight += weight;
}

/// Computes sum(w c) / sum(w) and the variance sum(w^2 v) / sum(w)^2 [Schied17, eq. 1, 2] over 3 x
/// 3 taps.
OSGRAYTRACE_KERNEL
void filterRow(const GuideTap (&guides)[3], const float* slopeX, const float* slopeY,
               const float* sharpness, const LightTap (&light)[3], int step, int count, OutRow out)
{
    const GuideTap g0 = guides[0], g1 = guides[1], g2 = guides[2];
    const LightTap l0 = light[0], l1 = light[1], l2 = light[2];
    const auto d = static_cast<float>(step);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const Centre c{g1.normalX[i], g1.normalY[i], g1.normalZ[i], g1.distance[i],
                       slopeX[i],     slopeY[i],     sharpness[i]};
        const float r = l1.r[i], g = l1.g[i], b = l1.b[i], v = l1.variance[i];
        const float luminance = luminanceOf(r, g, b);
        const float per = 1.0f / (kDeviations * std::sqrt(v) + kLeastContrast * luminance + 1e-20f);
        const CentreLight m{r, g, b, luminance, per};
        LevelSums s{0.0f, 0.0f, 0.0f, 0.0625f * v, 0.25f};
        addTap(c, m, g0, l0, {i - step, -d, -d, 0.0625f}, s);
        addTap(c, m, g0, l0, {i, 0.0f, -d, 0.125f}, s);
        addTap(c, m, g0, l0, {i + step, d, -d, 0.0625f}, s);
        addTap(c, m, g1, l1, {i - step, -d, 0.0f, 0.125f}, s);
        addTap(c, m, g1, l1, {i + step, d, 0.0f, 0.125f}, s);
        addTap(c, m, g2, l2, {i - step, -d, d, 0.0625f}, s);
        addTap(c, m, g2, l2, {i, 0.0f, d, 0.125f}, s);
        addTap(c, m, g2, l2, {i + step, d, d, 0.0625f}, s);
        const float scale = 1.0f / s.weight;
        out.r[i] = r + scale * s.r;
        out.g[i] = g + scale * s.g;
        out.b[i] = b + scale * s.b;
        out.variance[i] = scale * scale * s.variance;
    }
}

} // namespace

void filterCells(const DenoiseGuides& guides, const CellLight& light, int step, int y,
                 CellLight& filtered)
{
    const GuideTap surfaces[3] = {guideTap(guides, y - step), guideTap(guides, y),
                                  guideTap(guides, y + step)};
    const LightTap lights[3] = {lightTap(light, y - step), lightTap(light, y),
                                lightTap(light, y + step)};
    filterRow(surfaces, guides.cells.slopeX.row(y), guides.cells.slopeY.row(y),
              guides.cells.sharpness.row(y), lights, step, guides.cellsX,
              {filtered.r.row(y), filtered.g.row(y), filtered.b.row(y), filtered.variance.row(y)});
}

} // namespace osgRayTrace::engine
