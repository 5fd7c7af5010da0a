// GridRay.h - a ray through volumes: free flights, transmittance and what scatters. Layer: media.
// SPDX-License-Identifier: MIT
//
// Volumes have no closed form of transmittance. With a majorant m that nothing along a ray exceeds,
// light meets tentative collisions with the density m exp(-m t), each of which is real with the
// probability sigma / m and null otherwise [Woodcock65; Miller19, sect. 3]. The majorant is that of
// the 8^3 voxels around, block by block, so that empty parts cost one step.
//
// Three channels share the tentative collisions. F is the product of what each channel does at
// them: sigma_c / m at the real one, 1 - sigma_c / m at null ones. One channel is chosen with the
// probability p_c and decides what each collision is, and the sample has the weight of the balance
// heuristic over the channels, F_c / sum of p F [Miller19, sect. 5].
#pragma once

#include "osgRayTrace/media/MediumWay.h"
#include "osgRayTrace/media/VolumeLighting.h"
#include "osgRayTrace/sampling/Hash.h"

#include <array>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// Independent numbers in [0,1), of which a way through a volume takes as many as it needs.
class NumberStream
{
public:
    explicit NumberStream(uint32_t seed) : _seed(seed) {}
    float next() { return unitFloat(hash(_seed + 0x9e3779b9u * ++_count)); }

private:
    uint32_t _seed, _count = 0;
};

/// The number of tentative collisions after which a way through volumes ends: light that goes on is
/// lost. They are more than 65 000 mean free paths of the densest block.
constexpr int kMostTentative = 65536;

/// Makes a part end where the ray enters and leaves the unit cube of a space, whose faces are moved
/// outwards by margin [length of the ray's space], inwards if it is below 0.
void clipToCube(const Affine& cubeFromEngine, Vec3 origin, Vec3 direction, RayPart& part,
                float margin = 0.0f);

/// The part of a ray within a volume.
struct GridSpan
{
    uint32_t grid = 0;
    RayPart part;
};

/// What scatters at a point, with coefficients [1/engine unit].
struct Scatterers
{
    std::array<Vec3, kMostVolumes + 1> sigmaS;
    std::array<Phase, kMostVolumes + 1> phases;
    int count = 0;

    void add(Vec3 sigma, const Phase& phase)
    {
        if (sigma == Vec3(0.0f)) return;
        sigmaS[static_cast<std::size_t>(count)] = sigma;
        phases[static_cast<std::size_t>(count++)] = phase;
    }

    /// Returns the sum of sigmaS times phase function [1/(sr length)].
    Vec3 scattered(float cosTheta) const;
    /// Returns the density with which sample() chooses a direction [1/sr].
    float pdf(float cosTheta) const;
    /// Returns the direction in which light goes on. choice, u, v in [0,1).
    Vec3 sample(Vec3 direction, float choice, float u, float v) const;
};

/// Where light collides, or that it does not.
struct GridFlight
{
    bool collides = false;
    bool cut = false;      ///< ended by kMostTentative
    float distance = 0.0f; ///< along the ray
    Vec3 weight{0.0f};     ///< transmittance over density [length], or over probability
    Vec3 emitted{0.0f};    ///< radiance that was emitted on the way
};

/// A tentative collision of a flight. The sum of weight f(distance) over those of a flight is an
/// estimate of the integral of transmittance f over the ray.
struct TentativeCollision
{
    float distance = 0.0f; ///< along the ray
    Vec3 weight{0.0f};     ///< [length]
};

/// What is left of light on a way, and what was added to it.
struct GridWay
{
    Vec3 left{1.0f};
    Vec3 emitted{0.0f};
    bool cut = false; ///< ended by kMostTentative
};

/// Which volumes a ray looks at.
enum class GridKinds
{
    All,
    Densities, ///< those of VolumeLaw::Density
};

/// A part of a ray on which an estimate of the transmittance from some place on is constant.
struct EvenPart
{
    RayPart part;
    Vec3 left{1.0f};
};

/// A stretch of a ray with all volumes on it, and the homogeneous medium around them.
class GridRay
{
public:
    /// The ray has a unit direction. What is beyond begin and end does not count.
    GridRay(const GridTable& table, Vec3 origin, Vec3 direction, float begin, float end,
            GridKinds kinds = GridKinds::All);

    /// Adds the homogeneous medium that fills a part of the ray.
    void setAround(const MediumRecord& medium, RayPart part);

    /// Has flights that tell their tentative collisions make some of them wherever a part of the
    /// ray is nearer than reach to the cube of a volume that scatters [length], also where nothing
    /// is. If the medium around is thin and scatters, each volume counts: call setAround before.
    void setReach(float reach, RayPart part);

    /// Has the colours of volumes that are lit be lit by a light. Without it they are as they are.
    void setLight(const VolumeLight& light);

    /// Returns whether no volume is on the ray.
    bool isEmpty() const { return _count == 0; }
    /// Returns whether a part of the ray is within the reach of setReach.
    bool isReached() const { return !_reached.isEmpty(); }
    /// Returns a part that holds all that is within the reach of setReach.
    RayPart reached() const { return _reached; }
    /// Returns whether a place on the ray is within the box of a volume.
    bool isWithin(float distance) const;
    /// Returns the first part behind a distance that the medium around fills and no volume's box
    /// holds; empty if there is none.
    RayPart partBetween(float distance) const;
    /// Returns the part of the ray that anything fills, or that is within reach.
    RayPart extent() const { return _extent; }
    bool scatters() const;
    int count() const { return _count; }
    const GridSpan& span(int i) const { return _spans[static_cast<std::size_t>(i)]; }
    const GridTable& table() const { return *_table; }

    /// Returns where light that travels along the ray collides. pmf: probabilities of the channels.
    /// tentative: gets the tentative collisions, in order, the real one as the last, and some of
    /// them in the medium around and within reach where next to nothing collides; may be null.
    GridFlight flight(Vec3 pmf, NumberStream& numbers,
                      std::vector<TentativeCollision>* tentative = nullptr) const;

    /// Returns what is left of light at the end, and what was emitted, without an end by chance
    /// [ratio tracking: Novak14, eq. 8].
    GridWay way(NumberStream& numbers) const;

    /// Returns an estimate of the transmittance from begin to end, with the least extinction of
    /// each block in closed form [residual ratio tracking: Novak14, eq. 11].
    Vec3 transmittance(float begin, float end, NumberStream& numbers) const;

    /// Appends the parts of whole in order, each with an estimate of what is left of light from
    /// whole's begin on [ratio tracking: Novak14, eq. 8]; expected values are the transmittance.
    /// What is within a volume's box by more than margin [length], or behind where nothing is left,
    /// is in no part.
    void evenParts(RayPart whole, float margin, NumberStream& numbers,
                   std::vector<EvenPart>& parts) const;

    /// Returns what scatters at a distance along the ray.
    Scatterers scatterersAt(float distance) const;

private:
    struct Coefficients
    {
        Vec3 sigmaT{0.0f}, emission{0.0f};
    };
    class Pieces;

    void trackRatio(RayPart part, NumberStream& numbers, Vec3& left,
                    std::vector<EvenPart>& parts) const;
    Vec3 pointAt(float distance) const { return _origin + _direction * distance; }
    Coefficients at(float distance, bool withEmission) const;

    const GridTable* _table;
    Vec3 _origin, _direction;
    std::array<GridSpan, kMostVolumes> _spans;
    std::array<Vec3, kMostVolumes> _extinctions; ///< at an amount of 1
    std::array<Vec3, kMostVolumes> _litDirections;
    bool _isLit = false; ///< whether the latter are set
    int _count = 0;
    const MediumRecord* _around = nullptr;
    MediumWay _aroundWay; ///< along _aroundPart
    RayPart _aroundPart, _reached, _extent;
};

} // namespace osgRayTrace::engine
