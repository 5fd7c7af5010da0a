// PathCandidates.cpp - one shadow ray for the samples of several lights. Layer: integrators.
// SPDX-License-Identifier: MIT
//
// Where area lights are few, each of them offers a sample y_k to each surface:
//
//   L = sum over lights k of c_k V(y_k),   c_k = w(y_k) f cos Le(y_k) / pdfW_k(y_k)
//
// All of the sum but the visibility V is known before any ray is traced. So one of the samples is
// chosen with the probability c_k / C, where C is the sum of all c, and C V is added [Talbot05].
// The mean over the choice is the sum above, and where no light is hidden, the choice adds no
// variance. Colours are chosen by the sum of their channels. The weights w are those of samples of
// all lights: the choice does not change them.
//
// Most surfaces of a chain of glossy ones lie beside the highlights of all lights: C is then next
// to nothing, and a shadow ray is worth less than it costs. In the middle of a highlight, the path
// would find some E = Le min(1, w D / 4), throughput included, where D is the largest density of
// half vectors of a GGX lobe, 1 / (pi alpha^2) [Walter07, eq. 33]. The chain may find it anyway, so
// the pixel has noise of that size. If C < t E, the shadow ray is traced with the probability
// q = C / (t E), and C V / q = t E V is added [Veach97, ch. 10]. That adds the variance C t E at
// most, and chains that find E by chance and C in the mean have C E.
#include "osgRayTrace/integrators/path/PathMedium.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// The samples that are chosen so far, one in each lane.
struct Candidates
{
    FloatLanes choice;    ///< number in [0,1) that chooses among the samples to come
    FloatLanes sum = {};  ///< C of the samples so far
    FloatLanes own = {};  ///< c of the sample that is chosen; 0: none
    FloatLanes peak = {}; ///< D / 4 of the surface; 0: no shadow ray is left to roulette
    FloatLanes most;      ///< E of the sample that is chosen, if there is one
    LightLanes chosen;    ///< radiance: c, colour by colour; the weight is not set
};

/// Samples of less than this part of E are left to roulette. At the necklace, 0.03 saves no more
/// time, and has 1 % more error.
constexpr float kFaint = 0.01f;

/// Takes the sample of a lane with the probability of its share in all samples so far.
OSGRAYTRACE_INLINE void offerLane(const LightLanes& light, const Vec3Lanes& throughput,
                                  const Vec3Lanes& scattered, uint32_t lit, int i,
                                  Candidates& candidates)
{
    const float x = scattered.x[i], y = scattered.y[i], z = scattered.z[i];
    const float value = select(lit, x + y + z, 0.0f);
    const float sum = candidates.sum[i] + value;
    const float share = select(sum > 0.0f, value / sum, 0.0f);
    const float u = candidates.choice[i];
    const uint32_t take = maskOf(u < share);
    const float rest = select(take, u / share, (u - share) / (1.0f - share));
    candidates.choice[i] = select(rest < kOneMinusEpsilon, rest, kOneMinusEpsilon);
    candidates.sum[i] = sum;
    candidates.own[i] = select(take, value, candidates.own[i]);
    const float lamp = throughput.x[i] * light.radiance[0][i] +
                       throughput.y[i] * light.radiance[1][i] +
                       throughput.z[i] * light.radiance[2][i];
    const float part = light.weight[i] * candidates.peak[i];
    candidates.most[i] = select(take, lamp * select(part < 1.0f, part, 1.0f), candidates.most[i]);

    LightLanes& chosen = candidates.chosen;
    chosen.radiance[0][i] = select(take, x, chosen.radiance[0][i]);
    chosen.radiance[1][i] = select(take, y, chosen.radiance[1][i]);
    chosen.radiance[2][i] = select(take, z, chosen.radiance[2][i]);
    setLane(chosen.wi, i, select(take, plainOf(light.wi, i), plainOf(chosen.wi, i)));
    const RayBlock &offered = light.shadow, &kept = chosen.shadow;
    setRay(chosen.shadow, i, select(take, plainOrigin(offered, i), plainOrigin(kept, i)),
           select(take, plainDirection(offered, i), plainDirection(kept, i)),
           select(take, offered.tNear[i], kept.tNear[i]),
           select(take, offered.tFar[i], kept.tFar[i]));
}

OSGRAYTRACE_KERNEL
void offer(const LightLanes& light, const Vec3Lanes& throughput, const Vec3Lanes& scattered,
           Candidates& candidates)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
        offerLane(light, throughput, scattered, laneBit(light.lit, i), i, candidates);
}

/// Adds the light of the chosen samples of the lanes.
void addChosen(Tile& tile, const PathBlock& block, const Bounce& bounce, LaneMask lanes,
               Candidates& candidates)
{
    LightLanes& chosen = candidates.chosen;
    chosen.lit = chosen.tinted = 0;
    for (const int i : lanesIn(lanes))
    {
        if (!(candidates.own[i] > 0.0f)) continue;
        float perShare = candidates.sum[i] / candidates.own[i];
        const float survival = candidates.sum[i] / (kFaint * candidates.most[i]); // or infinite
        if (survival < 1.0f)
        {
            // The rest of the number that chose the sample is as good as a new one.
            if (!(candidates.choice[i] < survival)) continue;
            perShare /= survival;
        }
        for (FloatLanes& colour : chosen.radiance)
            colour[i] *= perShare;
        chosen.lit |= 1u << i;
    }
    countRays(tile, block, chosen.lit);
    const LaneMask visible = visibleLanes(tile.context, chosen, tile.counts);
    if (tile.context.traced->traits().media) dimSamples(tile, block, bounce, visible, chosen);
    for (const int i : lanesIn(visible))
        tile.sums.add(block.flagsOf(i),
                      Vec3(chosen.radiance[0][i], chosen.radiance[1][i], chosen.radiance[2][i]));
}

} // namespace

/// Sets the peaks of the lanes whose shadow rays may be left to roulette. What the eye sees keeps
/// all of its shadow rays: its highlights have little noise.
static void setPeaks(const Bounce& bounce, Candidates& candidates)
{
    for (const int i : lanesIn(bounce.number > 0 ? glossyLanes(bounce) : 0))
    {
        const float alpha = std::max(bounce.bsdfs[i].alpha, bounce.bsdfs[i].alphaTangent);
        candidates.peak[i] = 0.25f * kInvPi / (alpha * alpha);
    }
}

void sampleFewLights(Tile& tile, PathBlock& block, const Bounce& bounce, LaneMask lanes)
{
    const uint32_t pass = tile.context.key.index;
    FloatLanes u, v, unused;
    Candidates candidates;
    dimensionPoints(block.seed, pass, bounceDimension(bounce.number, DimensionLightPoint), u, v);
    dimensionPoints(block.seed, pass, bounceDimension(bounce.number, DimensionLightChoice),
                    candidates.choice, unused);
    setPeaks(bounce, candidates);
    const LightTable& table = tile.context.traced->lights();
    for (const uint32_t light : table.areaLights())
    {
        // Paths that meet a light without a probability by chance add all of it.
        if (!(table.areaLightPmf(light) > 0.0f)) continue;
        LightLanes samples;
        areaLightLanes(tile.context, light, 1.0f,
                       {bounce.surface, lanes, bounce.transmissive, u, v}, samples);
        if (!samples.lit) continue;
        Vec3Lanes scattered;
        scatteredLight(block, bounce, samples, samples.lit, bounce.terminating, scattered);
        offer(samples, block.throughput, scattered, candidates);
    }
    addChosen(tile, block, bounce, lanes, candidates);
}

} // namespace osgRayTrace::engine
