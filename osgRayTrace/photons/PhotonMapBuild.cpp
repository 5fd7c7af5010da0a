// PhotonMapBuild.cpp - sorts photons into a grid by counting. Layer: photons.
// SPDX-License-Identifier: MIT
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

/// The sort splits the buckets into parts by their upper bits; a part fits the cache.
constexpr int kParts = 256;

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

/// A photon to be moved to its bucket.
struct Entry
{
    uint32_t bucket, photon;
};

/// Reorders the entries of dense buckets among themselves. held: photons of each bucket.
void sortDenseCells(const std::vector<Photon>& photons, const std::vector<uint32_t>& held,
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
    if (keepBins) _bin = UnclearedArray<uint32_t>(_count);
    for (int c = 0; c < kColumns; ++c)
        std::fill_n(column(static_cast<Column>(c)) + _count, kLanes, 0.0f);
    std::fill_n(&_normal[_count], kLanes, 0u);
    _first = UnclearedArray<uint32_t>(buckets + 1);
    _first[buckets] = static_cast<uint32_t>(_count);
    std::vector<std::vector<DenseCellTrees::Range>> denseCells(kParts);
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
                if (next[b - bucketBegin] > kDenseCell) denseCells[part].push_back({_first[b], at});
            }
            if (!denseCells[part].empty())
                sortDenseCells(photons, next, bucketBegin, entries.data() + partBegin[part],
                               entries.data() + partBegin[part + 1]);
            std::copy_n(_first.data() + bucketBegin, next.size(), next.begin());
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
    std::vector<DenseCellTrees::Range> all;
    for (const auto& list : denseCells)
        all.insert(all.end(), list.begin(), list.end());
    if (!all.empty()) _denseCells = DenseCellTrees(columns(), all, workers);
}

} // namespace osgRayTrace::engine
