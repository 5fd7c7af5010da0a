// PointMap.h - photons at their collisions with dense media, and look-ups around points. Layer:
// photons.
// SPDX-License-Identifier: MIT
//
// The photons that have collided within a sphere of radius r are an estimate of the radiance that a
// medium scatters [Jensen98, the volume photon map]:
//
//   L = sigmaS sum over photons of power p(cosTheta) / (4/3 pi r^3)
//
// Where the boundary of the medium cuts the sphere, photons within the ball alone would be too few,
// by up to half, and deeper ones brighter. Near a boundary at the depth d the kernel is therefore
// (A + B u) / r^3, u the distance from the sphere's middle away from the boundary over r, with A
// and B such that the kernel's integral over what is left of the ball is 1 and its first moment 0
// [Jones93, sect. 3]: with m_k the integrals of u^k over the part of the unit ball with u > -d/r
// and, in thin slabs, u less than the distance to the face on the other side over r,
//
//   A = m2 / (m0 m2 - m1^2)    B = -m1 / (m0 m2 - m1^2)
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
    Vec3 inwards{0.0f};       ///< unit normal of the medium's nearest boundary, to the position
    float depth = kInfinity;  ///< distance to the plane of that
    float beyond = kInfinity; ///< distance to a plane on the other side, which is about parallel
    Phase phase;              ///< of the medium
    MediumId medium = kOutside;
    uint32_t mostEdges = 0; ///< photons of longer paths are left out
};

/// Holds a kernel over a ball that one or two planes cut: constant + slope u at the distance u from
/// the middle, away from the plane, in units of the radius. The integral over the unit ball is 1.
struct CutBall
{
    float constant, slope;
};

/// Returns the kernel of a ball whose middle is so far from the plane, and so far from the one on
/// the other side, which is not nearer, in units of the radius. Only one of both may be 0.
CutBall cutBall(float depth, float beyond);

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
