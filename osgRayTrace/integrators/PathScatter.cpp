// PathScatter.cpp - where paths go next, and which end. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/HitShading.h"
#include "osgRayTrace/integrators/PathBounce.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kRouletteBounce = 3; ///< paths are not ended by chance before this bounce

/// Next directions of diffuse lanes: vector code. Weight is the albedo, pdfW = cos/pi. Returns the
/// lanes whose direction is one that light comes from: see isAbove.
OSGRAYTRACE_KERNEL
LaneMask diffuseDirections(const Vec3Lanes& normal, const SurfaceLanes& surface,
                           const FloatLanes& u, const FloatLanes& v, Vec3Lanes& wi,
                           Vec3Lanes& origin, FloatLanes& pdfW)
{
    const LaneMask lifted = surface.lifted;
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
        origin.x[i] = surface.position.x[i] + gx * surface.offset[i];
        origin.y[i] = surface.position.y[i] + gy * surface.offset[i];
        origin.z[i] = surface.position.z[i] + gz * surface.offset[i];
        const uint32_t above = maskOf(wx * gx + wy * gy + wz * gz > 0.0f) | laneBit(lifted, i);
        alive |= bitOfLane(above & maskOf(lz > 0.0f), i);
    }
    return alive;
}

} // namespace

void scatter(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    FloatLanes u, v, lobe, roulette;
    const uint32_t pass = tile.context.pathKey.index;
    dimensionPoints(block.seed, pass, bounceDimension(bounce.number, DimensionBsdfDirection), u, v);
    dimensionPoints(block.seed, pass, bounceDimension(bounce.number, DimensionBsdfLobe), lobe,
                    roulette);

    Vec3Lanes wi, origin;
    FloatLanes pdfW;
    Vec3Lanes weight = bounce.albedo;
    LaneMask alive = 0;
    if (const LaneMask diffuse = bounce.diffuse & ~bounce.ending)
        alive = diffuseDirections(bounce.normal, bounce.surface, u, v, wi, origin, pdfW) & diffuse;
    for (LaneMask lanes = bounce.general; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const ShadingFrame frame(laneOf(bounce.normal, i));
        const Vec3 wo =
            frame.toLocal(-Vec3(block.rays.ray.directionX[i], block.rays.ray.directionY[i],
                                block.rays.ray.directionZ[i]));
        const std::optional<BsdfSample> sample =
            sampleBsdf(bounce.bsdfs[i], wo, lobe[i], u[i], v[i]);
        if (!sample || (!sample->delta && ((bounce.ending >> i) & 1u))) continue;
        const Vec3 direction = frame.toWorld(sample->wi);
        if (isAbove(bounce.surface, i, direction) == sample->transmitted) continue;
        setLane(wi, i, direction);
        setLane(origin, i, leave(bounce.surface, i, direction));
        setLane(weight, i, sample->weight);
        pdfW[i] = sample->delta ? kInfinity : sample->pdfW;
        if (sample->transmitted) block.etaScale[i] *= bounce.bsdfs[i].eta * bounce.bsdfs[i].eta;
        alive |= 1u << i;
    }

    LaneMask survivors = 0;
    for (LaneMask lanes = alive; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        Vec3 throughput = laneOf(block.throughput, i) * laneOf(weight, i);
        const float largest = std::max(throughput.x, std::max(throughput.y, throughput.z));
        if (!(largest > 0.0f)) continue;
        const float survival = largest * block.etaScale[i];
        if (bounce.number + 1 >= kRouletteBounce && survival < 1.0f)
        {
            if (roulette[i] >= survival) continue;
            throughput /= survival;
        }
        setLane(block.throughput, i, throughput);
        RayBlock& ray = block.rays.ray;
        ray.originX[i] = origin.x[i];
        ray.originY[i] = origin.y[i];
        ray.originZ[i] = origin.z[i];
        ray.directionX[i] = wi.x[i];
        ray.directionY[i] = wi.y[i];
        ray.directionZ[i] = wi.z[i];
        ray.tNear[i] = 0.0f;
        ray.tFar[i] = kInfinity;
        block.pdfW[i] = pdfW[i];
        if (pdfW[i] < kInfinity)
        {
            if ((bounce.rough >> i) & 1u) block.pixel[i] |= kTaken;
            const bool known = ((bounce.gathering >> i) & 1u) || (block.pixel[i] & kTaken);
            block.pixel[i] = (block.pixel[i] | kScattered) & ~(kCausticChain | kGathered);
            if (known) block.pixel[i] |= kGathered;
        }
        else if (block.pixel[i] & kGathered)
            block.pixel[i] |= kCausticChain;
        survivors |= 1u << i;
    }
    block.active = survivors;
}

} // namespace osgRayTrace::engine
