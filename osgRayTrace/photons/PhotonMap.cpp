// PhotonMap.cpp - a counting-sorted grid of photons. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonMap.h"

#include "osgRayTrace/base/Parallel.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// The sort splits the buckets into parts by their upper bits; a part fits the cache.
constexpr int kParts = 256;
constexpr uint32_t kDirectBit = 1u << 31; ///< in a packed normal

constexpr uint32_t kAhead =
    16; ///< photons between the one that moves and the one that is asked for

/// Shares of the photons that one thread works on at a time.
struct Chunks
{
    explicit Chunks(std::size_t photons)
        : total(photons), count(std::min<std::size_t>(64, (photons + 4095) / 4096))
    {
    }
    std::size_t begin(std::size_t chunk) const { return total * chunk / count; }

    std::size_t total, count;
};

struct Bounds
{
    Vec3 low{kInfinity};
    Vec3 high{-kInfinity};
};

Bounds boundsOf(const std::vector<Photon>& photons, const Workers& workers)
{
    const Chunks chunks(photons.size());
    std::vector<Bounds> bounds(chunks.count);
    workers.forEach(chunks.count,
                    [&](std::size_t c)
                    {
                        Bounds b;
                        for (std::size_t k = chunks.begin(c); k < chunks.begin(c + 1); ++k)
                        {
                            b.low = glm::min(b.low, photons[k].position);
                            b.high = glm::max(b.high, photons[k].position);
                        }
                        bounds[c] = b;
                    });
    Bounds all;
    for (const Bounds& b : bounds)
    {
        all.low = glm::min(all.low, b.low);
        all.high = glm::max(all.high, b.high);
    }
    return all;
}

OSGRAYTRACE_INLINE void prefetch(const void* address, std::size_t bytes)
{
#if defined(__GNUC__)
    __builtin_prefetch(address);
    __builtin_prefetch(static_cast<const char*>(address) + bytes - 1);
#endif
}

uint32_t packNormal(Vec3 n)
{
    // To the nearest, halves away from zero.
    const auto byte = [](float v)
    {
        const float scaled = v * 127.0f;
        return static_cast<uint32_t>(static_cast<int32_t>(scaled + std::copysign(0.5f, scaled))) &
               0xffu;
    };
    return byte(n.x) | byte(n.y) << 8 | byte(n.z) << 16;
}

OSGRAYTRACE_INLINE float byteOf(uint32_t packed, int shift)
{
    return static_cast<float>(static_cast<int32_t>(packed << (24 - shift)) >> 24) * (1.0f / 127.0f);
}

OSGRAYTRACE_INLINE int32_t edgesOf(uint32_t packed)
{
    return static_cast<int32_t>((packed >> 24) & kMostEdges);
}

/// What a loop over a block of photons reads; its own index is a signed one, as vector loads need.
struct Columns
{
    const float *x, *y, *z, *wiX, *wiY, *wiZ, *r, *g, *b;
    const uint32_t* normal;

    OSGRAYTRACE_INLINE Columns from(uint32_t k) const
    {
        return {x + k, y + k, z + k, wiX + k, wiY + k, wiZ + k, r + k, g + k, b + k, normal + k};
    }
};

/// Bit mask of photon i in the disc, all bits or none.
OSGRAYTRACE_INLINE uint32_t insideDisc(const Columns& p, int i, const PhotonQuery& q, float radius2,
                                       float planeDistance)
{
    const float dx = p.x[i] - q.position.x, dy = p.y[i] - q.position.y, dz = p.z[i] - q.position.z;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    const float off = dx * q.normal.x + dy * q.normal.y + dz * q.normal.z;
    const float side = p.wiX[i] * q.normal.x + p.wiY[i] * q.normal.y + p.wiZ[i] * q.normal.z;
    const uint32_t packed = p.normal[i];
    const float turned = byteOf(packed, 0) * q.normal.x + byteOf(packed, 8) * q.normal.y +
                         byteOf(packed, 16) * q.normal.z;
    const uint32_t shortEnough = maskOf(edgesOf(packed) <= static_cast<int32_t>(q.mostEdges));
    return maskOf(distance2 <= radius2) & maskOf(std::fabs(off) <= planeDistance) &
           maskOf(side > 0.0f) & maskOf(turned >= kLeastNormalCosine) & shortEnough;
}

/// Sums by lane, so that the result does not depend on the vector width of the machine.
struct LaneSums
{
    FloatLanes r, g, b;
    UintLanes count;
};

/// Where the shading normal is the geometric one every weight is 1.
template <bool kFlat>
OSGRAYTRACE_INLINE void addBlocks(const Columns& columns, uint32_t begin, uint32_t end,
                                  const PhotonQuery& query, float radius2, float planeDistance,
                                  LaneSums& sums)
{
    const PhotonQuery q = query;
    LaneSums s = sums;
    for (uint32_t block = begin; block < end; block += kLanes)
    {
        const Columns p = columns.from(block);
        const int left = static_cast<int>(end - block);
        OSGRAYTRACE_SIMD
        for (int i = 0; i < kLanes; ++i)
        {
            const uint32_t in = insideDisc(p, i, q, radius2, planeDistance) & maskOf(i < left);
            float weight = select(in, 1.0f, 0.0f);
            if (!kFlat)
            {
                const float geometric =
                    p.wiX[i] * q.normal.x + p.wiY[i] * q.normal.y + p.wiZ[i] * q.normal.z;
                const float shading = p.wiX[i] * q.shadingNormal.x + p.wiY[i] * q.shadingNormal.y +
                                      p.wiZ[i] * q.shadingNormal.z;
                weight = select(in & maskOf(shading > 0.0f), shading / geometric, 0.0f);
            }
            s.r[i] += weight * p.r[i];
            s.g[i] += weight * p.g[i];
            s.b[i] += weight * p.b[i];
            s.count[i] += in & 1u;
        }
    }
    sums = s;
}

OSGRAYTRACE_KERNEL
void addRange(const Columns& columns, uint32_t begin, uint32_t end, const PhotonQuery& query,
              float radius2, float planeDistance, LaneSums& sums)
{
    if (query.shadingNormal == query.normal)
        addBlocks<true>(columns, begin, end, query, radius2, planeDistance, sums);
    else
        addBlocks<false>(columns, begin, end, query, radius2, planeDistance, sums);
}

OSGRAYTRACE_KERNEL
LaneMask insideLanes(const Columns& columns, uint32_t block, uint32_t end, const PhotonQuery& query,
                     float radius2, float planeDistance)
{
    const Columns p = columns.from(block);
    const PhotonQuery q = query;
    const int left = static_cast<int>(end - block);
    LaneMask inside = 0;
    OSGRAYTRACE_SIMD_OR(inside)
    for (int i = 0; i < kLanes; ++i)
        inside |= bitOfLane(insideDisc(p, i, q, radius2, planeDistance) & maskOf(i < left), i);
    return inside;
}

float sumOf(const FloatLanes& lanes)
{
    // Always the same tree of additions.
    float sums[kLanes];
    std::copy(lanes.v, lanes.v + kLanes, sums);
    for (int width = kLanes / 2; width > 0; width /= 2)
        for (int i = 0; i < width; ++i)
            sums[i] += sums[i + width];
    return sums[0];
}

} // namespace

uint32_t PhotonMap::bucketOf(int64_t x, int64_t y, int64_t z) const
{
    const uint64_t line = static_cast<uint64_t>(y) * 0x9e3779b97f4a7c15ull ^
                          static_cast<uint64_t>(z) * 0xc2b2ae3d27d4eb4full;
    return static_cast<uint32_t>((line >> 24) + static_cast<uint64_t>(x)) & _mask;
}

PhotonMap::PhotonMap(const std::vector<Photon>& photons, float cellSize, const Workers& workers,
                     bool keepBins)
    : _count(photons.size())
{
    if (photons.empty()) return;
    const Bounds bounds = boundsOf(photons, workers);
    _low = Vec3d(bounds.low);
    _high = Vec3d(bounds.high);
    // Coordinates of cells stay exact integers in double, whatever the caller asks for.
    const double extent = std::max({_high.x - _low.x, _high.y - _low.y, _high.z - _low.z});
    const double cell = std::max(static_cast<double>(cellSize), extent * 0x1p-40);
    _cellsPerUnit = cell > 0.0 && std::isfinite(cell) ? 1.0 / cell : 0.0;

    uint32_t buckets = kParts;
    while (buckets < _count && buckets < (1u << 30))
        buckets *= 2;
    _mask = buckets - 1;
    sort(photons, workers, keepBins);
}

void PhotonMap::sort(const std::vector<Photon>& photons, const Workers& workers, bool keepBins)
{
    const std::size_t buckets = static_cast<std::size_t>(_mask) + 1;
    const int partShift = __builtin_ctzll(buckets) - __builtin_ctz(kParts);

    // 1. The bucket of each photon, and how many of each chunk fall into each part.
    const Chunks chunks(_count);
    UnclearedArray<uint32_t> bucket(_count);
    std::vector<uint32_t> offsets(chunks.count * kParts);
    workers.forEach(chunks.count,
                    [&](std::size_t c)
                    {
                        uint32_t counts[kParts] = {};
                        for (std::size_t k = chunks.begin(c); k < chunks.begin(c + 1); ++k)
                        {
                            const Vec3d at = (Vec3d(photons[k].position) - _low) * _cellsPerUnit;
                            bucket[k] =
                                bucketOf(static_cast<int64_t>(at.x), static_cast<int64_t>(at.y),
                                         static_cast<int64_t>(at.z));
                            ++counts[bucket[k] >> partShift];
                        }
                        std::copy(counts, counts + kParts, &offsets[c * kParts]);
                    });

    // 2. Where each chunk writes its share of each part; photons keep their order.
    std::vector<uint32_t> partBegin(kParts + 1);
    uint32_t running = 0;
    for (std::size_t part = 0; part < kParts; ++part)
    {
        partBegin[part] = running;
        for (std::size_t c = 0; c < chunks.count; ++c)
        {
            const uint32_t count = offsets[c * kParts + part];
            offsets[c * kParts + part] = running;
            running += count;
        }
    }
    partBegin[kParts] = running;

    struct Entry
    {
        uint32_t bucket, photon;
    };
    UnclearedArray<Entry> entries(_count);
    workers.forEach(
        chunks.count,
        [&](std::size_t c)
        {
            uint32_t next[kParts];
            std::copy_n(&offsets[c * kParts], kParts, next);
            for (std::size_t k = chunks.begin(c); k < chunks.begin(c + 1); ++k)
                entries[next[bucket[k] >> partShift]++] = {bucket[k], static_cast<uint32_t>(k)};
        });

    // 3. Each part by counting; its photons move once, to where they stay.
    _columns = UnclearedArray<float>(kColumns * stride());
    _normal = UnclearedArray<uint32_t>(stride());
    for (int c = 0; c < kColumns; ++c)
        std::fill_n(column(static_cast<Column>(c)) + _count, kLanes, 0.0f);
    std::fill_n(&_normal[_count], kLanes, 0u);
    if (keepBins) _bin = UnclearedArray<uint32_t>(_count);
    _first = UnclearedArray<uint32_t>(buckets + 1);
    _first[buckets] = static_cast<uint32_t>(_count);
    workers.forEach(
        kParts,
        [&](std::size_t part)
        {
            const std::size_t bucketBegin = part << partShift;
            const std::size_t bucketEnd = (part + 1) << partShift;
            std::vector<uint32_t> next(bucketEnd - bucketBegin);
            for (uint32_t e = partBegin[part]; e < partBegin[part + 1]; ++e)
                ++next[entries[e].bucket - bucketBegin];
            uint32_t at = partBegin[part];
            for (std::size_t b = bucketBegin; b < bucketEnd; ++b)
            {
                _first[b] = at;
                at += next[b - bucketBegin];
                next[b - bucketBegin] = _first[b];
            }
            float* const columns = _columns.data();
            const std::size_t step = stride();
            for (uint32_t e = partBegin[part]; e < partBegin[part + 1]; ++e)
            {
                // Photons of a part come from all over.
                const Photon* soon =
                    &photons[entries[std::min(e + kAhead, partBegin[part + 1] - 1)].photon];
                prefetch(soon, sizeof(Photon));
                const uint32_t to = next[entries[e].bucket - bucketBegin]++;
                const Photon& p = photons[entries[e].photon];
                const float values[kColumns] = {p.position.x, p.position.y, p.position.z,
                                                p.wi.x,       p.wi.y,       p.wi.z,
                                                p.power.x,    p.power.y,    p.power.z};
                for (int c = 0; c < kColumns; ++c)
                    columns[static_cast<std::size_t>(c) * step + to] = values[c];
                _normal[to] = packNormal(p.normal) | std::min(p.edges, kMostEdges) << 24 |
                              (p.direct ? kDirectBit : 0u);
                if (keepBins) _bin[to] = p.bin;
            }
        });
}

std::size_t PhotonMap::bytes() const
{
    return _columns.size() * sizeof(float) + (_normal.size() + _bin.size() + _first.size()) * sizeof(uint32_t);
}

/// The stretches of photons that can be in the disc, none of them twice. One line of cells along x
/// is one stretch, or two where the table ends within it.
int PhotonMap::rangesOf(const PhotonQuery& query, Range* ranges) const
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
    const Vec3d low = centre - reach, high = centre + reach;
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

    struct Line
    {
        uint32_t first, last; ///< buckets, first <= last
    };
    Line found[kMaxRanges];
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
    // Lines that share a bucket by chance become one: no photon is seen twice.
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

PhotonSum PhotonMap::gather(const PhotonQuery& query) const
{
    Range ranges[kMaxRanges];
    const int count = rangesOf(query, ranges);
    PhotonSum sum;
    if (count == 0) return sum;
    const Columns columns{column(X),   column(Y),   column(Z),     column(WiX),  column(WiY),
                          column(WiZ), column(Red), column(Green), column(Blue), _normal.data()};
    LaneSums sums = {};
    for (int i = 0; i < count; ++i)
        addRange(columns, ranges[i].begin, ranges[i].end, query, query.radius * query.radius,
                 query.radius * kPlaneShare, sums);
    for (int i = 0; i < kLanes; ++i)
        sum.count += sums.count[i];
    if (sum.count) sum.power = Vec3(sumOf(sums.r), sumOf(sums.g), sumOf(sums.b));
    return sum;
}

void PhotonMap::find(const PhotonQuery& query, std::vector<uint32_t>& found) const
{
    Range ranges[kMaxRanges];
    const int count = rangesOf(query, ranges);
    const Columns columns{column(X),   column(Y),   column(Z),     column(WiX),  column(WiY),
                          column(WiZ), column(Red), column(Green), column(Blue), _normal.data()};
    for (int i = 0; i < count; ++i)
        for (uint32_t block = ranges[i].begin; block < ranges[i].end; block += kLanes)
            for (LaneMask lanes =
                     insideLanes(columns, block, ranges[i].end, query, query.radius * query.radius,
                                 query.radius * kPlaneShare);
                 lanes; lanes &= lanes - 1)
                found.push_back(block + static_cast<uint32_t>(__builtin_ctz(lanes)));
}

Photon PhotonMap::photon(uint32_t k) const
{
    Photon p;
    p.position = Vec3(column(X)[k], column(Y)[k], column(Z)[k]);
    p.wi = Vec3(column(WiX)[k], column(WiY)[k], column(WiZ)[k]);
    p.power = Vec3(column(Red)[k], column(Green)[k], column(Blue)[k]);
    p.direct = (_normal[k] & kDirectBit) != 0;
    p.normal = Vec3(byteOf(_normal[k], 0), byteOf(_normal[k], 8), byteOf(_normal[k], 16));
    p.edges = static_cast<uint32_t>(edgesOf(_normal[k]));
    if (_bin.size()) p.bin = _bin[k];
    return p;
}

} // namespace osgRayTrace::engine
