// PhotonOpenings.h - small openings that photons are sent through. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"

#include <vector>

namespace osgRayTrace::engine
{

/// A sphere in a small opening, which light that views see crosses.
struct PhotonOpening
{
    Vec3 centre{0.0f};   ///< in engine space
    float radius = 0.0f; ///< [engine units]
    Vec3 axis{0.0f};     ///< the way that this light crosses the sphere, unit
    float weight = 1.0f; ///< density of children that are sent there, over that of others
};

/// Holds openings, and sends photons through them. A photon that a matt surface scatters goes on as
/// the surface wants, and children may leave it through the openings that lie before the surface:
/// the photon is split. Both are samples of the same light, so both are weighted by the balance
/// heuristic for several samples of each technique [Veach97, eq. 9.8]. With n children in the mean,
///
///   weight(wi) = pdfW / (pdfW + n pdfW_openings),    pdfW = cosTheta / pi
///
/// where pdfW_openings is uniform over each of the cones that hold the openings, in proportion to
/// their weights, and n is in proportion to the weighted flux that crosses them if nothing is in
/// the way. So all children through openings of a weight have about the same power. Transport of
/// neutrons knows such spheres as DXTRAN [Booth85]. Openings never change.
class PhotonOpenings
{
public:
    /// childrenPerFlux: expected number of children of a photon at a surface, over its power times
    /// the share of it that a white surface sends towards the openings.
    PhotonOpenings(std::vector<PhotonOpening> openings, float childrenPerFlux);

    const std::vector<PhotonOpening>& openings() const { return _openings; }
    float childrenPerFlux() const { return _childrenPerFlux; }

    /// Holds points on surfaces, and what they see of the openings.
    struct Views
    {
        Vec3Lanes position, normal; ///< normal: unit
        FloatLanes solidAngle;      ///< sum over the openings in front, times their weights [sr]
        FloatLanes flux; ///< share of the reflected light towards each, times weights, summed up
        FloatLanes children; ///< number of children in the mean, 1 at most
        LaneMask lanes = 0;  ///< lanes that see openings
    };

    /// Sets what the positions and normals of some lanes see. power: luminance of the photon's
    /// power times the number of photons of the pass. Numbers of all lanes must be finite.
    void look(const FloatLanes& power, LaneMask lanes, Views& views) const;

    /// Samples directions through openings, from numbers in [0,1), in lanes of views.lanes. chosen:
    /// the weights of the openings.
    void sample(const Views& views, const FloatLanes& choice, const FloatLanes& u,
                const FloatLanes& v, LaneMask lanes, Vec3Lanes& wi, FloatLanes& chosen) const;

    /// Sets the weights of directions, 1 where no opening is met. least: of the openings that a
    /// direction is known to meet, the sum of their weights.
    void weigh(const Views& views, const Vec3Lanes& wi, const FloatLanes& least,
               FloatLanes& weights) const;

private:
    std::vector<PhotonOpening> _openings;
    float _childrenPerFlux;
};

} // namespace osgRayTrace::engine
