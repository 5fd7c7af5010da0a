// PhotonFlights.cpp - photons on their way, sixteen to a block. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/PhotonFlights.h"

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

void FlightQueue::append(const Flight& flight)
{
    FlightBlock& block = _blocks[_count / kLanes];
    const int i = static_cast<int>(_count % kLanes);
    ++_count;
    block.origin.x[i] = flight.origin.x;
    block.origin.y[i] = flight.origin.y;
    block.origin.z[i] = flight.origin.z;
    block.direction.x[i] = flight.direction.x;
    block.direction.y[i] = flight.direction.y;
    block.direction.z[i] = flight.direction.z;
    block.power.x[i] = flight.power.x;
    block.power.y[i] = flight.power.y;
    block.power.z[i] = flight.power.z;
    block.photon[i] = flight.photon;
    block.light[i] = flight.light;
    block.direct[i] = flight.direct ? 1u : 0u;
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
void loadRays(const FlightBlock& block, RayHitBlock& rays)
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

/// Directions are cosine-distributed around the shading normal n: the weight is the albedo times
///
///   |wo.n| |wi.g| / (|wo.g| |wi.n|)                              [Veach97, sect. 5.3]
///
/// g the geometric normal: light carries the other cosine than radiance where normals are
/// interpolated. A photon survives with the largest of its weights, so survivors keep their power
/// as far as they can.
OSGRAYTRACE_KERNEL
void scatterDiffuse(const FlightBlock& block, const SurfaceLanes& surface, const Vec3Lanes& albedo,
                    const FloatLanes& u, const FloatLanes& v, const FloatLanes& roulette,
                    DiffuseFlights& scattered)
{
    LaneMask alive = 0;
    OSGRAYTRACE_SIMD_OR(alive)
    for (int i = 0; i < kLanes; ++i)
    {
        const float dx = block.direction.x[i], dy = block.direction.y[i], dz = block.direction.z[i];
        const float gx = surface.geometricNormal.x[i], gy = surface.geometricNormal.y[i],
                    gz = surface.geometricNormal.z[i];
        float nx = surface.shadingNormal.x[i], ny = surface.shadingNormal.y[i],
              nz = surface.shadingNormal.z[i];
        const float turn = select(nx * gx + ny * gy + nz * gz < 0.0f, -1.0f, 1.0f);
        const uint32_t faces = maskOf((nx * dx + ny * dy + nz * dz) * turn < -1e-4f);
        nx = select(faces, nx * turn, gx);
        ny = select(faces, ny * turn, gy);
        nz = select(faces, nz * turn, gz);

        float sine, cosine;
        sinCosTurn(u[i], sine, cosine);
        const float radius = std::sqrt(v[i]);
        const float lx = radius * cosine, ly = radius * sine;
        const float lz = std::sqrt(1.0f - v[i]);
        const float sign = nz >= 0.0f ? 1.0f : -1.0f;
        const float a = -1.0f / (sign + nz);
        const float b = nx * ny * a;
        const float wx = (1.0f + sign * nx * nx * a) * lx + b * ly + nx * lz;
        const float wy = sign * b * lx + (sign + ny * ny * a) * ly + ny * lz;
        const float wz = -sign * nx * lx - ny * ly + nz * lz;

        const float side = wx * gx + wy * gy + wz * gz;
        const float incoming = std::fabs(dx * nx + dy * ny + dz * nz);
        const float correction = (incoming * side) / (std::fabs(dx * gx + dy * gy + dz * gz) * lz);
        const float factor = select(correction < kInfinity, correction, 1.0f);
        const float red = albedo.x[i] * factor, green = albedo.y[i] * factor,
                    blue = albedo.z[i] * factor;
        const float largest = largestOf(red, green, blue);
        const float survival = select(largest < 1.0f, largest, 1.0f);
        const float inverse = 1.0f / survival;
        scattered.power.x[i] = block.power.x[i] * red * inverse;
        scattered.power.y[i] = block.power.y[i] * green * inverse;
        scattered.power.z[i] = block.power.z[i] * blue * inverse;
        scattered.direction.x[i] = wx;
        scattered.direction.y[i] = wy;
        scattered.direction.z[i] = wz;
        scattered.origin.x[i] = surface.position.x[i] + gx * surface.offset[i];
        scattered.origin.y[i] = surface.position.y[i] + gy * surface.offset[i];
        scattered.origin.z[i] = surface.position.z[i] + gz * surface.offset[i];
        alive |=
            bitOfLane(maskOf(side > 0.0f) & maskOf(lz > 0.0f) & maskOf(roulette[i] < survival), i);
    }
    scattered.alive = alive;
}

} // namespace osgRayTrace::engine
