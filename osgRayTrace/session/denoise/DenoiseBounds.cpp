// DenoiseBounds.cpp - reduces bright cells to a brightness that their neighbours allow. Layer:
// session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseTaps.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Number of standard deviations of its neighbours by which a cell may be brighter than their mean.
constexpr float kOutlier = 4.0f;
/// Number of its own standard errors by which a cell may be brighter than its neighbours' mean.
constexpr float kCertain = 3.0f;

struct Moments
{
    float weight, sum, squares, variance;
};

/// Points to a row of cells of the neighbourhood.
struct MomentTap
{
    GuideTap surface;
    const float *means, *variances;
};

/// Adds a cell of the neighbourhood to its moments. Luminance is counted from that of a cell nearby
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

/// Adds the cells of a row except the one in its middle.
OSGRAYTRACE_INLINE void addMomentsOfRow(const Centre& centre, float reference, const MomentTap& row,
                                        int i, float dy, Moments& m)
{
    addMoments(centre, reference, row, i - 2, -2.0f, dy, m);
    addMoments(centre, reference, row, i - 1, -1.0f, dy, m);
    addMoments(centre, reference, row, i + 1, 1.0f, dy, m);
    addMoments(centre, reference, row, i + 2, 2.0f, dy, m);
}

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
        // The reference is the darkest cell around, as the middle may be brighter by orders of
        // magnitude.
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
        const float towards = scale * m.sum; // neighbours' mean, counted from the reference
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

} // namespace

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

} // namespace osgRayTrace::engine
