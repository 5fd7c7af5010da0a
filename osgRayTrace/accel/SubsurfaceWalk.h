// SubsurfaceWalk.h - the way of light within a body with a diffuse boundary. Layer: accel.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/RayBlock.h"
#include "osgRayTrace/accel/TracedScene.h"

namespace osgRayTrace::engine
{

/// The number of collisions, and of turns below metal, after which a walk below a surface ends.
/// What it still carried is lost.
constexpr uint32_t kMostSubsurfaceCollisions = 10000;

/// Returns 1 for the channels in which light can walk below a surface, 0 for those in which its
/// mean way is lost in the rounding of points there. offset: SurfaceLanes::offset of the point.
Vec3 walkingChannels(Vec3 sigma, float offset);

/// Holds light that has come through a diffuse boundary, from the front of its triangle.
struct SubsurfaceEntry
{
    Vec3 position;   ///< on the triangle [engine space]
    Vec3 normal;     ///< of the triangle, unit, outwards
    float offset;    ///< SurfaceLanes::offset
    Vec3 sigma;      ///< extinction [1/engine unit]
    Vec3 color;      ///< that a thick body has
    Vec3 throughput; ///< of the path or power of the photon; 0 in channels that do not walk
    float least;     ///< largest component of the throughput below which roulette may end the walk
    uint32_t key;    ///< two walks with the same key have the same random numbers
    Vec2 direction;  ///< uniform in [0,1)^2: of the first direction
};

struct SubsurfaceWalk
{
    enum class End : uint8_t
    {
        Left,     ///< it has come to the inner side of a diffuse boundary
        Absorbed, ///< roulette has ended it
        Open,     ///< it has left the mesh through a hole
        Cut,      ///< it has had kMostSubsurfaceCollisions
    };
    End end = End::Absorbed;
    Vec3 throughput{0.0f};    ///< at the end
    Vec3 position, direction; ///< End::Left: the place where it leaves, and its way to there
    Hit hit;                  ///< End::Left: the surface at that place
    uint32_t collisions = 0, rays = 0;
};

/// Takes light from its entry to the place where it leaves the body. Surfaces of other materials
/// within the body are not there, unless they have diffuse boundaries, too: a body may have
/// several such materials, and bodies that overlap are one. Thread safe.
SubsurfaceWalk walkBelow(const TracedScene& traced, const SubsurfaceEntry& entry);

/// Sets lane i of rays to a ray that has come to the place where a walk leaves, from outside and
/// against the way of the walk: what is known of its hit is what a path meets from there on.
void meetFromOutside(const SubsurfaceWalk& walk, RayHitBlock& rays, int i);

} // namespace osgRayTrace::engine
