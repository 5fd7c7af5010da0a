// PathReuse.cpp - shares paths among the pixels of a group. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// A path that left a diffuse surface x_j and met a diffuse surface at y_j finds there the radiance
// L(y_j), which is the same towards all sides. This radiance is a sample for each pixel of the
// group whose own diffuse surface x_i sees y_j [Bekaert02, sect. 3]. The density p_k(y) is the
// density per area with which pixel k would have found y, and the weights are those of the balance
// heuristic [Veach97, eq. 9.8]:
//
//   L_i += sum over paths j of albedo_i L(y_j) p_i(y_j) / sum_k p_k(y_j)
//   p_k(y) = cosTheta_k cosTheta_y V(x_k, y) / (pi r^2)
//
// The sum holds because f_i cosTheta_i cosTheta_y V / r^2 = albedo_i p_i for a diffuse surface. A
// connection costs one shadow ray for each pair of pixels, and a path costs some ten times as much.
// The choice of reused y depends on y alone, so that all p_k belong to the same samples; paths with
// any other y are for their own pixel. V is 0 behind panes, and a path that has passed a pane on
// its way from x_j to y_j is for its own pixel: so each y that a pixel sees through a pane is found
// by that pixel's own paths alone, and each y that it sees without by those that are reused.
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/HitShading.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

constexpr float kFlat = 1.0f - 1e-6f; ///< least cosine between normals that differ by rounding only
constexpr float kLargestDensity = 1e30f;

// A path is reused with throughput 1 from its second surface on: roulette must not have divided the
// throughput before.
static_assert(kRouletteBounce > 1, "paths reach their second surface without roulette");

/// Sets lane i of densitiesOf. Returns all bits if the density is not 0, and else none.
OSGRAYTRACE_INLINE uint32_t densityOf(const FirstSurfaces& x, const SecondSurface& y, int i,
                                      FloatLanes& density, RayBlock& shadow)
{
    const PlainVec3 p = plainOf(x.position, i), facet = plainOf(x.geometricNormal, i);
    const PlainVec3 yPosition = plainOf(y.position), yNormal = plainOf(y.normal);
    const PlainVec3 d = yPosition - p;
    const float inverse = 1.0f / std::sqrt(dot(d, d));
    const PlainVec3 w = d * inverse;
    const float cosX = dot(w, plainOf(x.normal, i));
    const float cosY = -dot(w, yNormal);
    const float above = dot(w, facet);
    const float perArea = cosX * cosY * inverse * inverse;
    density[i] = perArea;

    const PlainVec3 origin = p + facet * x.offset[i];
    const PlainVec3 s = yPosition + yNormal * y.offset - origin;
    const float distance = std::sqrt(dot(s, s));
    setRay(shadow, i, origin, s * (1.0f / distance), 0.0f, distance);
    return maskOf(cosX > 0.0f) & maskOf(cosY > 0.0f) & maskOf(above > 0.0f) &
           maskOf(perArea > 0.0f) & maskOf(perArea < kLargestDensity);
}

/// Sets the densities, times pi, with which the lanes would have found the second surface if they
/// see it, and the shadow rays that ask whether they do. Returns the lanes whose density is not 0.
OSGRAYTRACE_KERNEL
LaneMask densitiesOf(const FirstSurfaces& x, const SecondSurface& second, FloatLanes& density,
                     RayBlock& shadow)
{
    const SecondSurface y = second;
    LaneMask facing = 0;
    OSGRAYTRACE_SIMD_OR(facing)
    for (int i = 0; i < kLanes; ++i)
        facing |= bitOfLane(densityOf(x, y, i, density, shadow), i);
    return facing & x.lanes;
}

/// Sets the densities of all lanes to 0, except those of seen.
OSGRAYTRACE_KERNEL
void hide(LaneMask seen, FloatLanes& density)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        density[i] = select(laneBit(seen, i), density[i], 0.0f);
}

/// Returns the sum over all lanes.
float sumOf(const FloatLanes& values)
{
    float sum = 0.0f;
    for (int i = 0; i < kLanes; ++i)
        sum += values[i];
    return sum;
}

/// Adds to each lane's share its albedo times density times radiance.
OSGRAYTRACE_KERNEL
void shareOut(const FirstSurfaces& x, const FloatLanes& density, Vec3 radiance, Vec3Lanes& shares)
{
    const Vec3 l = radiance;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        // The albedos of members that are not diffuse are not set.
        const uint32_t use = maskOf(density[i] > 0.0f);
        shares.x[i] += select(use, x.albedo.x[i] * (l.x * density[i]), 0.0f);
        shares.y[i] += select(use, x.albedo.y[i] * (l.y * density[i]), 0.0f);
        shares.z[i] += select(use, x.albedo.z[i] * (l.z * density[i]), 0.0f);
    }
}

/// Returns the members that see the second surface. No shadow ray is traced for the member own,
/// whose path found this surface.
LaneMask seeingMembers(Tile& tile, int group, LaneMask facing, int own, RayBlock& shadow)
{
    const LaneMask asked = facing & ~(1u << own);
    if (!asked) return facing;
    tile.context.traced->intersector().occlusion(shadow, asked);
    tile.counts.shadowRays += static_cast<uint64_t>(countLanes(asked));
    LaneMask seeing = facing;
    for (const int i : lanesIn(asked))
    {
        if (!(shadow.tFar[i] >= 0.0f)) seeing &= ~(1u << i);
        if (tile.debug) tile.debug->rays[tile.reuse.pixelOf(group, i)] += 1.0f;
    }
    return seeing;
}

/// Adds to shares the members' parts of the radiance that the path of the member own has found.
void connectPath(Tile& tile, int group, int own, Vec3 radiance, Vec3Lanes& shares)
{
    const FirstSurfaces& x = tile.reuse.first[group];
    const uint32_t pixel = tile.reuse.pixelOf(group, own);
    FloatLanes density;
    RayBlock shadow;
    const LaneMask facing = densitiesOf(x, tile.reuse.second[pixel], density, shadow);
    hide(seeingMembers(tile, group, facing, own, shadow), density);
    const float sum = sumOf(density);
    if (sum > 0.0f)
        shareOut(x, density, radiance / sum, shares);
    else // rounding took the density of a path that exists
        tile.sums.add(PathFlags::ofPixel(pixel), laneOf(x.albedo, own) * radiance);
}

/// Returns the mean luminance that the tile's reused paths have found.
float meanRadiance(const Tile& tile)
{
    float sum = 0.0f;
    int count = 0;
    for (int group = 0; group < kReuseGroups; ++group)
        for (const int own : lanesIn(tile.reuse.reused[group]))
        {
            const PathFlags path = PathFlags::ofPixel(tile.reuse.pixelOf(group, own));
            const float value = luminance(tile.sums.reused(path));
            if (!std::isfinite(value)) continue;
            sum += value;
            ++count;
        }
    return count > 0 ? sum / static_cast<float>(count) : 0.0f;
}

/// Returns a number in [0,1) that decides on the pixel's path.
float numberOf(const Tile& tile, uint32_t pixel)
{
    constexpr uint32_t kConnected = 0x7e05eu;
    const auto block = static_cast<int>(pixel / kLanes), lane = static_cast<int>(pixel % kLanes);
    const uint32_t seed =
        pixelSeed(tile.context.key, static_cast<uint32_t>(tile.left + laneX(block, lane)),
                  static_cast<uint32_t>(tile.bottom + laneY(block, lane)));
    return unitFloat(hash(hash(seed, kConnected), tile.context.key.index));
}

/// Adds the light of a group's reused paths to the sums of its pixels. Of paths with less luminance
/// than the bound, those are connected that roulette chooses.
void connectGroup(Tile& tile, int group, float bound)
{
    Vec3Lanes shares = {};
    for (const int own : lanesIn(tile.reuse.reused[group]))
    {
        const PathFlags path = PathFlags::ofPixel(tile.reuse.pixelOf(group, own));
        Vec3 radiance = tile.sums.reused(path);
        if (radiance == Vec3(0.0f)) continue;
        const float survival = luminance(radiance) / bound; // infinite, or no number: no roulette
        if (survival < 1.0f)
        {
            if (!(numberOf(tile, path.pixel()) < survival)) continue;
            radiance /= survival;
        }
        if (isFinite(radiance))
            connectPath(tile, group, own, radiance, shares);
        else // only the path's own pixel is dropped and counted
            tile.sums.add(path, radiance);
    }
    for (int i = 0; i < kTileBlocks; ++i)
        tile.sums.add(PathFlags::ofPixel(tile.reuse.pixelOf(group, i)), laneOf(shares, i));
}

} // namespace

void beginReuse(Tile& tile, PhotonUse use)
{
    const GatheredPhotons* gathered = tile.result.photons.gathered;
    tile.reuse.active = use != PhotonUse::Indirect && !(gathered && gathered->separate) &&
                        !tile.context.traced->traits().media;
    const PassKey& key = tile.context.key;
    const uint32_t seed =
        pixelSeed(key, static_cast<uint32_t>(tile.left), static_cast<uint32_t>(tile.bottom));
    for (uint32_t b = 0; b < kTileBlocks; ++b)
        tile.reuse.turn[b] = hash(seed + b) % kLanes;
}

void recordFirstSurfaces(Tile& tile, int b, const Bounce& bounce)
{
    const Vec3Lanes& throughput = tile.paths.blocks[b].throughput; // below 1 behind fog
    for (const int i :
         lanesIn(bounce.diffuse & ~bounce.terminating & ~bounce.surface.terminatorLanes))
    {
        FirstSurfaces& first =
            tile.reuse.first[tile.reuse.groupOf(static_cast<uint32_t>(b * kLanes + i))];
        first.lanes |= 1u << b;
        setLane(first.position, b, laneOf(bounce.surface.position, i));
        setLane(first.geometricNormal, b, laneOf(bounce.surface.geometricNormal, i));
        setLane(first.normal, b, laneOf(bounce.normal, i));
        setLane(first.albedo, b, laneOf(bounce.albedo, i) * laneOf(throughput, i));
        first.offset[b] = bounce.surface.offset[i];
    }
}

void reusePaths(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    for (const int i :
         lanesIn(bounce.diffuse & ~bounce.surface.terminatorLanes & ~bounce.behindPanes))
    {
        const uint32_t pixel = block.flagsOf(i).pixel();
        const int group = tile.reuse.groupOf(pixel);
        const uint32_t own = pixel / kLanes;
        if (!((tile.reuse.first[group].lanes >> own) & 1u)) continue;
        const Vec3 normal = laneOf(bounce.surface.geometricNormal, i);
        if (!(glm::dot(normal, laneOf(bounce.normal, i)) > kFlat)) continue;
        tile.reuse.second[pixel] = {laneOf(bounce.surface.position, i), normal,
                                    bounce.surface.offset[i]};
        tile.reuse.reused[group] |= 1u << own;
        block.flags[i] = block.flagsOf(i).reused().word();
        OSGRAYTRACE_ASSERT(block.flagsOf(i).hasTaken() || !tile.looksUpPhotons());
        // Roulette goes on as if the path still belonged to its own pixel alone.
        const Vec3 throughput = laneOf(block.throughput, i);
        block.etaScale[i] *= std::max(throughput.x, std::max(throughput.y, throughput.z));
        setLane(block.throughput, i, Vec3(1.0f));
    }
}

void connectPaths(Tile& tile)
{
    // Where portals are sampled, nearly all paths find some light, most of them little.
    const float bound = tile.context.portals ? meanRadiance(tile) : 0.0f;
    for (int group = 0; group < kReuseGroups; ++group)
        if (tile.reuse.reused[group]) connectGroup(tile, group, bound);
}

} // namespace osgRayTrace::engine
