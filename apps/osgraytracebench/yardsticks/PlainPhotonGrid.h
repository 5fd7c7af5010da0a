// PlainPhotonGrid.h - photons in hashed cells: the yardstick of look-ups. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/photons/PhotonMap.h"

#include <vector>

namespace osgRayTrace::bench
{

/// Holds photons in the way that one writes first, and well: as structures, sorted by the hash of
/// their cell with a counting sort, one after the other. A look-up walks through the cells that its
/// sphere's box touches and tests photon by photon, distance first. It tests what PhotonMap tests,
/// so that both count the same photons; power is added up as it is, without PhotonMap's ratio of
/// cosines, which is less work.
class PlainPhotonGrid
{
public:
    /// Sorts the photons. Any cell size is right; one or two radii are fast.
    PlainPhotonGrid(const std::vector<engine::Photon>& photons, float cellSize);

    engine::PhotonSum gather(const engine::PhotonQuery& query) const;

private:
    uint32_t bucketOf(int x, int y, int z) const;
    engine::PhotonSum gatherFrom(const engine::PhotonQuery& query) const;

    engine::Vec3 _low{0.0f};
    float _cellsPerUnit = 0.0f;
    uint32_t _mask = 0;
    std::vector<uint32_t> _first; ///< first photon of each bucket, and one more
    std::vector<engine::Photon> _photons;
};

} // namespace osgRayTrace::bench
