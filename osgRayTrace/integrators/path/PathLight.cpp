// PathLight.cpp - adds light that paths meet by chance or by light samples. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/integrators/path/PathMedium.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/LightBsdfs.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"

#include <array>

namespace osgRayTrace::engine
{

void countRays(Tile& tile, const PathBlock& block, LaneMask lanes)
{
    if (!tile.debug) return;
    for (const int i : lanesIn(lanes))
        tile.debug->rays[block.flagsOf(i).pixel()] += 1.0f;
}

OSGRAYTRACE_KERNEL
void dimensionPoints(const UintLanes& seeds, uint32_t passIndex, uint32_t dimension, FloatLanes& u,
                     FloatLanes& v)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        float x, y;
        sobol2(passIndex, dimensionSeed(seeds[i], dimension), x, y);
        u[i] = x;
        v[i] = y;
    }
}

namespace
{

constexpr int kMostTreePicks = 4;

/// Returns how many samples of the tree a path takes at the end of the ray of this number. Most of
/// the noise is that of the first ones: light that is found later is shared, see PathReuse.cpp.
/// With 4 samples a hall and rooms with 1,000 lamps need a third of the time that they need with 1.
constexpr int treePicks(int number)
{
    return number == 0 ? kMostTreePicks : 1;
}

/// Returns the density with which the light samples at the last vertex would have found the light
/// that the ray of this number has met [1/sr].
float pdfOfLight(const LightTable& table, uint32_t light, int number, const PathBlock& block,
                 const SurfaceLanes& surface, int i)
{
    const RayBlock& ray = block.rays.ray;
    const float distance = ray.tFar[i];
    const float cosThetaL =
        std::fabs(glm::dot(directionOf(ray, i), laneOf(surface.geometricNormal, i)));
    const Vec3 from(ray.originX[i], ray.originY[i], ray.originZ[i]);
    if (!table.tree())
    {
        const float pmf = table.hasFewAreaLights() ? 1.0f : table.areaLightPmf(light);
        return pmf * table.pdfFrom(light, from, distance, cosThetaL);
    }
    if (!(block.pdfW[i] < kInfinity)) return 0.0f; // no light sample was taken there
    const uint32_t emitter = table.emitterOf(light, block.rays.primitive[i]);
    if (emitter == kInvalid) return 0.0f;
    const float pmf = table.tree()->pmf(laneOf(block.vertices.position, i),
                                        laneOf(block.vertices.normal, i), emitter);
    const LightEmitter chosen = table.tree()->emitter(emitter);
    const auto picks = static_cast<float>(treePicks(number - 1));
    const float angle =
        chosen.flags & kRectangle ? sampledAngle(rectangleLight(chosen), plainOf(from)) : 0.0f;
    if (angle > 0.0f) return picks * pmf / angle;
    return picks * pmf * distance * distance / (chosen.area * cosThetaL);
}

} // namespace

void addEmission(Tile& tile, const PathBlock& block, const SurfaceLanes& surface, int number,
                 PhotonUse use)
{
    const TracedScene& traced = *tile.context.traced;
    for (const int i : lanesIn(surface.hits))
    {
        if (!traced.materials()[surface.material[i]].emits) continue;
        const Vec3 emission = emissionTowardsRay(tile.context, block.rays, surface, i);
        if (emission == Vec3(0.0f)) continue;
        float weight = 1.0f;
        const uint32_t light = traced.surfaces()[surface.instance[i]].light;
        if (light != kInvalid && traced.lights().areaLightPmf(light) > 0.0f)
        {
            if (use != PhotonUse::None && block.flagsOf(i).isOnCausticChain())
                continue; // photons carry it
            if (block.flagsOf(i).hasCollided() && block.pdfW[i] < kInfinity)
                continue; // sampled along the ray that collided
            weight = powerHeuristic(block.pdfW[i],
                                    pdfOfLight(traced.lights(), light, number, block, surface, i));
        }
        tile.sums.add(block.flagsOf(i), laneOf(block.throughput, i) * emission * weight);
    }
}

namespace
{

/// Sets the radiance that each lane of a diffuse block gets from its light sample, in vector code.
OSGRAYTRACE_KERNEL
void diffuseLight(const Vec3Lanes& normal, const Vec3Lanes& albedo, const LightLanes& light,
                  LaneMask visible, const Vec3Lanes& throughput, bool withoutMis,
                  Vec3Lanes& radiance)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float cosine = dot(plainOf(normal, i), plainOf(light.wi, i));
        const float positive = cosine > 0.0f ? cosine : 0.0f;
        const float pdfBsdf = positive * kInvPi;
        const float ratio = pdfBsdf * light.weight[i];
        const float mis = select(withoutMis, 1.0f, 1.0f / (1.0f + ratio * ratio));
        const float unmasked = pdfBsdf * light.weight[i] * mis;
        // Other lanes may hold anything, also what is no number.
        const uint32_t seen = laneBit(visible, i);
        const float x = throughput.x[i] * albedo.x[i] * light.radiance[0][i] * unmasked;
        const float y = throughput.y[i] * albedo.y[i] * light.radiance[1][i] * unmasked;
        const float z = throughput.z[i] * albedo.z[i] * light.radiance[2][i] * unmasked;
        radiance.x[i] = select(seen, x, 0.0f);
        radiance.y[i] = select(seen, y, 0.0f);
        radiance.z[i] = select(seen, z, 0.0f);
    }
}

} // namespace

void scatteredLight(const PathBlock& block, const Bounce& bounce, const LightLanes& light,
                    LaneMask lanes, LaneMask withoutMis, Vec3Lanes& scattered)
{
    const LaneMask diffuse = lanes & bounce.diffuse, general = lanes & bounce.general;
    if (diffuse)
        diffuseLight(bounce.normal, bounce.albedo, light, diffuse, block.throughput,
                     (diffuse & withoutMis) != 0, scattered);
    else
        scattered = {};
    if (!general) return;
    Vec3Lanes fCos;
    FloatLanes pdfW;
    evalTowardsLight(block.rays.ray, bounce.surface, bounce.normal, bounce.bsdfs, light.wi, general,
                     fCos, pdfW);
    for (const int i : lanesIn(general))
    {
        if (!(pdfW[i] > 0.0f)) continue;
        const float mis =
            (withoutMis >> i) & 1u ? 1.0f : powerHeuristic(1.0f, pdfW[i] * light.weight[i]);
        const Vec3 radiance(light.radiance[0][i], light.radiance[1][i], light.radiance[2][i]);
        setLane(scattered, i,
                laneOf(block.throughput, i) * laneOf(fCos, i) * radiance * (light.weight[i] * mis));
    }
}

static void addClearLight(Tile& tile, const PathBlock& block, const Bounce& bounce,
                          const LightLanes& light, LaneMask visible, LaneMask withoutMis)
{
    const LaneMask lanes = visible & (bounce.diffuse | bounce.general);
    if (!lanes) return;
    Vec3Lanes scattered;
    scatteredLight(block, bounce, light, lanes, withoutMis, scattered);
    for (const int i : lanesIn(lanes))
        tile.sums.add(block.flagsOf(i), laneOf(scattered, i));
}

void addLight(Tile& tile, const PathBlock& block, const Bounce& bounce, const LightLanes& light,
              LaneMask visible, LaneMask withoutMis)
{
    if (!tile.context.traced->traits().media)
    {
        addClearLight(tile, block, bounce, light, visible, withoutMis);
        return;
    }
    LightLanes dimmed = light;
    dimSamples(tile, block, bounce, visible, dimmed);
    addClearLight(tile, block, bounce, dimmed, visible, withoutMis);
}

namespace
{

/// Adds a sample of one area light, which was chosen with probability pmf, for each of the lanes.
void sampleOneLight(Tile& tile, PathBlock& block, const Bounce& bounce, uint32_t light, float pmf,
                    LaneMask lanes, const FloatLanes& u, const FloatLanes& v)
{
    LightLanes samples;
    areaLightLanes(tile.context, light, pmf, {bounce.surface, lanes, bounce.transmissive, u, v},
                   samples);
    countRays(tile, block, samples.lit);
    const LaneMask visible = visibleLanes(tile.context, samples, tile.counts);
    addLight(tile, block, bounce, samples, visible, bounce.terminating);
}

/// Returns the lanes' seeds for one soft light: all soft lights are sampled, each at its own
/// points.
UintLanes seedsOfLight(const UintLanes& seeds, uint32_t light)
{
    UintLanes own;
    for (int i = 0; i < kLanes; ++i)
        own[i] = hash(seeds[i] + 0x9e3779b9u * (light + 1));
    return own;
}

/// Adds samples of emitters that the tree has chosen for each of the lanes.
void sampleTree(Tile& tile, PathBlock& block, const Bounce& bounce, LaneMask lanes)
{
    const TreePoints points = treePoints(bounce.surface, bounce.normal, bounce.transmissive);
    const auto picks = static_cast<uint32_t>(treePicks(bounce.number));
    // Successive points of a sequence fill the tree and the lights evenly.
    const uint32_t first = tile.context.key.index * picks;
    std::array<SceneLightTree::Pick, kMostTreePicks> chosen;
    FloatLanes u, v;
    for (uint32_t j = 0; j < picks; ++j)
        dimensionPoints(block.seed, first + j, bounceDimension(bounce.number, DimensionLightChoice),
                        chosen[j].u, v);
    tile.context.traced->lights().tree()->chooseLanes(points.position, points.normal, chosen.data(),
                                                      picks);
    for (uint32_t j = 0; j < picks; ++j)
    {
        dimensionPoints(block.seed, first + j, bounceDimension(bounce.number, DimensionLightPoint),
                        u, v);
        TreeSamples samples;
        treeLightLanes(tile.context, chosen[j], static_cast<float>(picks),
                       {bounce.surface, lanes, bounce.transmissive, u, v}, samples);
        const LaneMask visible = visibleLanes(tile.context, samples, tile.counts);
        countRays(tile, block, samples.lights.lit);
        addLight(tile, block, bounce, samples.lights, visible & ~samples.points,
                 bounce.terminating);
        addLight(tile, block, bounce, samples.lights, visible & samples.points, kAllLanes);
    }
}

} // namespace

void sampleLights(Tile& tile, PathBlock& block, const Bounce& bounce)
{
    const LightTable& table = tile.context.traced->lights();
    const LaneMask lanes = (bounce.diffuse | bounce.general) & ~bounce.carried;
    const UintLanes& seeds = block.seed;
    for (std::size_t k = 0; k < tile.deltaLights.size(); ++k)
    {
        const auto [index, weight] = tile.deltaLights[k];
        const Light& light = (*tile.context.lights)[index];
        FloatLanes u, v;
        if (isSoft(light))
            dimensionPoints(seedsOfLight(seeds, index), tile.context.key.index,
                            bounceDimension(bounce.number, DimensionLightPoint), u, v);
        LightLanes samples;
        deltaLightLanes(tile.context, index, {bounce.surface, lanes, bounce.transmissive, u, v},
                        samples);
        for (int i = 0; i < kLanes; ++i)
            samples.weight[i] *= weight;
        if (light.castsShadows) countRays(tile, block, samples.lit);
        addLight(tile, block, bounce, samples,
                 visibleLanes(tile.context, light, samples, tile.counts), kAllLanes);
    }
    if (table.environment()) sampleEnvironment(tile, block, bounce, seeds);
    if (table.tree())
    {
        sampleTree(tile, block, bounce, lanes);
        return;
    }
    if (table.areaLights().empty()) return;
    if (table.areaLights().size() > 1 && table.hasFewAreaLights())
    {
        sampleFewLights(tile, block, bounce, lanes);
        return;
    }

    FloatLanes u, v;
    dimensionPoints(seeds, tile.context.key.index,
                    bounceDimension(bounce.number, DimensionLightPoint), u, v);
    if (table.areaLights().size() == 1)
    {
        sampleOneLight(tile, block, bounce, table.areaLights()[0], 1.0f, lanes, u, v);
        return;
    }
    // Lanes that chose the same light are sampled together.
    FloatLanes choice, unused;
    dimensionPoints(seeds, tile.context.key.index,
                    bounceDimension(bounce.number, DimensionLightChoice), choice, unused);
    LaneMask open = lanes;
    LightTable::Choice chosen[kLanes];
    for (const int i : lanesIn(lanes))
        chosen[i] = table.chooseAreaLight(choice[i]);
    while (open)
    {
        const LightTable::Choice& first = chosen[firstLane(open)];
        LaneMask same = 0;
        for (const int i : lanesIn(open))
            same |= static_cast<LaneMask>(chosen[i].light == first.light) << i;
        sampleOneLight(tile, block, bounce, first.light, first.pmf, same, u, v);
        open &= ~same;
    }
}

} // namespace osgRayTrace::engine
