// PathScatter.cpp - where paths go next, and which end. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/shading/SmoothLanes.h"

#include <algorithm>
#include <cstdlib>

namespace osgRayTrace::engine
{

namespace
{

/// Throughput from which on paths are ended by chance. Light that comes after many bounces adds
/// most of the noise where this is 1, and costs more than it is worth below 0.3: measured on the
/// Cornell box, where 0.33 to 0.5 are equally good.
constexpr float kRouletteThroughput = 0.4f;

/// Next directions of diffuse lanes: vector code. Weight is the albedo, pdfW = cos/pi. Returns the
/// lanes whose direction is one that light comes from: see isAbove.
OSGRAYTRACE_KERNEL
LaneMask diffuseDirections(const Vec3Lanes& normal, const SurfaceLanes& surface,
                           const FloatLanes& u, const FloatLanes& v, Vec3Lanes& wi,
                           Vec3Lanes& origin, FloatLanes& tNear, FloatLanes& pdfW)
{
    const LaneMask terminatorLanes = surface.terminatorLanes;
    LaneMask alive = 0;
    OSGRAYTRACE_SIMD_OR(alive)
    for (int i = 0; i < kLanes; ++i)
    {
        const float nx = normal.x[i], ny = normal.y[i], nz = normal.z[i];
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
        const float gx = surface.geometricNormal.x[i], gy = surface.geometricNormal.y[i],
                    gz = surface.geometricNormal.z[i];
        wi.x[i] = wx;
        wi.y[i] = wy;
        wi.z[i] = wz;
        pdfW[i] = lz * kInvPi;
        const float above = wx * gx + wy * gy + wz * gz;
        const bool steep = above > surface.minCosine[i];
        const float offset = select(steep, 0.0f, surface.offset[i]);
        origin.x[i] = surface.position.x[i] + gx * offset;
        origin.y[i] = surface.position.y[i] + gy * offset;
        origin.z[i] = surface.position.z[i] + gz * offset;
        tNear[i] = select(steep, surface.offset[i] / std::max(above, surface.minCosine[i]), 0.0f);
        const uint32_t leaves = maskOf(above > 0.0f) | laneBit(terminatorLanes, i);
        alive |= bitOfLane(leaves & maskOf(lz > 0.0f), i);
    }
    return alive;
}

/// The lanes at smooth interfaces; returns those that go on.
LaneMask mirror(PathBlock& block, const Bounce& bounce, const FloatLanes& lobe, Vec3Lanes& wi,
                Vec3Lanes& origin, FloatLanes& tNear, Vec3Lanes& weight, FloatLanes& pdfW)
{
    if (!bounce.smooth) return 0;
    InterfaceLanes interfaces;
    for (const int i : lanesIn(bounce.smooth))
        interfaces.set(i, bounce.bsdfs[i]);
    const RayBlock& ray = block.rays.ray;
    const IncidentLanes incident{ray.directionX, ray.directionY, ray.directionZ, bounce.normal};
    const SmoothLanes sampled = sampleSmoothLanes(interfaces, incident, lobe, bounce.smooth,
                                                  Transport::Radiance, wi, weight);
    LaneMask alive = 0;
    for (const int i : lanesIn(sampled.alive))
    {
        const bool transmitted = (sampled.transmitted >> i) & 1u;
        const Vec3 direction = laneOf(wi, i);
        if (isAboveFacet(bounce.surface, i, direction) == transmitted) continue;
        const RayBegin begin = leaveFacet(bounce.surface, i, direction);
        setLane(origin, i, begin.origin);
        tNear[i] = begin.tNear;
        pdfW[i] = kInfinity;
        if (transmitted) block.etaScale[i] *= bounce.bsdfs[i].eta * bounce.bsdfs[i].eta;
        alive |= 1u << i;
    }
    return alive;
}

/// Throughput of the next ray, and the probability that there is one. Returns the lanes where it is
/// not 0.
OSGRAYTRACE_KERNEL
LaneMask weigh(const PathBlock& block, const Vec3Lanes& weight, Vec3Lanes& throughput,
               FloatLanes& survival)
{
    LaneMask positive = 0;
    OSGRAYTRACE_SIMD_OR(positive)
    for (int i = 0; i < kLanes; ++i)
    {
        const float x = block.throughput.x[i] * weight.x[i];
        const float y = block.throughput.y[i] * weight.y[i];
        const float z = block.throughput.z[i] * weight.z[i];
        const float xy = select(x > y, x, y);
        const float largest = select(xy > z, xy, z);
        const float wanted = largest * block.etaScale[i] * (1.0f / kRouletteThroughput);
        throughput.x[i] = x;
        throughput.y[i] = y;
        throughput.z[i] = z;
        survival[i] = select(wanted < 1.0f, wanted, 1.0f);
        positive |= bitOfLane(maskOf(largest > 0.0f), i);
    }
    return positive;
}

OSGRAYTRACE_KERNEL
LaneMask lanesBelowOne(const FloatLanes& survival)
{
    LaneMask below = 0;
    OSGRAYTRACE_SIMD_OR(below)
    for (int i = 0; i < kLanes; ++i)
        below |= bitOfLane(maskOf(survival[i] < 1.0f), i);
    return below;
}

/// The lanes that go on.
OSGRAYTRACE_KERNEL
LaneMask playRoulette(const FloatLanes& roulette, const FloatLanes& survival, Vec3Lanes& throughput)
{
    LaneMask survivors = 0;
    OSGRAYTRACE_SIMD_OR(survivors)
    for (int i = 0; i < kLanes; ++i)
    {
        const float q = survival[i];
        throughput.x[i] /= q;
        throughput.y[i] /= q;
        throughput.z[i] /= q;
        survivors |= bitOfLane(maskOf(roulette[i] < q), i);
    }
    return survivors;
}

/// Sets the rays of all lanes, whether they go on or not.
OSGRAYTRACE_KERNEL
void spawnRays(PathBlock& block, const Vec3Lanes& origin, const FloatLanes& tNear,
               const Vec3Lanes& wi, const Vec3Lanes& throughput, const FloatLanes& pdfW,
               LaneMask gathering, LaneMask rough)
{
    RayBlock& ray = block.rays.ray;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        ray.originX[i] = origin.x[i];
        ray.originY[i] = origin.y[i];
        ray.originZ[i] = origin.z[i];
        ray.tNear[i] = tNear[i];
        ray.directionX[i] = wi.x[i];
        ray.directionY[i] = wi.y[i];
        ray.directionZ[i] = wi.z[i];
        block.throughput.x[i] = throughput.x[i];
        block.throughput.y[i] = throughput.y[i];
        block.throughput.z[i] = throughput.z[i];
        block.pdfW[i] = pdfW[i];

        block.flags[i] = PathFlags::afterSurface(block.flags[i], laneBit(gathering, i),
                                                 laneBit(rough, i), maskOf(!(pdfW[i] < kInfinity)));
    }
}

} // namespace

void scatter(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    FloatLanes u, v, lobe, roulette;
    const uint32_t pass = tile.context.pathKey.index;
    const auto lobeAndRoulette = [&]
    {
        dimensionPoints(block.seed, pass, bounceDimension(bounce.number, DimensionBsdfLobe), lobe,
                        roulette);
    };
    dimensionPoints(block.seed, pass, bounceDimension(bounce.number, DimensionBsdfDirection), u, v);
    if (bounce.general) lobeAndRoulette();

    Vec3Lanes wi, origin;
    FloatLanes tNear, pdfW;
    Vec3Lanes weight = bounce.albedo;
    LaneMask alive =
        diffuseDirections(bounce.normal, bounce.surface, u, v, wi, origin, tNear, pdfW) &
        bounce.diffuse & ~bounce.terminating;
    alive |= mirror(block, bounce, lobe, wi, origin, tNear, weight, pdfW);
    for (const int i : lanesIn(bounce.general & ~bounce.smooth))
    {
        const ShadingFrame frame(laneOf(bounce.normal, i));
        const Vec3 wo = frame.toLocal(-directionOf(block.rays.ray, i));
        const std::optional<BsdfSample> sample =
            sampleBsdf(bounce.bsdfs[i], wo, lobe[i], u[i], v[i]);
        if (!sample || (!sample->delta && ((bounce.terminating >> i) & 1u))) continue;
        const Vec3 direction = frame.toWorld(sample->wi);
        const SurfaceLanes& surface = bounce.surface;
        const bool above =
            sample->delta ? isAboveFacet(surface, i, direction) : isAbove(surface, i, direction);
        if (above == sample->transmitted) continue;
        setLane(wi, i, direction);
        const RayBegin begin =
            sample->delta ? leaveFacet(surface, i, direction) : leave(surface, i, direction);
        setLane(origin, i, begin.origin);
        tNear[i] = begin.tNear;
        setLane(weight, i, sample->weight);
        pdfW[i] = sample->delta ? kInfinity : sample->pdfW;
        if (sample->transmitted) block.etaScale[i] *= bounce.bsdfs[i].eta * bounce.bsdfs[i].eta;
        alive |= 1u << i;
    }

    Vec3Lanes throughput;
    FloatLanes survival;
    block.active = weigh(block, weight, throughput, survival) & alive;
    if (bounce.number + 1 >= kRouletteBounce && (lanesBelowOne(survival) & block.active))
    {
        if (!bounce.general) lobeAndRoulette();
        block.active &= playRoulette(roulette, survival, throughput);
    }
    spawnRays(block, origin, tNear, wi, throughput, pdfW, bounce.gathering, bounce.rough);
}

} // namespace osgRayTrace::engine
