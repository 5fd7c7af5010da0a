// PhotonPaths.cpp - photons on their way, sixteen to a block. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonPaths.h"

#include "osgRayTrace/sampling/Sobol.h"
#include "osgRayTrace/sampling/Warp.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

OSGRAYTRACE_INLINE float largestOf(float a, float b, float c)
{
    const float ab = a > b ? a : b;
    return ab > c ? ab : c;
}

} // namespace

void PhotonPathQueue::append(const PhotonPathBlock& paths, LaneMask lanes)
{
    const auto wanted =
        static_cast<std::size_t>(_count) + static_cast<std::size_t>(countLanes(lanes));
    if (wanted > kLanes * _blocks.size()) grow();
    // Stores to blocks might change members, for all that compilers know.
    PhotonPathBlock* const blocks = _blocks.data();
    uint32_t count = _count;
    for (const int from : lanesIn(lanes))
    {
        PhotonPathBlock& block = blocks[count / kLanes];
        const int to = static_cast<int>(count % kLanes);
        ++count;
        setLane(block.origin, to, plainOf(paths.origin, from));
        setLane(block.direction, to, plainOf(paths.direction, from));
        setLane(block.power, to, plainOf(paths.power, from));
        block.photon[to] = paths.photon[from];
        block.light[to] = paths.light[from];
        block.direct[to] = paths.direct[from];
    }
    if (_flights)
    {
        count = _count;
        for (const int from : lanesIn(lanes))
        {
            blocks[count / kLanes].flight[static_cast<int>(count % kLanes)] = paths.flight[from];
            ++count;
        }
    }
    if (_media)
    {
        count = _count;
        for (const int from : lanesIn(lanes))
        {
            PhotonPathBlock& block = blocks[count / kLanes];
            const int to = static_cast<int>(count % kLanes);
            ++count;
            block.bodies[to] = paths.bodies[from];
            block.met[to] = paths.met[from];
            block.late[to] = paths.late[from];
        }
    }
    _count = count;
}

void PhotonPathQueue::grow()
{
    UnclearedArray<PhotonPathBlock> larger(std::max<std::size_t>(8, 2 * _blocks.size()));
    std::copy_n(_blocks.data(), _blocks.size(), larger.data());
    _blocks = std::move(larger);
}

void readyRays(RayHitBlock& rays)
{
    RayBlock& ray = rays.ray;
    std::fill_n(ray.tNear.v, kLanes, 0.0f);
    std::fill_n(ray.time.v, kLanes, 0.0f);
    std::fill_n(ray.mask.v, kLanes, 0xffffffffu);
    std::fill_n(ray.id.v, kLanes, 0u);
    std::fill_n(ray.flags.v, kLanes, 0u);
}

OSGRAYTRACE_KERNEL
void loadRays(const PhotonPathBlock& block, RayHitBlock& rays)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        rays.ray.originX[i] = block.origin.x[i];
        rays.ray.originY[i] = block.origin.y[i];
        rays.ray.originZ[i] = block.origin.z[i];
        rays.ray.directionX[i] = block.direction.x[i];
        rays.ray.directionY[i] = block.direction.y[i];
        rays.ray.directionZ[i] = block.direction.z[i];
        rays.ray.tFar[i] = kInfinity;
    }
}

OSGRAYTRACE_KERNEL
void photonPoints(const UintLanes& photons, uint32_t seed, FloatLanes& u, FloatLanes& v)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        float x, y;
        sobol2(photons[i], seed, x, y);
        u[i] = x;
        v[i] = y;
    }
}

OSGRAYTRACE_KERNEL
void secondPhotonPoints(const UintLanes& photons, uint32_t seed, FloatLanes& v)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        float x, y;
        sobol2(photons[i], seed, x, y);
        v[i] = y;
    }
}

namespace
{

/// Returns a cosine-distributed direction around the normal.
OSGRAYTRACE_INLINE PlainVec3 cosineDirection(PlainVec3 normal, float u, float v)
{
    return toWorld(frameOf(normal), squareToCosineHemispherePlain(u, v));
}

} // namespace

OSGRAYTRACE_KERNEL
void diffuseDirections(const Vec3Lanes& normal, const FloatLanes& u, const FloatLanes& v,
                       Vec3Lanes& wi)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        setLane(wi, i, cosineDirection(plainOf(normal, i), u[i], v[i]));
}

/// power_{k+1} of the estimator in PhotonTracer.cpp. Shading normals n other than the geometric
/// normal g are not symmetric: weights of photons are to be multiplied by
///
///   factor = |wo.n| |wi.g| / (|wo.g| |wi.n|)                     [Veach97, sect. 5.3]
///
/// Photons are absorbed if their direction is on the other side of the surface than the sample
/// meant.
OSGRAYTRACE_KERNEL
LaneMask leaveSurfaces(const SurfaceLanes& surface, const Vec3Lanes& normal,
                       const Scattered& scattered, const FloatLanes& roulette,
                       PhotonPathBlock& block)
{
    const LaneMask transmitted = scattered.transmitted, mirrored = scattered.mirrored;
    LaneMask alive = 0;
    OSGRAYTRACE_SIMD_OR(alive)
    for (int i = 0; i < kLanes; ++i)
    {
        const float dx = block.direction.x[i], dy = block.direction.y[i], dz = block.direction.z[i];
        const float gx = surface.geometricNormal.x[i], gy = surface.geometricNormal.y[i],
                    gz = surface.geometricNormal.z[i];
        const float nx = normal.x[i], ny = normal.y[i], nz = normal.z[i];
        const float wx = scattered.wi.x[i], wy = scattered.wi.y[i], wz = scattered.wi.z[i];
        const float side = wx * gx + wy * gy + wz * gz;
        const float leaving = wx * nx + wy * ny + wz * nz;
        const float correction =
            ((dx * nx + dy * ny + dz * nz) * side) / ((dx * gx + dy * gy + dz * gz) * leaving);
        const float size = std::fabs(correction);
        const float factor = select(size < kInfinity, size, 1.0f);
        const float red = scattered.weight.x[i] * factor, green = scattered.weight.y[i] * factor,
                    blue = scattered.weight.z[i] * factor;
        const float largest = largestOf(red, green, blue);
        const float survival = select(largest < 1.0f, largest, 1.0f);
        const float inverse = 1.0f / survival;
        block.power.x[i] *= red * inverse;
        block.power.y[i] *= green * inverse;
        block.power.z[i] *= blue * inverse;
        block.direction.x[i] = wx;
        block.direction.y[i] = wy;
        block.direction.z[i] = wz;
        const float offset = select(side < 0.0f, -surface.offset[i], surface.offset[i]);
        block.origin.x[i] = surface.position.x[i] + gx * offset;
        block.origin.y[i] = surface.position.y[i] + gy * offset;
        block.origin.z[i] = surface.position.z[i] + gz * offset;
        block.direct[i] &= laneBit(mirrored, i);
        const uint32_t through = laneBit(transmitted, i);
        const uint32_t meant = (maskOf(side > 0.0f) & ~through) | (maskOf(side < 0.0f) & through);
        alive |= bitOfLane(meant & maskOf(roulette[i] < survival), i);
    }
    return alive & scattered.alive;
}

} // namespace osgRayTrace::engine
