// PhotonMapBuild.cpp - sorts photons into a grid by counting. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/base/Cpu.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/photons/PhotonColumns.h"
#include "osgRayTrace/photons/PhotonMap.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace osgRayTrace::engine
{

namespace
{

/// The sort splits the buckets into parts by their upper bits; a part fits into the cache.
constexpr int kParts = 256;

/// Photons between the one that moves and the one that is prefetched.
constexpr std::ptrdiff_t kAhead = 16;

/// Shares of the spans that one thread works on at a time, of 4096 photons at least.
struct Chunks
{
    explicit Chunks(const PhotonSpans& photons)
        : total(photons.spans()),
          count(std::min<std::size_t>(64, (total + kLeastSpans - 1) / kLeastSpans))
    {
    }
    std::size_t begin(std::size_t chunk) const { return total * chunk / count; }

    static constexpr std::size_t kLeastSpans = 4096 / kSpanPhotons;
    std::size_t total, count;
};

struct Bounds
{
    Vec3 low{kInfinity};
    Vec3 high{-kInfinity};
};

Bounds boundsOf(const PhotonSpans& photons, const Workers& workers)
{
    const Chunks chunks(photons);
    std::vector<Bounds> bounds(chunks.count);
    workers.forEach(chunks.count,
                    [&](std::size_t c)
                    {
                        Bounds b;
                        for (std::size_t s = chunks.begin(c); s < chunks.begin(c + 1); ++s)
                            for (const Photon& photon : photons.span(s))
                            {
                                b.low = glm::min(b.low, photon.position);
                                b.high = glm::max(b.high, photon.position);
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
    engine::prefetch(address);
    engine::prefetch(static_cast<const char*>(address) + bytes - 1);
}

/// A photon to be moved to its bucket.
struct Entry
{
    uint32_t bucket, photon; ///< photon: its place in the list
};

/// Reorders the entries of each dense bucket among themselves. held: number of photons of each
/// bucket.
void sortDenseCells(const PhotonSpans& photons, const std::vector<uint32_t>& held,
                    std::size_t bucketBegin, Entry* begin, Entry* end)
{
    std::unordered_map<uint32_t, std::vector<uint32_t>> denseCells;
    const auto denseCellOf = [&](const Entry& entry) -> std::vector<uint32_t>*
    { return held[entry.bucket - bucketBegin] > kDenseCell ? &denseCells[entry.bucket] : nullptr; };
    for (const Entry* entry = begin; entry != end; ++entry)
        if (std::vector<uint32_t>* denseCell = denseCellOf(*entry))
            denseCell->push_back(entry->photon);
    for (auto& [bucket, denseCell] : denseCells)
    {
        sortDenseCell(photons, denseCell);
        std::reverse(denseCell.begin(), denseCell.end());
    }
    for (Entry* entry = begin; entry != end; ++entry)
        if (std::vector<uint32_t>* denseCell = denseCellOf(*entry))
        {
            entry->photon = denseCell->back();
            denseCell->pop_back();
        }
}

} // namespace

PhotonMap::PhotonMap(const PhotonSpans& photons, float cellSize, const Workers& workers,
                     bool keepBins, PhotonMap former)
    : _count(photons.size())
{
    if (_count == 0) return;
    _first = std::move(former._first);
    _columns = std::move(former._columns);
    _normal = std::move(former._normal);
    if (keepBins) _bin = std::move(former._bin);
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

/// Holds what each step of the sort hands to the next.
struct PhotonMap::Sorting
{
    Sorting(const PhotonSpans& p, std::size_t bucketCount)
        : photons(p),
          chunks(p),
          buckets(bucketCount),
          partShift(shiftOf(bucketCount)),
          bucket(p.places()),
          offsets(chunks.count * kParts),
          partBegin(kParts + 1),
          entries(p.size())
    {
    }

    /// Buckets are a power of two.
    static int shiftOf(std::size_t bucketCount)
    {
        int shift = 0;
        while (std::size_t(kParts) << shift < bucketCount)
            ++shift;
        return shift;
    }

    const PhotonSpans& photons;
    Chunks chunks;
    std::size_t buckets;
    int partShift;                   ///< a bucket's part is the bucket shifted right by this
    UnclearedArray<uint32_t> bucket; ///< of each photon, by place
    std::vector<uint32_t> offsets;   ///< chunk, part: its photons, then where its entries go
    std::vector<uint32_t> partBegin; ///< first entry of each part, and the end of the last
    UnclearedArray<Entry> entries;   ///< part by part
};

/// Finds the bucket of each photon, and how many photons of each chunk fall into each part.
void PhotonMap::findBuckets(Sorting& s, const Workers& workers) const
{
    workers.forEach(s.chunks.count,
                    [&](std::size_t c)
                    {
                        uint32_t counts[kParts] = {};
                        for (std::size_t k = s.chunks.begin(c); k < s.chunks.begin(c + 1); ++k)
                        {
                            uint32_t* bucket = &s.bucket[k * kSpanPhotons];
                            for (const Photon& photon : s.photons.span(k))
                            {
                                const Vec3d at = (Vec3d(photon.position) - _low) * _cellsPerUnit;
                                *bucket =
                                    bucketOf(static_cast<int64_t>(at.x), static_cast<int64_t>(at.y),
                                             static_cast<int64_t>(at.z));
                                ++counts[*bucket++ >> s.partShift];
                            }
                        }
                        std::copy(counts, counts + kParts, &s.offsets[c * kParts]);
                    });
}

/// Writes the entries part by part. Each chunk writes its share of each part, so photons keep their
/// order within a part.
void PhotonMap::orderByPart(Sorting& s, const Workers& workers)
{
    uint32_t running = 0;
    for (std::size_t part = 0; part < kParts; ++part)
    {
        s.partBegin[part] = running;
        for (std::size_t c = 0; c < s.chunks.count; ++c)
        {
            const uint32_t count = s.offsets[c * kParts + part];
            s.offsets[c * kParts + part] = running;
            running += count;
        }
    }
    s.partBegin[kParts] = running;
    workers.forEach(s.chunks.count,
                    [&](std::size_t c)
                    {
                        uint32_t next[kParts];
                        std::copy_n(&s.offsets[c * kParts], kParts, next);
                        for (std::size_t span = s.chunks.begin(c); span < s.chunks.begin(c + 1);
                             ++span)
                        {
                            const auto first = static_cast<uint32_t>(span * kSpanPhotons);
                            const uint32_t end = first + s.photons.span(span).count;
                            for (uint32_t k = first; k < end; ++k)
                                s.entries[next[s.bucket[k] >> s.partShift]++] = {s.bucket[k], k};
                        }
                    });
}

/// Sorts the entries of one part by counting, and moves its photons to their columns. Returns the
/// dense cells of the part.
std::vector<PhotonMap::Range> PhotonMap::sortPart(Sorting& s, std::size_t part)
{
    const std::size_t bucketBegin = part << s.partShift;
    const std::size_t bucketEnd = (part + 1) << s.partShift;
    Entry* const begin = s.entries.data() + s.partBegin[part];
    Entry* const end = s.entries.data() + s.partBegin[part + 1];
    std::vector<uint32_t> next(bucketEnd - bucketBegin);
    for (const Entry* entry = begin; entry != end; ++entry)
        ++next[entry->bucket - bucketBegin];
    std::vector<Range> denseCells;
    uint32_t at = s.partBegin[part];
    for (std::size_t b = bucketBegin; b < bucketEnd; ++b)
    {
        _first[b] = at;
        at += next[b - bucketBegin];
        if (next[b - bucketBegin] > kDenseCell) denseCells.push_back({_first[b], at});
    }
    if (!denseCells.empty()) sortDenseCells(s.photons, next, bucketBegin, begin, end);
    std::copy_n(_first.data() + bucketBegin, next.size(), next.begin());
    for (const Entry* entry = begin; entry != end; ++entry)
    {
        // The photons of a part are scattered over the whole list.
        const Entry* const soon = entry + std::min(kAhead, end - 1 - entry);
        prefetch(&s.photons[soon->photon], sizeof(Photon));
        store(s.photons[entry->photon], next[entry->bucket - bucketBegin]++);
    }
    return denseCells;
}

OSGRAYTRACE_INLINE void PhotonMap::store(const Photon& p, uint32_t to)
{
    const float values[kColumns] = {p.position.x, p.position.y, p.position.z, p.wi.x,   p.wi.y,
                                    p.wi.z,       p.power.x,    p.power.y,    p.power.z};
    float* const columns = _columns.data();
    const std::size_t step = stride();
    for (int c = 0; c < kColumns; ++c)
        columns[static_cast<std::size_t>(c) * step + to] = values[c];
    _normal[to] =
        packNormal(p.normal) | std::min(p.edges, kMostEdges) << 24 | (p.direct ? kDirectBit : 0u);
    if (_bin.size()) _bin[to] = p.bin;
}

void PhotonMap::sort(const PhotonSpans& photons, const Workers& workers, bool keepBins)
{
    Sorting s(photons, static_cast<std::size_t>(_mask) + 1);
    findBuckets(s, workers);
    orderByPart(s, workers);

    _columns.reuse(kColumns * stride());
    _normal.reuse(stride());
    if (keepBins) _bin.reuse(_count);
    _first.reuse(s.buckets + 1);
    std::vector<std::vector<Range>> denseCells(kParts);
    workers.forEach(kParts, [&](std::size_t part) { denseCells[part] = sortPart(s, part); });
    // What lies behind the photons is written last: the first touch of each column would have the
    // system clear a huge page while all other threads wait.
    for (int c = 0; c < kColumns; ++c)
        std::fill_n(column(static_cast<Column>(c)) + _count, kLanes, 0.0f);
    std::fill_n(&_normal[_count], kLanes, 0u);
    _first[s.buckets] = static_cast<uint32_t>(_count);

    std::vector<Range> all;
    for (const auto& list : denseCells)
        all.insert(all.end(), list.begin(), list.end());
    if (!all.empty()) _denseCells = DenseCellTrees(columns(), all, workers);
}

} // namespace osgRayTrace::engine
