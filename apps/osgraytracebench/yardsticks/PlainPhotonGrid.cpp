// PlainPhotonGrid.cpp - sorts photons by hashes of cells, and looks them up. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/osgraytracebench/yardsticks/PlainPhotonGrid.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kMostCells = 27;

int cellOf(float distance, float cellsPerUnit)
{
    return static_cast<int>(std::floor(distance * cellsPerUnit));
}

} // namespace

/// Returns the bucket of a cell [Teschner03, sect. 3.1].
uint32_t PlainPhotonGrid::bucketOf(int x, int y, int z) const
{
    return (static_cast<uint32_t>(x) * 73856093u ^ static_cast<uint32_t>(y) * 19349663u ^
            static_cast<uint32_t>(z) * 83492791u) &
           _mask;
}

PlainPhotonGrid::PlainPhotonGrid(const std::vector<Photon>& photons, float cellSize)
    : _cellsPerUnit(1.0f / cellSize)
{
    if (photons.empty()) return;
    _low = photons[0].position;
    for (const Photon& p : photons)
        _low = glm::min(_low, p.position);
    uint32_t buckets = 1;
    while (buckets < photons.size())
        buckets *= 2;
    _mask = buckets - 1;

    std::vector<uint32_t> bucket(photons.size());
    _first.assign(buckets + 1, 0);
    for (std::size_t k = 0; k < photons.size(); ++k)
    {
        const Vec3 at = photons[k].position - _low;
        bucket[k] = bucketOf(cellOf(at.x, _cellsPerUnit), cellOf(at.y, _cellsPerUnit),
                             cellOf(at.z, _cellsPerUnit));
        ++_first[bucket[k]];
    }
    uint32_t end = 0;
    for (uint32_t& first : _first)
        first = end += first;
    _photons.resize(photons.size());
    for (std::size_t k = photons.size(); k-- > 0;)
        _photons[--_first[bucket[k]]] = photons[k];
}

OSGRAYTRACE_KERNEL
PhotonSum PlainPhotonGrid::gatherFrom(const PhotonQuery& query) const
{
    const PhotonQuery q = query;
    const Vec3 at = q.position - _low;
    const int x0 = cellOf(at.x - q.radius, _cellsPerUnit),
              x1 = cellOf(at.x + q.radius, _cellsPerUnit);
    const int y0 = cellOf(at.y - q.radius, _cellsPerUnit),
              y1 = cellOf(at.y + q.radius, _cellsPerUnit);
    const int z0 = cellOf(at.z - q.radius, _cellsPerUnit),
              z1 = cellOf(at.z + q.radius, _cellsPerUnit);
    const float radius2 = q.radius * q.radius, planeDistance = q.radius * kPlaneShare,
                gapDistance = gapTolerance(q.position, q.radius);

    PhotonSum sum;
    uint32_t visited[kMostCells];
    int cells = 0;
    for (int z = z0; z <= z1; ++z)
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x)
            {
                const uint32_t bucket = bucketOf(x, y, z);
                uint32_t k = _first[bucket];
                const uint32_t end = _first[bucket + 1];
                if (k == end) continue;
                // Several cells may share a bucket, which is visited once.
                bool again = false;
                for (int i = 0; i < cells; ++i)
                    again |= visited[i] == bucket;
                if (again) continue;
                visited[cells++] = bucket;
                for (; k < end; ++k)
                {
                    const Photon& p = _photons[k];
                    const Vec3 d = p.position - q.position;
                    if (!(glm::dot(d, d) <= radius2)) continue;
                    const float off = std::fabs(glm::dot(d, q.normal));
                    if (!(off <= planeDistance)) continue;
                    if (!(glm::dot(p.wi, q.normal) > 0.0f)) continue;
                    const float cosine = glm::dot(p.normal, q.normal), gap = off - gapDistance;
                    if (!(cosine >= kLeastNormalCosine)) continue;
                    if (gap > 0.0f && gap * gap > glm::dot(d, d) * (1.0f - cosine * cosine))
                        continue;
                    sum.power += p.power;
                    ++sum.count;
                }
            }
    return sum;
}

// Before version 18, Clang gives the versions of a function a name that no other file knows.
PhotonSum PlainPhotonGrid::gather(const PhotonQuery& query) const
{
    return gatherFrom(query);
}

} // namespace osgRayTrace::bench
