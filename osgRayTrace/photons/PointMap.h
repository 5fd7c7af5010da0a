// PointMap.h - photons at their collisions with dense media, and look-ups around points. Layer:
// photons.
// SPDX-License-Identifier: MIT
//
// The photons that have collided within a sphere of radius r are an estimate of the radiance that a
// medium scatters [Jensen98, the volume photon map]:
//
//   L = sigmaS sum over photons of power p(cosTheta) / (4/3 pi r^3)
//
// A photon's power is that with which it comes to its collision, over the extinction: power of a
// flight over its density, so that the sum over photons is the fluence. In volumes, tentative
// collisions count as well, with the majorant in place of the extinction.
#pragma once

#include "osgRayTrace/media/GridRay.h"
#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/photons/BoxTree.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds a photon at a collision.
struct PhotonPoint
{
    Vec3 position{0.0f};
    Vec3 direction{0.0f}; ///< unit, the way of the light before the collision
    Vec3 power{0.0f};     ///< [W length], already divided by the number of emitted photons
    MediumId medium = kOutside;
    uint32_t edges = 0; ///< edges of the path from the light to the collision
};

/// Holds a sphere that photons are looked for in.
struct PointQuery
{
    Vec3 position{0.0f};
    Vec3 towards{0.0f}; ///< unit, in which the light goes on
    float radius = 0.0f;
    Phase phase; ///< of the medium
    MediumId medium = kOutside;
    uint32_t mostEdges = 0; ///< photons of longer paths are left out
};

/// Immutable once built; thread safe.
class PointMap
{
public:
    PointMap() = default;
    explicit PointMap(const std::vector<PhotonPoint>& points);

    std::size_t size() const { return _points.size(); }
    std::size_t bytes() const { return _points.size() * sizeof(PhotonPoint) + _tree.bytes(); }

    /// Returns the scattered radiance over sigmaS, along the query's direction.
    Vec3 gather(const PointQuery& query) const;

    /// Returns the radiance that is scattered along the query's direction by what is at its
    /// position. The query's phase function does not count.
    Vec3 gather(const PointQuery& query, const Scatterers& here) const;

private:
    template <class Scattered> Vec3 sumOf(const PointQuery& query, const Scattered& of) const;

    std::vector<PhotonPoint> _points; ///< in the order of the tree
    BoxTree _tree;
};

} // namespace osgRayTrace::engine
