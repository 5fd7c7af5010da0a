// PathReuse.cpp - what the paths of neighbouring pixels lend each other. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// A path that left a diffuse surface x_j and met a diffuse surface at y_j finds there the radiance
// L(y_j), which is the same towards all sides. It is a sample for each pixel of the block whose own
// diffuse surface x_i sees y_j [Bekaert02, sect. 3]. With the densities p_k(y) per area at y with which
// each of the pixels would have found it, and weights of the balance heuristic [Veach97, eq. 9.8]:
//
//   L_i += sum over paths j of albedo_i L(y_j) p_i(y_j) / sum_k p_k(y_j)
//   p_k(y) = cosTheta_k cosTheta_y V(x_k, y) / (pi r^2)
//
// since f_i cosTheta_i cosTheta_y V / r^2 = albedo_i p_i for a diffuse surface. One shadow ray a pair of
// pixels is what it costs, a path is some ten times that. Which y are lent depends on y alone, so that
// all p_k speak of the same samples; others are for their own pixel.
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/HitShading.h"
#include "osgRayTrace/integrators/PathBounce.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kFlat = 1.0f - 1e-6f; ///< cosine between normals that are the same but for rounding
constexpr float kLargestDensity = 1e30f;

// A path is lent with throughput 1 from its second surface on: nothing may have been divided out.
static_assert(kRouletteBounce > 1, "paths reach their second surface without roulette");

/// Densities, times pi, with which the lanes would have found y if they see it, and rays that find out.
/// Returns the lanes where it is not 0.
OSGRAYTRACE_KERNEL
LaneMask densitiesOf(const FirstSurfaces& x, const SecondSurface& second, FloatLanes& density,
                     RayBlock& shadow)
{
    const SecondSurface y = second;
    LaneMask facing = 0;
    OSGRAYTRACE_SIMD_OR(facing)
    for (int i = 0; i < kLanes; ++i)
    {
        const float px = x.position.x[i], py = x.position.y[i], pz = x.position.z[i];
        const float gx = x.geometricNormal.x[i], gy = x.geometricNormal.y[i],
                    gz = x.geometricNormal.z[i];
        const float dx = y.position.x - px, dy = y.position.y - py, dz = y.position.z - pz;
        const float inverse = 1.0f / std::sqrt(dx * dx + dy * dy + dz * dz);
        const float wx = dx * inverse, wy = dy * inverse, wz = dz * inverse;
        const float cosX = wx * x.normal.x[i] + wy * x.normal.y[i] + wz * x.normal.z[i];
        const float cosY = -(wx * y.normal.x + wy * y.normal.y + wz * y.normal.z);
        const float above = wx * gx + wy * gy + wz * gz;
        const float perArea = cosX * cosY * inverse * inverse;
        density[i] = perArea;
        facing |= bitOfLane(maskOf(cosX > 0.0f) & maskOf(cosY > 0.0f) & maskOf(above > 0.0f) &
                                maskOf(perArea > 0.0f) & maskOf(perArea < kLargestDensity),
                            i);

        const float offset = x.offset[i];
        const float ox = px + gx * offset, oy = py + gy * offset, oz = pz + gz * offset;
        const float sx = y.position.x + y.normal.x * y.offset - ox;
        const float sy = y.position.y + y.normal.y * y.offset - oy;
        const float sz = y.position.z + y.normal.z * y.offset - oz;
        const float distance = std::sqrt(sx * sx + sy * sy + sz * sz);
        const float perDistance = 1.0f / distance;
        shadow.originX[i] = ox;
        shadow.originY[i] = oy;
        shadow.originZ[i] = oz;
        shadow.directionX[i] = sx * perDistance;
        shadow.directionY[i] = sy * perDistance;
        shadow.directionZ[i] = sz * perDistance;
        shadow.tNear[i] = 0.0f;
        shadow.tFar[i] = distance;
        shadow.time[i] = 0.0f;
        shadow.mask[i] = 0xffffffffu;
        shadow.id[i] = 0;
        shadow.flags[i] = 0;
    }
    return facing & x.lanes;
}

/// Densities of 0 in all lanes but those of seen.
OSGRAYTRACE_KERNEL
void hide(LaneMask seen, FloatLanes& density)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        density[i] = select(laneBit(seen, i), density[i], 0.0f);
}

float sumOf(const FloatLanes& values)
{
    float sum = 0.0f;
    for (int i = 0; i < kLanes; ++i)
        sum += values[i];
    return sum;
}

OSGRAYTRACE_KERNEL
void shareOut(const FirstSurfaces& x, const FloatLanes& density, Vec3 radiance, float* __restrict r,
              float* __restrict g, float* __restrict b)
{
    const Vec3 l = radiance;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        // Albedos of lanes that are not diffuse are not set.
        const uint32_t use = maskOf(density[i] > 0.0f);
        r[i] += select(use, x.albedo.x[i] * (l.x * density[i]), 0.0f);
        g[i] += select(use, x.albedo.y[i] * (l.y * density[i]), 0.0f);
        b[i] += select(use, x.albedo.z[i] * (l.z * density[i]), 0.0f);
    }
}

/// The lanes of x that see y, without asking for lane own, which does.
LaneMask seeingLanes(Tile& tile, int b, LaneMask lanes, int own, RayBlock& shadow)
{
    const LaneMask asked = lanes & ~(1u << own);
    if (!asked) return lanes;
    tile.context.traced->intersector().occlusion(shadow, asked);
    tile.counts.shadowRays += static_cast<uint64_t>(__builtin_popcount(asked));
    LaneMask seeing = lanes;
    for (LaneMask m = asked; m; m &= m - 1)
    {
        const int i = __builtin_ctz(m);
        if (!(shadow.tFar[i] >= 0.0f)) seeing &= ~(1u << i);
        if (tile.diagnostics) tile.diagnostics->rays[b * kLanes + i] += 1.0f;
    }
    return seeing;
}

void returnPath(Tile& tile, int b, int own, Vec3 radiance)
{
    const FirstSurfaces& x = tile.loans.first[b];
    const int pixel = b * kLanes + own;
    FloatLanes density;
    RayBlock shadow;
    const LaneMask facing = densitiesOf(x, tile.loans.second[pixel], density, shadow);
    hide(seeingLanes(tile, b, facing, own, shadow), density);
    const float sum = sumOf(density);
    const bool finite = std::max(radiance.x, std::max(radiance.y, radiance.z)) < kInfinity;
    if (!(sum > 0.0f) || !finite) // NaN included: it spoils its own pixel alone
    {
        tile.sums.add(static_cast<uint32_t>(pixel), laneOf(x.albedo, own) * radiance);
        return;
    }
    const int first = b * kLanes;
    shareOut(x, density, radiance / sum, tile.sums.r + first, tile.sums.g + first,
             tile.sums.b + first);
}

} // namespace

void noteFirstSurfaces(Tile& tile, int b, const Bounce& bounce)
{
    FirstSurfaces& first = tile.loans.first[b];
    first.lanes = bounce.diffuse & ~bounce.ending & ~bounce.surface.lifted;
    if (!first.lanes) return;
    first.position = bounce.surface.position;
    first.geometricNormal = bounce.surface.geometricNormal;
    first.normal = bounce.normal;
    first.albedo = bounce.albedo;
    first.offset = bounce.surface.offset;
}

void lendPaths(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    for (LaneMask lanes = bounce.diffuse & ~bounce.surface.lifted; lanes; lanes &= lanes - 1)
    {
        const int i = __builtin_ctz(lanes);
        const uint32_t pixel = block.pixel[i] & (kTilePixels - 1);
        const FirstSurfaces& first = tile.loans.first[pixel / kLanes];
        const uint32_t own = pixel % kLanes;
        if (!((first.lanes >> own) & 1u)) continue;
        const Vec3 normal = laneOf(bounce.surface.geometricNormal, i);
        if (!(glm::dot(normal, laneOf(bounce.normal, i)) > kFlat)) continue;
        tile.loans.second[pixel] = {laneOf(bounce.surface.position, i), normal,
                                    bounce.surface.offset[i]};
        tile.loans.lent[pixel / kLanes] |= 1u << own;
        block.pixel[i] |= kLent;
        // Roulette goes on as if the path were still its own pixel's alone.
        const Vec3 throughput = laneOf(block.throughput, i);
        block.etaScale[i] *= std::max(throughput.x, std::max(throughput.y, throughput.z));
        setLane(block.throughput, i, Vec3(1.0f));
    }
}

void returnPaths(Tile& tile)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        for (LaneMask lanes = tile.loans.lent[b]; lanes; lanes &= lanes - 1)
        {
            const int own = __builtin_ctz(lanes);
            const int at = static_cast<int>(kLent) + b * kLanes + own;
            const Vec3 radiance(tile.sums.r[at], tile.sums.g[at], tile.sums.b[at]);
            if (radiance != Vec3(0.0f)) returnPath(tile, b, own, radiance);
        }
    }
}

} // namespace osgRayTrace::engine
