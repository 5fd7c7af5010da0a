// DenoiseCells.cpp - the denoiser's steps: what goes on among cells. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseCells.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Differences of luminance count in terms of so many standard deviations [Schied17, eq. 5].
constexpr float kDeviations = 4.0f;
/// and are nothing below this part of the luminance.
constexpr float kLeastContrast = 1e-4f;
/// A cell may be brighter than its neighbours' mean by so many of their standard deviations.
constexpr float kOutlier = 4.0f;
/// or, as its own errors have it, so many of these.
constexpr float kCertain = 3.0f;

/// Errors and what they have to explain are summed over 7 x 7 cells: an error of two halves is one
/// random number, so those of fewer pixels are no measure. They count for a little more, as detail
/// that is kept where there is none is seen more easily than detail that is lost.
constexpr int kReach = 3;
constexpr float kDoubt = 1.25f;

struct GuideTap
{
    const float *normalX, *normalY, *normalZ, *distance;
};

struct LightTap
{
    const float *r, *g, *b, *variance;
};

GuideTap guideTap(const DenoiseGuides& guides, int y)
{
    const CellGuides& cells = guides.cells;
    return {cells.normalX.row(y), cells.normalY.row(y), cells.normalZ.row(y),
            cells.distance.row(y)};
}

LightTap lightTap(const CellLight& light, int y)
{
    return {light.r.row(y), light.g.row(y), light.b.row(y), light.variance.row(y)};
}

/// The surface in the middle of the taps.
struct Centre
{
    float normalX, normalY, normalZ, distance, slopeX, slopeY, sharpness;
};

/// What parts the surface at a tap from that in the middle, as fallOff's argument [Schied17, eq. 3,
/// 4]; depth is compared with the plane through the middle's. dx, dy: in cells.
OSGRAYTRACE_INLINE float surfaceDistance(const Centre& centre, const GuideTap& tap, int i, float dx,
                                         float dy)
{
    const float plane = centre.distance + dx * centre.slopeX + dy * centre.slopeY;
    return std::fabs(tap.distance[i] - plane) * centre.sharpness +
           normalDistance(centre.normalX, centre.normalY, centre.normalZ, tap.normalX[i],
                          tap.normalY[i], tap.normalZ[i]);
}

struct LevelSums
{
    float r, g, b, variance, weight;
};

/// The light in the middle of the taps.
struct CentreLight
{
    float r, g, b, luminance;
    float perDeviation; ///< what a difference of luminance is multiplied by, as fallOff's argument
};

/// Where a tap is, in cells from the middle, and its weight in the kernel.
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

struct OutRow
{
    float* __restrict r;
    float* __restrict g;
    float* __restrict b;
    float* __restrict variance;
};

/// out = sum(w c) / sum(w), variance = sum(w^2 v) / sum(w)^2 [Schied17, eq. 1, 2], over 3 x 3 taps.
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

struct Moments
{
    float weight, sum, squares, variance;
};

/// A row of cells of the neighbourhood.
struct MomentTap
{
    GuideTap surface;
    const float *means, *variances;
};

/// Adds a cell of the neighbourhood to its moments. Luminance counts from that of a cell nearby
/// (reference), as the squares of larger numbers would lose small differences.
OSGRAYTRACE_INLINE void addMoments(const Centre& centre, float reference, const MomentTap& row,
                                   int i, float dx, float dy, Moments& m)
{
    const uint32_t known = maskOf(row.means[i] < 0.5f * kNoLight);
    const float weight =
        select(known, fallOff(surfaceDistance(centre, row.surface, i, dx, dy)), 0.0f);
    const float difference = select(known, row.means[i] - reference, 0.0f);
    m.weight += weight;
    m.sum += weight * difference;
    m.squares += weight * difference * difference;
    m.variance += weight * row.variances[i];
}

/// Adds the cells of a row but for the one in its middle.
OSGRAYTRACE_INLINE void addMomentsOfRow(const Centre& centre, float reference, const MomentTap& row,
                                        int i, float dy, Moments& m)
{
    addMoments(centre, reference, row, i - 2, -2.0f, dy, m);
    addMoments(centre, reference, row, i - 1, -1.0f, dy, m);
    addMoments(centre, reference, row, i + 1, 1.0f, dy, m);
    addMoments(centre, reference, row, i + 2, 2.0f, dy, m);
}

/// How the plane through each cell of a row lies.
struct PlaneRow
{
    const float *slopeX, *slopeY, *sharpness;
};

/// Bounds the light of a row of cells by that of the 5 x 5 cells around each.
OSGRAYTRACE_KERNEL
void boundRow(const MomentTap (&rows)[5], PlaneRow planes, LightTap light, bool hasErrors,
              int count, OutRow out)
{
    const MomentTap t0 = rows[0], t1 = rows[1], t2 = rows[2], t3 = rows[3], t4 = rows[4];
    const GuideTap g2 = t2.surface;
    const float *m1 = t1.means, *m2 = t2.means, *m3 = t3.means, *v2 = t2.variances;
    const uint32_t errors = maskOf(hasErrors);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const Centre c{g2.normalX[i],    g2.normalY[i],    g2.normalZ[i],      g2.distance[i],
                       planes.slopeX[i], planes.slopeY[i], planes.sharpness[i]};
        const float mean = m2[i], own = v2[i];
        // The darkest around, as the middle may be brighter by orders of magnitude.
        const float besides = m2[i - 1] < m2[i + 1] ? m2[i - 1] : m2[i + 1];
        const float above = m1[i] < m3[i] ? m1[i] : m3[i];
        const float around = besides < above ? besides : above;
        const float reference = mean < around ? mean : around;
        Moments m{0.0f, 0.0f, 0.0f, 0.0f};
        addMomentsOfRow(c, reference, t0, i, -2.0f, m);
        addMoments(c, reference, t0, i, 0.0f, -2.0f, m);
        addMomentsOfRow(c, reference, t1, i, -1.0f, m);
        addMoments(c, reference, t1, i, 0.0f, -1.0f, m);
        addMomentsOfRow(c, reference, t2, i, 0.0f, m);
        addMomentsOfRow(c, reference, t3, i, 1.0f, m);
        addMoments(c, reference, t3, i, 0.0f, 1.0f, m);
        addMomentsOfRow(c, reference, t4, i, 2.0f, m);
        addMoments(c, reference, t4, i, 0.0f, 2.0f, m);

        const float scale = m.weight > 1e-6f ? 1.0f / m.weight : 0.0f;
        const float towards = scale * m.sum; // the neighbours' mean, from the reference
        const float excess = scale * m.squares - towards * towards;
        const float spread = excess > 0.0f ? excess : 0.0f;
        const float certain = mean - select(errors, kCertain * std::sqrt(own), mean);
        const float usual = reference + towards + kOutlier * std::sqrt(spread);
        const float most = m.weight > 1.0f ? (usual > certain ? usual : certain) : mean;
        const float bound = mean > most && mean < 0.5f * kNoLight ? most / mean : 1.0f;
        out.r[i] = bound * light.r[i];
        out.g[i] = bound * light.g[i];
        out.b[i] = bound * light.b[i];
        out.variance[i] = select(errors, (m.variance + own) / (m.weight + 1.0f), spread);
    }
}

/// What is left of the light where it is not known does not count.
OSGRAYTRACE_KERNEL
void residualRow(const float* means, LightTap light, int count, float* __restrict spread)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const float difference = luminanceOf(light.r[i], light.g[i], light.b[i]) - means[i];
        const uint32_t known = maskOf(means[i] < 0.5f * kNoLight);
        spread[i] = select(known, difference * difference + spread[i], 0.0f);
    }
}

constexpr int kSegment = 256; ///< cells that are worked on while they are in the cache

struct Column
{
    float residual[kSegment + 2 * kReach], error[kSegment + 2 * kReach];
};

/// Sums over the columns of the neighbourhood, from kReach cells before the first one on.
OSGRAYTRACE_KERNEL
void sumColumns(const float* const (&residuals)[2 * kReach + 1],
                const float* const (&errors)[2 * kReach + 1], int count, Column& column)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count + 2 * kReach; ++i)
    {
        float residual = 0.0f, error = 0.0f;
        for (int row = 0; row < 2 * kReach + 1; ++row)
        {
            residual += residuals[row][i];
            error += errors[row][i];
        }
        column.residual[i] = residual;
        column.error[i] = error;
    }
}

OSGRAYTRACE_KERNEL
void keepRow(const Column& column, int count, float* __restrict kept)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        float residual = 0.0f, error = 0.0f;
        for (int j = 0; j < 2 * kReach + 1; ++j)
        {
            residual += column.residual[i + j];
            error += column.error[i + j];
        }
        const float k = 1.0f - kDoubt * error / (residual + 1e-30f);
        kept[i] = k > 0.0f ? k : 0.0f;
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

void boundCells(const DenoiseGuides& guides, const CellStatistics& statistics,
                const CellLight& light, bool hasErrors, int y, CellLight& bounded)
{
    MomentTap rows[5];
    for (int i = 0; i < 5; ++i)
        rows[i] = {guideTap(guides, y + i - 2), statistics.mean.row(y + i - 2),
                   statistics.variance.row(y + i - 2)};
    const CellGuides& cells = guides.cells;
    boundRow(rows, {cells.slopeX.row(y), cells.slopeY.row(y), cells.sharpness.row(y)},
             lightTap(light, y), hasErrors, guides.cellsX,
             {bounded.r.row(y), bounded.g.row(y), bounded.b.row(y), bounded.variance.row(y)});
}

void compareCells(const DenoiseGuides& guides, const CellLight& filtered, int y,
                  CellStatistics& statistics)
{
    residualRow(statistics.mean.row(y), lightTap(filtered, y), guides.cellsX,
                statistics.spread.row(y));
}

void keepDetail(const DenoiseGuides& guides, const CellStatistics& statistics, int y,
                CellPlane& kept)
{
    Column column;
    for (int x = 0; x < guides.cellsX; x += kSegment)
    {
        const float *residuals[2 * kReach + 1], *errors[2 * kReach + 1];
        for (int i = 0; i < 2 * kReach + 1; ++i)
        {
            residuals[i] = statistics.spread.row(y + i - kReach) + x - kReach;
            errors[i] = statistics.error.row(y + i - kReach) + x - kReach;
        }
        const int count = std::min(kSegment, guides.cellsX - x);
        sumColumns(residuals, errors, count, column);
        keepRow(column, count, kept.row(y) + x);
    }
}

} // namespace osgRayTrace::engine
