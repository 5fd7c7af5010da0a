// PhotonMap.cpp - the photons around a point: look-ups in a counting-sorted grid. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonMap.h"

#include "osgRayTrace/base/Kernel.h"
#include "osgRayTrace/photons/PhotonColumns.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Sums by lane, so that the result does not depend on the machine's vector width.
struct LaneSums
{
    FloatLanes r, g, b;
    UintLanes count;
};

/// A look-up as its loops over photons take it.
struct PlainQuery
{
    explicit PlainQuery(const PhotonQuery& q)
        : disc{plainOf(q.position),
               plainOf(q.normal),
               q.radius * q.radius,
               q.radius * kPlaneShare,
               gapTolerance(q.position, q.radius),
               static_cast<int32_t>(q.mostEdges)},
          shadingNormal(plainOf(q.shadingNormal)),
          flat(q.shadingNormal == q.normal)
    {
    }
    PlainDisc disc;
    PlainVec3 shadingNormal;
    bool flat; ///< the shading normal is the geometric one: every weight is 1
};

template <bool kFlat>
OSGRAYTRACE_INLINE void addBlocks(const PhotonColumns& columns, uint32_t begin, uint32_t end,
                                  const PlainQuery& query, LaneSums& sums)
{
    const PlainDisc disc = query.disc;
    const PlainVec3 shading = query.shadingNormal;
    LaneSums s = sums;
    for (uint32_t block = begin; block < end; block += kLanes)
    {
        const PhotonColumns p = columns.from(block);
        const int left = static_cast<int>(end - block);
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
        {
            const uint32_t in = insideDisc(p, i, disc).in & maskOf(i < left);
            const float weight =
                kFlat ? select(in, 1.0f, 0.0f) : shadingWeight(p, i, in, disc.normal, shading);
            s.r[i] += weight * p.r[i];
            s.g[i] += weight * p.g[i];
            s.b[i] += weight * p.b[i];
            s.count[i] += in & 1u;
        }
    }
    sums = s;
}

OSGRAYTRACE_KERNEL
void addRange(const PhotonColumns& columns, uint32_t begin, uint32_t end, const PlainQuery& query,
              LaneSums& sums)
{
    if (query.flat)
        addBlocks<true>(columns, begin, end, query, sums);
    else
        addBlocks<false>(columns, begin, end, query, sums);
}

/// Where sixteen photons are in a disc: see DiscTest.
struct DiscPlaces
{
    FloatLanes distance2, off, tilt2;
};

/// Returns the square of the least radius with which a look-up finds photon i. rounding: the part
/// of gapTolerance that is not of the radius.
float leastRadius2(const DiscPlaces& places, int i, float rounding)
{
    const float distance2 = places.distance2[i], off = places.off[i];
    const float tilted = std::sqrt(distance2 * std::max(places.tilt2[i], 0.0f));
    // Rounding of the square root must not make the radius larger.
    const float gap = (off - rounding - tilted) * ((1.0f - 0x1p-18f) / kGapShare);
    const float plane = std::max(off / kPlaneShare, gap);
    return std::max(distance2, plane * plane);
}

/// Returns which of sixteen photons are in the disc, and where.
OSGRAYTRACE_KERNEL
LaneMask insideLanes(const PhotonColumns& columns, uint32_t block, uint32_t end,
                     const PlainQuery& query, DiscPlaces& places)
{
    const PhotonColumns p = columns.from(block);
    const PlainDisc disc = query.disc;
    const int left = static_cast<int>(end - block);
    LaneMask inside = 0;
    OSGRAYTRACE_SIMD_OR(inside)
    for (int i = 0; i < kLanes; ++i)
    {
        const DiscTest test = insideDisc(p, i, disc);
        places.distance2[i] = test.distance2;
        places.off[i] = test.off;
        places.tilt2[i] = test.tilt2;
        inside |= bitOfLane(test.in & maskOf(i < left), i);
    }
    return inside;
}

float sumOf(const FloatLanes& lanes)
{
    // The tree of additions is always the same.
    float sums[kLanes];
    std::copy(lanes.v, lanes.v + kLanes, sums);
    for (int width = kLanes / 2; width > 0; width /= 2)
        for (int i = 0; i < width; ++i)
            sums[i] += sums[i + width];
    return sums[0];
}

} // namespace

std::size_t PhotonMap::bytes() const
{
    return _columns.capacity() * sizeof(float) +
           (_normal.capacity() + _bin.capacity() + _first.capacity()) * sizeof(uint32_t) +
           _denseCells.bytes();
}

/// Neighbouring buckets that a line of cells along x is hashed to.
struct PhotonMap::BucketLine
{
    uint32_t first, last; ///< first <= last
};

/// Finds the ranges of photons that can be in the disc, in ascending order, none of them twice.
/// flatten: a call of rangesIn would be a twentieth of a look-up.
OSGRAYTRACE_FLATTEN int PhotonMap::rangesOf(const PhotonQuery& query, Range* ranges) const
{
    if (_count == 0 || !(query.radius >= 0.0f)) return 0;
    const Vec3d centre(query.position);
    // The disc of the plane test is thin: its box is smaller than the sphere's. Distances are
    // rounded, hence the millionth part more.
    const Vec3d n(query.normal);
    const Vec3d across(std::sqrt(n.y * n.y + n.z * n.z), std::sqrt(n.z * n.z + n.x * n.x),
                       std::sqrt(n.x * n.x + n.y * n.y));
    const Vec3d share =
        glm::min(across + glm::abs(n) * static_cast<double>(kPlaneShare), Vec3d(1.0));
    const Vec3d reach = (share + 0x1p-20) * static_cast<double>(query.radius);
    return rangesIn(centre - reach, centre + reach, ranges);
}

/// Finds the ranges of the cells that a box touches. One line of cells along x is one range, or two
/// if the table ends within the line.
int PhotonMap::rangesIn(Vec3d low, Vec3d high, Range* ranges) const
{
    if (!(glm::all(glm::lessThanEqual(low, _high)) && glm::all(glm::greaterThanEqual(high, _low))))
        return 0;
    const Vec3d from = (glm::max(low, _low) - _low) * _cellsPerUnit;
    const Vec3d to = (glm::min(high, _high) - _low) * _cellsPerUnit;
    const auto x0 = static_cast<int64_t>(from.x), x1 = static_cast<int64_t>(to.x);
    const auto y0 = static_cast<int64_t>(from.y), y1 = static_cast<int64_t>(to.y);
    const auto z0 = static_cast<int64_t>(from.z), z1 = static_cast<int64_t>(to.z);
    const uint64_t lines =
        (static_cast<uint64_t>(y1 - y0) + 1) * (static_cast<uint64_t>(z1 - z0) + 1);
    const uint64_t length = static_cast<uint64_t>(x1 - x0) + 1;
    const auto everything = [&]
    {
        ranges[0] = {0, static_cast<uint32_t>(_count)};
        return 1;
    };
    if (static_cast<uint64_t>(y1 - y0) >= kMaxRanges || lines > kMaxRanges / 2 || length > _mask)
        return everything();

    BucketLine found[kMaxRanges];
    int count = 0;
    for (int64_t z = z0; z <= z1; ++z)
        for (int64_t y = y0; y <= y1; ++y)
        {
            const uint32_t first = bucketOf(x0, y, z);
            const uint32_t last = static_cast<uint32_t>(first + length - 1) & _mask;
            // Most lines in space meet no surface.
            if (first <= last)
            {
                if (_first[first] < _first[last + 1]) found[count++] = {first, last};
                continue;
            }
            if (_first[first] < _count) found[count++] = {first, _mask};
            if (0 < _first[last + 1]) found[count++] = {0, last};
        }
    return rangesOfLines(found, count, ranges);
}

/// Returns the photons of lines, sorted. Lines that share a bucket by chance become one, so no
/// photon is read twice.
int PhotonMap::rangesOfLines(BucketLine* found, int count, Range* ranges) const
{
    for (int i = 1; i < count; ++i)
        for (int k = i; k > 0 && found[k].first < found[k - 1].first; --k)
            std::swap(found[k], found[k - 1]);
    if (count == 0) return 0;
    int merged = 0;
    for (int i = 1; i < count; ++i)
    {
        if (found[i].first <= found[merged].last)
            found[merged].last = std::max(found[merged].last, found[i].last);
        else
            found[++merged] = found[i];
    }
    int used = 0;
    for (int i = 0; i <= merged; ++i)
    {
        const Range range{_first[found[i].first], _first[found[i].last + 1]};
        if (range.begin < range.end) ranges[used++] = range;
    }
    return used;
}

PhotonColumns PhotonMap::columns() const
{
    return {column(X),   column(Y),   column(Z),     column(WiX),  column(WiY),
            column(WiZ), column(Red), column(Green), column(Blue), _normal.data()};
}

PhotonSum PhotonMap::gather(const PhotonQuery& query) const
{
    Range ranges[kMaxRanges];
    const int count = rangesOf(query, ranges);
    PhotonSum sum;
    if (count == 0) return sum;
    const PhotonColumns all = columns();
    const PlainQuery plain(query);
    LaneSums sums = {};
    DenseCellTrees::Visit dense;
    for (int i = 0; i < count; ++i)
    {
        const Range range = ranges[i];
        if (isDense(range))
            _denseCells.visit(query, range, plain.flat, dense);
        else
            addRange(all, range.begin, range.end, plain, sums);
    }
    for (const Range& range : dense.read)
        addRange(all, range.begin, range.end, plain, sums);
    for (int i = 0; i < kLanes; ++i)
        sum.count += sums.count[i];
    if (sum.count) sum.power = Vec3(sumOf(sums.r), sumOf(sums.g), sumOf(sums.b));
    if (dense.count)
    {
        sum.count += dense.count;
        sum.power = Vec3(Vec3d(sum.power) + dense.power);
    }
    return sum;
}

/// Calls add(block, lanes, places) for the photons of the disc, until it returns false.
template <class Add> void PhotonMap::forEachFound(const PhotonQuery& query, const Add& add) const
{
    Range ranges[kMaxRanges];
    const int count = rangesOf(query, ranges);
    const PhotonColumns all = columns();
    const PlainQuery plain(query);
    DiscPlaces places;
    const auto read = [&](Range range)
    {
        for (uint32_t block = range.begin; block < range.end; block += kLanes)
        {
            const LaneMask lanes = insideLanes(all, block, range.end, plain, places);
            if (lanes && !add(block, lanes, places)) return false;
        }
        return true;
    };
    DenseCellTrees::Visit dense;
    for (int i = 0; i < count; ++i)
    {
        if (isDense(ranges[i]))
            _denseCells.visit(query, ranges[i], false, dense);
        else if (!read(ranges[i]))
            return;
    }
    for (const Range& range : dense.read)
        if (!read(range)) return;
}

void PhotonMap::find(const PhotonQuery& query, std::vector<uint32_t>& found) const
{
    forEachFound(query,
                 [&](uint32_t block, LaneMask lanes, const DiscPlaces&)
                 {
                     for (const int i : lanesIn(lanes))
                         found.push_back(block + static_cast<uint32_t>(i));
                     return true;
                 });
}

/// Appends the photons of one lane's disc to those that sixteen look-ups have found.
void PhotonMap::findLane(const PhotonQueryLanes& queries, int lane,
                         std::vector<FoundPhoton>& found) const
{
    forEachFound(laneOf(queries, lane),
                 [&](uint32_t block, LaneMask photons, const DiscPlaces&)
                 {
                     for (const int i : lanesIn(photons))
                         found.push_back({block + static_cast<uint32_t>(i), 1u << lane});
                     return true;
                 });
}

bool PhotonMap::findDistances(const PhotonQuery& query, std::size_t most,
                              NeighbourDistances& distances) const
{
    std::vector<float>& radii2 = distances._radius2;
    radii2.clear();
    const float rounding = gapTolerance(query.position, 0.0f);
    forEachFound(query,
                 [&](uint32_t, LaneMask lanes, const DiscPlaces& places)
                 {
                     for (const int i : lanesIn(lanes))
                         radii2.push_back(leastRadius2(places, i, rounding));
                     return radii2.size() <= most;
                 });
    return radii2.size() <= most;
}

float NeighbourDistances::radiusOfNearest(std::size_t count)
{
    if (size() <= count) return kInfinity;
    const auto next = _radius2.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(_radius2.begin(), next, _radius2.end());
    return std::sqrt(*next) * (1.0f - 0x1p-21f); // so that the square of it, rounded, is less
}

std::size_t PhotonMap::work(const PhotonQuery& query) const
{
    Range ranges[kMaxRanges];
    const int count = rangesOf(query, ranges);
    DenseCellTrees::Visit dense;
    std::size_t sum = 0;
    for (int i = 0; i < count; ++i)
    {
        if (isDense(ranges[i]))
            _denseCells.visit(query, ranges[i], query.shadingNormal == query.normal, dense);
        else
            sum += ranges[i].end - ranges[i].begin;
    }
    for (const Range& range : dense.read)
        sum += range.end - range.begin;
    return sum;
}

Photon PhotonMap::photon(uint32_t k) const
{
    Photon p;
    p.position = position(k);
    p.wi = Vec3(column(WiX)[k], column(WiY)[k], column(WiZ)[k]);
    p.power = Vec3(column(Red)[k], column(Green)[k], column(Blue)[k]);
    p.direct = (_normal[k] & kDirectBit) != 0;
    p.normal = unpackNormal(_normal[k]);
    p.edges = static_cast<uint32_t>(edgesOf(_normal[k]));
    if (_bin.size()) p.bin = _bin[k];
    return p;
}

} // namespace osgRayTrace::engine
