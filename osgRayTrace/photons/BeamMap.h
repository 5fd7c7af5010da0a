// BeamMap.h - photon beams of one pass, and the light that they scatter towards rays. Layer:
// photons.
// SPDX-License-Identifier: MIT
//
// A beam is the way of a photon through a medium. Where it passes a ray within the radius r, the
// medium scatters its light towards the ray [Jarosz11, beams and a kernel of one dimension]:
//
//   L += power sigmaS p(cosTheta) T_ray(t_ray) T_beam(t_beam) / (2 r sinTheta)
//
// t_ray and t_beam are where ray and beam are nearest to each other; both places must be within
// ray and beam. The kernel has one dimension, along the perpendicular of both.
#pragma once

#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/media/MediumTable.h"
#include "osgRayTrace/photons/BoxTree.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds the straight way of a photon through a medium, up to the next surface or to where next to
/// nothing of it is left. Its power does not depend on where the photon has collided. On a way with
/// volumes there are several, each with another power: see ChunkGrids.cpp.
struct PhotonBeam
{
    Vec3 origin{0.0f};
    Vec3 direction{0.0f}; ///< unit, the way of the light
    float begin = 0.0f;   ///< of the beam, from the origin on
    float length = 0.0f;  ///< to the beam's end, from the origin on
    Vec3 power{0.0f};     ///< [W] at the origin, already divided by the number of beams' photons
    MediumId medium = kOutside;
    uint32_t edges = 0; ///< edges of the path from the light to a collision on the beam
};

/// Holds a piece of a beam: pieces have small boxes.
struct alignas(64) BeamPiece
{
    PlainVec3 origin, direction; ///< of the beam
    float begin, end;            ///< of the piece, along the beam
    PlainVec3 power;             ///< of the beam at its origin
    int32_t medium, edges;
};

/// Holds rays that keep near an axis: at the distance t along the axis they are no farther from it
/// than radius + slope t. They begin behind begin and end before end.
struct RayBundle
{
    Vec3 origin{0.0f}, axis{0.0f, 0.0f, 1.0f}; ///< axis: unit
    float begin = 0.0f, end = kInfinity;
    float radius = 0.0f, slope = 0.0f;
};

/// Holds pieces of beams, for tests of sixteen at a time.
class BeamPieces
{
public:
    std::size_t size() const { return _pieces.size(); }
    std::size_t bytes() const
    {
        return _pieces.size() * sizeof(BeamPiece) + _ends.size() * sizeof(Ends);
    }
    const BeamPiece& operator[](std::size_t k) const { return _pieces[k]; }

    void clear();
    void add(const BeamPiece& piece);

    /// Returns which of the pieces from first on, a multiple of kLanes, may come within a distance
    /// of some ray of a bundle.
    LaneMask near(std::size_t first, const RayBundle& bundle, float distance) const;

private:
    /// Holds where sixteen pieces begin and end.
    struct Ends
    {
        Vec3Lanes begin, end;
    };

    std::vector<BeamPiece> _pieces;
    std::vector<Ends> _ends; ///< of sixteen pieces each
};

/// Returns a bundle that holds the rays of lanes, from tNear of 0 to infinity.
RayBundle bundleOf(const RayBlock* const* blocks, const LaneMask* lanes, int count);

/// Holds sixteen rays through media.
struct BeamQuery
{
    const RayBlock* ray = nullptr;
    FloatLanes begin, end; ///< of the ray's stretch; power is attenuated from begin on
    Vec3Lanes sigmaT, sigmaS;
    FloatLanes anisotropy;
    FloatLanes draineG, draineAlpha, draineShare; ///< of Phase; read if hasDroplets
    bool hasDroplets = false;
    const MediumTable* thinning = nullptr; ///< null: no lane is in a medium that thins out
    UintLanes medium;
    LaneMask lanes = 0;     ///< the values of other lanes are not read
    uint32_t mostEdges = 0; ///< beams of longer paths are left out
    float radius = 0.0f;
    float leastSine = 1e-3f; ///< beams along the ray count as if they met it at this sine
};

/// Immutable once built; thread safe.
class BeamMap
{
public:
    BeamMap() = default;

    /// pieceLength: beams are cut into pieces no longer than that.
    BeamMap(const std::vector<PhotonBeam>& beams, float pieceLength);

    std::size_t size() const { return _beams; } ///< number of beams
    std::size_t bytes() const { return _pieces.bytes() + _tree.bytes(); }

    /// Replaces found by all pieces that may come within a distance of some ray of a bundle.
    void find(const RayBundle& bundle, float distance, BeamPieces& found) const;

private:
    std::size_t _beams = 0;
    BeamPieces _pieces; ///< in the order of the tree
    BoxTree _tree;
};

/// Sets radiance to what the pieces scatter towards the rays. bundle: holds the rays.
void gatherBeams(const BeamPieces& pieces, const RayBundle& bundle, const BeamQuery& query,
                 Vec3Lanes& radiance);

/// Returns the distance from a line to the count-th nearest of the beams; infinity if fewer beams
/// pass it. Only places count at which the line is nearest to a beam within the beam.
float distanceToBeams(const std::vector<PhotonBeam>& beams, Vec3 point, Vec3 direction,
                      std::size_t count);

} // namespace osgRayTrace::engine
