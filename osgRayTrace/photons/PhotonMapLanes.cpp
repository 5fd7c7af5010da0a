// PhotonMapLanes.cpp - sixteen look-ups at once: discs near each other read the photons around them
// once. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonColumns.h"
#include "osgRayTrace/photons/PhotonMap.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Discs of a group are no farther from its first disc than this many of that disc's radii, and
/// their radii are within a factor of two of that disc's.
constexpr float kNear = 4.0f;

/// Smaller groups are looked up disc by disc, with photons in the lanes. So are groups with more
/// photons around them than kMostTogether, as the photons of each disc fill the lanes, too.
constexpr int kLeastGroup = 4;
constexpr uint32_t kMostTogether = 512;

/// Holds what loops over the discs of a group read beside the queries. Discs that are not in the
/// group have a negative radius2.
struct Discs
{
    FloatLanes radius2, plane, gap;
};

OSGRAYTRACE_KERNEL
LaneMask lanesNear(const PhotonQueryLanes& q, int first)
{
    const Vec3 centre = laneOf(q.position, first);
    const float radius = q.radius[first], near2 = kNear * kNear * radius * radius;
    LaneMask near = 0;
    OSGRAYTRACE_SIMD_OR(near)
    for (int i = 0; i < kLanes; ++i)
    {
        const float dx = q.position.x[i] - centre.x, dy = q.position.y[i] - centre.y,
                    dz = q.position.z[i] - centre.z;
        near |= bitOfLane(maskOf(dx * dx + dy * dy + dz * dz <= near2) &
                              maskOf(q.radius[i] <= 2.0f * radius) &
                              maskOf(q.radius[i] >= 0.5f * radius),
                          i);
    }
    return near;
}

float least(FloatLanes lanes)
{
    for (int width = kLanes / 2; width > 0; width /= 2)
        for (int i = 0; i < width; ++i)
            lanes[i] = select(lanes[i + width] < lanes[i], lanes[i + width], lanes[i]);
    return lanes[0];
}

/// The box of the discs' centres, and how far the discs reach beyond the box at most: all as least
/// values, so the highest coordinates and the reaches are negative.
struct Bounds
{
    FloatLanes lowX, lowY, lowZ;    ///< of each lane; infinity in lanes that are not in the group
    FloatLanes highX, highY, highZ; ///< negative
    FloatLanes reachX, reachY, reachZ; ///< negative
};

OSGRAYTRACE_KERNEL
void boundDiscs(const PhotonQueryLanes& q, LaneMask group, Bounds& bounds)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t in = laneBit(group, i);
        const float nx = q.normal.x[i], ny = q.normal.y[i], nz = q.normal.z[i];
        const float px = q.position.x[i], py = q.position.y[i], pz = q.position.z[i];
        const float x2 = nx * nx, y2 = ny * ny, z2 = nz * nz;
        // A disc is thin: see PhotonMap::rangesOf(const PhotonQuery&, Range*).
        const float x = std::sqrt(y2 + z2) + std::fabs(nx) * kPlaneShare,
                    y = std::sqrt(z2 + x2) + std::fabs(ny) * kPlaneShare,
                    z = std::sqrt(x2 + y2) + std::fabs(nz) * kPlaneShare;
        const float reach = -q.radius[i];
        bounds.reachX[i] = select(in, select(x < 1.0f, x, 1.0f) * reach, 0.0f);
        bounds.reachY[i] = select(in, select(y < 1.0f, y, 1.0f) * reach, 0.0f);
        bounds.reachZ[i] = select(in, select(z < 1.0f, z, 1.0f) * reach, 0.0f);
        bounds.lowX[i] = select(in, px, kInfinity);
        bounds.lowY[i] = select(in, py, kInfinity);
        bounds.lowZ[i] = select(in, pz, kInfinity);
        bounds.highX[i] = select(in, -px, kInfinity);
        bounds.highY[i] = select(in, -py, kInfinity);
        bounds.highZ[i] = select(in, -pz, kInfinity);
    }
}

/// The box of a group's discs: photons outside of it are in none of them.
struct Box
{
    Vec3d exactLow, exactHigh;
    PlainVec3 low, high; ///< no smaller
};

Box boxOf(const PhotonQueryLanes& queries, LaneMask group)
{
    Bounds bounds;
    boundDiscs(queries, group, bounds);
    // Reaches and distances are rounded, hence a share of the reach more.
    constexpr double kMore = 1.0 + 0x1p-16;
    const Vec3d reach =
        -kMore * Vec3d(least(bounds.reachX), least(bounds.reachY), least(bounds.reachZ));
    Box box;
    box.exactLow = Vec3d(least(bounds.lowX), least(bounds.lowY), least(bounds.lowZ)) - reach;
    box.exactHigh = -Vec3d(least(bounds.highX), least(bounds.highY), least(bounds.highZ)) + reach;
    constexpr double kRounding = 0x1p-22; // of a float and its neighbour
    box.low = plainOf(Vec3(box.exactLow - glm::abs(box.exactLow) * kRounding));
    box.high = plainOf(Vec3(box.exactHigh + glm::abs(box.exactHigh) * kRounding));
    return box;
}

Discs discsOf(const PhotonQueryLanes& q, LaneMask group)
{
    Discs discs;
    for (int i = 0; i < kLanes; ++i)
    {
        const bool in = (group >> i) & 1u;
        discs.radius2[i] = in ? q.radius[i] * q.radius[i] : -1.0f;
        discs.plane[i] = q.radius[i] * kPlaneShare;
        discs.gap[i] = gapTolerance(laneOf(q.position, i), q.radius[i]);
    }
    return discs;
}

OSGRAYTRACE_INLINE PlainDisc discOf(const PhotonQueryLanes& q, const Discs& discs,
                                    int32_t mostEdges, int i)
{
    return {plainOf(q.position, i), plainOf(q.normal, i), discs.radius2[i],
            discs.plane[i],         discs.gap[i],         mostEdges};
}

/// True if all shading normals are the geometric ones.
bool isFlat(const PhotonQueryLanes& q, LaneMask group)
{
    uint32_t bent = 0;
    for (int i = 0; i < kLanes; ++i)
        bent |= laneBit(group, i) & (maskOf(q.shadingNormal.x[i] != q.normal.x[i]) |
                                     maskOf(q.shadingNormal.y[i] != q.normal.y[i]) |
                                     maskOf(q.shadingNormal.z[i] != q.normal.z[i]));
    return bent == 0;
}

/// Returns those of sixteen photons that are in a box.
OSGRAYTRACE_INLINE LaneMask blockInBox(const PhotonColumns& columns, uint32_t block, uint32_t end,
                                       const Box& box)
{
    const PhotonColumns p = columns.from(block);
    const int left = static_cast<int>(end - block);
    const PlainVec3 low = box.low, high = box.high;
    LaneMask inside = 0;
    OSGRAYTRACE_SIMD_OR(inside)
    for (int i = 0; i < kLanes; ++i)
        inside |=
            bitOfLane(maskOf(p.x[i] >= low.x) & maskOf(p.x[i] <= high.x) & maskOf(p.y[i] >= low.y) &
                          maskOf(p.y[i] <= high.y) & maskOf(p.z[i] >= low.z) &
                          maskOf(p.z[i] <= high.z) & maskOf(i < left),
                      i);
    return inside;
}

/// Adds photon k to the sums of the discs that it is in.
template <bool kFlat>
OSGRAYTRACE_INLINE void addPhoton(const PhotonColumns& columns, uint32_t k,
                                  const PhotonQueryLanes& q, const Discs& discs, PhotonSumLanes& s)
{
    const auto mostEdges = static_cast<int32_t>(q.mostEdges);
    const PhotonColumns p = columns.from(k);
    const float r = p.r[0], g = p.g[0], b = p.b[0];
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t in = insideDisc(p, 0, discOf(q, discs, mostEdges, i)).in;
        const float weight =
            kFlat ? select(in, 1.0f, 0.0f)
                  : shadingWeight(p, 0, in, plainOf(q.normal, i), plainOf(q.shadingNormal, i));
        s.power.x[i] += weight * r;
        s.power.y[i] += weight * g;
        s.power.z[i] += weight * b;
        s.count[i] += in & 1u;
    }
}

template <bool kFlat>
OSGRAYTRACE_INLINE void addPhotons(const PhotonColumns& columns, uint32_t begin, uint32_t end,
                                   const Box& box, const PhotonQueryLanes& q, const Discs& discs,
                                   PhotonSumLanes& sums)
{
    PhotonSumLanes s = sums;
    for (uint32_t block = begin; block < end; block += kLanes)
        for (LaneMask left = blockInBox(columns, block, end, box); left; left &= left - 1)
            addPhoton<kFlat>(columns, block + static_cast<uint32_t>(firstLane(left)), q, discs, s);
    sums = s;
}

OSGRAYTRACE_KERNEL
void addRange(const PhotonColumns& columns, uint32_t begin, uint32_t end, const Box& box,
              const PhotonQueryLanes& q, const Discs& discs, bool flat, PhotonSumLanes& sums)
{
    if (flat)
        addPhotons<true>(columns, begin, end, box, q, discs, sums);
    else
        addPhotons<false>(columns, begin, end, box, q, discs, sums);
}

/// Returns the lanes whose discs photon k is in.
OSGRAYTRACE_KERNEL
LaneMask lanesAround(const PhotonColumns& columns, uint32_t k, const PhotonQueryLanes& q,
                     const Discs& discs)
{
    const auto mostEdges = static_cast<int32_t>(q.mostEdges);
    const PhotonColumns p = columns.from(k);
    LaneMask around = 0;
    OSGRAYTRACE_SIMD_OR(around)
    for (int i = 0; i < kLanes; ++i)
    {
        around |= bitOfLane(insideDisc(p, 0, discOf(q, discs, mostEdges, i)).in, i);
    }
    return around;
}

/// Sets one mask for sixteen photons each, of those that are in a box.
OSGRAYTRACE_KERNEL
void photonsInBox(const PhotonColumns& columns, uint32_t begin, uint32_t end, const Box& box,
                  LaneMask* masks)
{
    for (uint32_t block = begin; block < end; block += kLanes)
        *masks++ = blockInBox(columns, block, end, box);
}

OSGRAYTRACE_INLINE uint32_t isInWindow(const PhotonColumns& p, int i, const ImageWindow& window)
{
    constexpr float kRounding = 0x1p-4f; // of places in the image [pixels]
    const PlainVec3 way = PlainVec3{p.x[i], p.y[i], p.z[i]} - plainOf(window.origin);
    const float s = dot(plainOf(window.rowS), way), x = dot(plainOf(window.rowX), way),
                y = dot(plainOf(window.rowY), way);
    const float scale = select(maskOf(window.orthographic), 1.0f, s);
    return maskOf(s > 0.0f) & maskOf(x >= (window.left - kRounding) * scale) &
           maskOf(x <= (window.right + kRounding) * scale) &
           maskOf(y >= (window.bottom - kRounding) * scale) &
           maskOf(y <= (window.top + kRounding) * scale);
}

/// Sets one mask for sixteen photons each, of those that are in a window of the image; photons that
/// are hardly outside of it may be among them.
OSGRAYTRACE_KERNEL
void photonsInWindow(const PhotonColumns& columns, uint32_t begin, uint32_t end,
                     const ImageWindow& window, LaneMask* masks)
{
    const ImageWindow w = window;
    for (uint32_t block = begin; block < end; block += kLanes)
    {
        const PhotonColumns p = columns.from(block);
        const int count = static_cast<int>(end - block);
        LaneMask mask = 0;
        OSGRAYTRACE_SIMD_OR(mask)
        for (int i = 0; i < kLanes; ++i)
            mask |= bitOfLane(isInWindow(p, i, w) & maskOf(i < count), i);
        *masks++ = mask;
    }
}

/// Appends those of the photons from begin on that are in discs. masks has one mask for sixteen
/// photons each, of those that may be.
void findAmong(const PhotonColumns& columns, uint32_t begin, uint32_t end, const LaneMask* masks,
               const PhotonQueryLanes& q, const Discs& discs, std::vector<FoundPhoton>& found)
{
    for (uint32_t block = begin; block < end; block += kLanes)
        for (const int i : lanesIn(*masks++))
        {
            const uint32_t k = block + static_cast<uint32_t>(i);
            if (const LaneMask lanes = lanesAround(columns, k, q, discs))
                found.push_back({k, lanes});
        }
}

} // namespace

PhotonQuery laneOf(const PhotonQueryLanes& queries, int i)
{
    PhotonQuery query;
    query.position = laneOf(queries.position, i);
    query.normal = laneOf(queries.normal, i);
    query.shadingNormal = laneOf(queries.shadingNormal, i);
    query.radius = queries.radius[i];
    query.mostEdges = queries.mostEdges;
    return query;
}

/// Returns whether a group is to read all photons of the ranges.
static bool areFew(const DenseCellTrees::Range* ranges, int count)
{
    uint32_t photons = 0;
    for (int i = 0; i < count; ++i)
    {
        photons += ranges[i].end - ranges[i].begin;
        if (photons > kMostTogether) return false;
    }
    return true;
}

/// Calls together(lanes, box, ranges, count) for discs that read the same photons, alone(lane) for
/// the others.
template <class Together, class Alone>
void PhotonMap::forEachGroup(const PhotonQueryLanes& queries, const Together& together,
                             const Alone& alone) const
{
    Range ranges[kMaxRanges];
    for (LaneMask left = queries.lanes, group; left; left &= ~group)
    {
        const int first = firstLane(left);
        group = (lanesNear(queries, first) & left) | (1u << first);
        if (countLanes(group) >= kLeastGroup)
        {
            const Box box = boxOf(queries, group);
            const int count = rangesIn(box.exactLow, box.exactHigh, ranges);
            if (areFew(ranges, count))
            {
                together(group, box, ranges, count);
                continue;
            }
        }
        for (const int i : lanesIn(group))
            alone(i);
    }
}

void PhotonMap::gather(const PhotonQueryLanes& queries, PhotonSumLanes& sums) const
{
    sums = {};
    if (_count == 0) return;
    const PhotonColumns all = columns();
    forEachGroup(
        queries,
        [&](LaneMask group, const Box& box, const Range* ranges, int count)
        {
            const Discs discs = discsOf(queries, group);
            const bool flat = isFlat(queries, group);
            for (int i = 0; i < count; ++i)
                addRange(all, ranges[i].begin, ranges[i].end, box, queries, discs, flat, sums);
        },
        [&](int lane)
        {
            const PhotonSum sum = gather(laneOf(queries, lane));
            setLane(sums.power, lane, sum.power);
            sums.count[lane] = sum.count;
        });
}

void PhotonMap::find(const PhotonQueryLanes& queries, std::vector<FoundPhoton>& found) const
{
    if (_count == 0) return;
    const PhotonColumns all = columns();
    forEachGroup(
        queries,
        [&](LaneMask group, const Box& box, const Range* ranges, int count)
        {
            const Discs discs = discsOf(queries, group);
            LaneMask masks[kMostTogether / kLanes + 1];
            for (int i = 0; i < count; ++i)
            {
                photonsInBox(all, ranges[i].begin, ranges[i].end, box, masks);
                findAmong(all, ranges[i].begin, ranges[i].end, masks, queries, discs, found);
            }
        },
        [&](int lane) { findLane(queries, lane, found); });
}

void PhotonMap::find(const PhotonQueryLanes& queries, const ImageWindow& window,
                     std::vector<FoundPhoton>& found) const
{
    if (_count == 0) return;
    Range ranges[kMaxRanges];
    const Box box = boxOf(queries, queries.lanes);
    const int count = rangesIn(box.exactLow, box.exactHigh, ranges);
    if (!areFew(ranges, count)) return find(queries, found);
    const PhotonColumns all = columns();
    const Discs discs = discsOf(queries, queries.lanes);
    LaneMask masks[kMostTogether / kLanes + 1];
    for (int r = 0; r < count; ++r)
    {
        const Range range = ranges[r];
        photonsInWindow(all, range.begin, range.end, window, masks);
        findAmong(all, range.begin, range.end, masks, queries, discs, found);
    }
}

} // namespace osgRayTrace::engine
