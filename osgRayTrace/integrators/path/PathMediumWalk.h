// PathMediumWalk.h - the walk of a block of paths through media. Layer: integrators; private to it.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Bodies.h"
#include "osgRayTrace/integrators/path/PathMedium.h"
#include "osgRayTrace/integrators/shared/SegmentLights.h"
#include "osgRayTrace/integrators/shared/VolumeLightChoice.h"

#include <memory>
#include <optional>

namespace osgRayTrace::engine
{

struct PointQuery;

/// Takes the paths of a block to the surfaces that they meet next. A walk is of one thread.
class MediumWalk
{
public:
    MediumWalk(Tile& tile, PathBlock& block, int number, bool last, PhotonUse use)
        : _tile(tile),
          _block(block),
          _traced(*tile.context.traced),
          _media(_traced.media()),
          _number(number),
          _last(last),
          _use(use),
          _collides(number + 1 < tile.context.options.maxBounces),
          _causticsAlone(_traced.traits().volumes),
          _open(block.active)
    {
        if (_traced.traits().volumes)
        {
            _grids = std::make_unique<GridLanes>();
            _segments.grids = _grids.get();
            if (_traced.grids().isLit()) _light = volumeLight(tile.context);
        }
        for (int i = 0; i < kLanes; ++i)
        {
            _begin[i] = 0.0f;
            _collisions[i] = 0;
        }
    }

    LaneMask run();

private:
    enum class End
    {
        Surface, ///< the path has come to a surface, or leaves the scene
        GoesOn,  ///< the path has a new ray, or goes on along its ray
        Dies,
    };

    void findSegments(int step);
    void findGrids(int i, Vec3 origin, float end);
    void addLight();
    void addPhotonBeams(int step);
    void addPhotonPoints(int i, float distance, Vec3 throughput, const Scatterers* here = nullptr);
    void findBoundary(int i, float distance, PointQuery& query);
    PathFlags flagsAfterCollision(int i) const;
    End travel(int i);
    End travelGrids(int i, const GridRay& grids);
    End collide(int i, float distance);
    End scatterInGrids(int i, const GridRay& grids, float distance);
    bool survives(int i, Vec3 throughput);
    End meet(int i);
    bool passBoundary(int i, End& end);
    void spawn(int i, const RayBegin& begin, Vec3 direction);
    void trace(LaneMask lanes);

    /// Returns whether another body fills both sides of the surface of a body.
    bool isDisplaced(int i, MediumId body) const
    {
        return _media.nests() && _media.at(bodiesBehind(_block.bodies[i], body, isFront(i))) ==
                                     _media.at(_block.bodies[i]);
    }

    bool hasHit(int i) const { return (_surface.hits >> i) & 1u; }
    bool isFront(int i) const { return (_surface.front >> i) & 1u; }
    MediumId bodyAt(int i) const
    {
        return hasHit(i) ? _media.interiorOf(_surface.material[i]) : kOutside;
    }

    Tile& _tile;
    PathBlock& _block;
    const TracedScene& _traced;
    const MediumTable& _media;
    const int _number;
    const bool _last;     ///< rays find emission alone
    const PhotonUse _use; ///< of the photons that rays look up
    const bool _collides; ///< paths have an edge left for light behind a collision
    /// Photons within media have met mirror-like surfaces alone: collisions find other light.
    const bool _causticsAlone;
    LaneMask _open, _collided = 0;
    FloatLanes _begin; ///< where on the ray the stretch begins
    uint32_t _collisions[kLanes];
    SurfaceLanes _surface;
    MediumSegments _segments;
    FloatLanes _flights, _survivals;   ///< numbers of free flights and of Russian roulette
    std::unique_ptr<GridLanes> _grids; ///< null: the scene has no volumes
    std::optional<VolumeLight> _light; ///< nothing: no volume is lit
};

} // namespace osgRayTrace::engine
