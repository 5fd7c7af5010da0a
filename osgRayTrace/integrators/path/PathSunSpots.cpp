// PathSunSpots.cpp - surfaces lit by the sky through portals, as lights of other surfaces. Layer:
// integrators.
// SPDX-License-Identifier: MIT
//
// The sun comes through a window and lights a spot, which is bright and small: most rays miss it.
// So each tile sends beams from portals into the room, along directions omega that samples of the
// sky find. A beam ends at a spot z, and each surface y that a path meets from its second one on
// takes a sample of one of the spots. The first one does so of spots behind panes, to which pixels
// do not share paths (PathReuse.cpp).
//
//   L_y = f_y cosTheta_y g B V / (p_y g (p_sky + p_portal) + p_sky p_beam),
//   g = cosTheta_z / r^2,   B = f_z cosTheta_z' L(omega) V'
//
// where p_y is the density with which y would have sent its ray to z, p_sky and p_portal are those
// of light samples at z, and p_beam is the density of beams at z for given omega,
//
//   p_beam = number of portals before z in direction omega * cosTheta_z' / sum of A cosTheta.
//
// Paths that find z by themselves and light from omega there by light samples weigh that light with
// the rest, by the balance heuristic [Veach97, eq. 9.8] over y's three ways to find (z, omega). The
// weight of light samples at z against the ray that z sends on is in both. Spots are virtual point
// lights [Keller97] of one reflection; the weights leave corners, where such lights are too strong,
// to the rays.
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/MergeHits.h"
#include "osgRayTrace/integrators/path/PathBounce.h"
#include "osgRayTrace/integrators/shared/EnvironmentLanes.h"
#include "osgRayTrace/integrators/shared/HitShading.h"
#include "osgRayTrace/integrators/shared/LightBsdfs.h"
#include "osgRayTrace/integrators/shared/ShadowLanes.h"
#include "osgRayTrace/integrators/shared/SkyPortals.h"

namespace osgRayTrace::engine
{

namespace
{

constexpr float kFlat = 1.0f - 1e-6f; ///< least cosine between normals that differ by rounding only
constexpr int kMostPanes = 64;

/// The spots' dimensions lie apart from those of bounces and of samples of the sky.
constexpr uint32_t kSpotDimension = 0x80000u;

/// Takes beams on through panes, whose share of the light the shadow ray from the spot finds.
/// Returns the lanes that have passed some.
LaneMask passPanesStraight(Tile& tile, RayHitBlock& rays, LaneMask lanes, SurfaceLanes& surface)
{
    const TracedScene& traced = *tile.context.traced;
    const MaterialTable& materials = traced.materials();
    LaneMask all = 0;
    for (int panes = 0; panes < kMostPanes; ++panes)
    {
        LaneMask passed = 0;
        for (const int i : lanesIn(lanes & surface.hits))
            passed |= static_cast<LaneMask>(materials[surface.material[i]].pane) << i;
        if (!passed) return all;
        all |= passed;
        RayHitBlock behind;
        behind.ray = rays.ray;
        for (const int i : lanesIn(passed))
        {
            behind.ray.tNear[i] = std::nextafter(rays.ray.tFar[i], kInfinity);
            behind.ray.tFar[i] = kInfinity;
        }
        traced.intersector().closestHits(behind, passed, Coherence::Incoherent);
        tile.counts.secondaryRays += static_cast<uint64_t>(countLanes(passed));
        SurfaceLanes met;
        surfacesOf(traced.surfaces(), behind, passed, met, rayStart(tile.context.options));
        mergeHits(behind, met, passed, rays, surface);
    }
    return all;
}

/// Returns the lanes whose surfaces can be spots, whatever side the rays came from.
LaneMask spotLanes(const Tile& tile, const SurfaceLanes& surface)
{
    const MaterialTable& materials = tile.context.traced->materials();
    LaneMask lanes = 0;
    for (const int i : lanesIn(surface.hits & ~surface.terminatorLanes))
    {
        const MaterialRecord& record = materials[surface.material[i]];
        const bool flat = std::fabs(glm::dot(laneOf(surface.shadingNormal, i),
                                             laneOf(surface.geometricNormal, i))) > kFlat;
        const bool diffuse = record.plainDiffuse && record.front.diffuse != Vec3(0.0f);
        lanes |= static_cast<LaneMask>(flat && diffuse) << i;
    }
    return lanes;
}

/// Sends sixteen beams, and adds the spots that they light.
void addSpots(Tile& tile, const UintLanes& seeds, uint32_t index)
{
    const PassContext& context = tile.context;
    const TracedScene& traced = *context.traced;
    const PlacedEnvironment& environment = *traced.lights().shiningEnvironment();
    FloatLanes u, v, x, y;
    dimensionPoints(seeds, index, kSpotDimension, u, v);
    dimensionPoints(seeds, index, kSpotDimension + 1, x, y);
    RayHitBlock rays;
    LightLanes samples;
    samples.lit = samples.tinted = 0;
    FloatLanes pdfSky;
    LaneMask sent = 0;
    for (int i = 0; i < kLanes; ++i)
    {
        const SkySample sky = sampleSky(context, environment, {u[i], v[i]}, false);
        if (!(sky.pdfW > 0.0f)) continue;
        const std::optional<Vec3> begin = context.portals->sampleBeam(sky.direction, x[i], y[i]);
        if (!begin) continue;
        setSample(samples, i, sky.direction, sky.radiance, 1.0f / sky.pdfW);
        setRay(rays.ray, i, plainOf(*begin), plainOf(-sky.direction), 0.0f, kInfinity);
        pdfSky[i] = sky.pdfW;
        sent |= 1u << i;
    }
    if (!sent) return;
    traced.intersector().closestHits(rays, sent, Coherence::Incoherent);
    tile.counts.secondaryRays += static_cast<uint64_t>(countLanes(sent));
    SurfaceLanes surface;
    surfacesOf(traced.surfaces(), rays, sent, surface, rayStart(context.options));
    const LaneMask behind =
        traced.traits().panes ? passPanesStraight(tile, rays, sent, surface) : 0;
    Vec3Lanes normal;
    facingNormalLanes(rays.ray, surface, normal);
    for (const int i : lanesIn(spotLanes(tile, surface) & sent))
    {
        const Vec3 wi = laneOf(samples.wi, i);
        if (!(glm::dot(wi, laneOf(surface.geometricNormal, i)) > 0.0f)) continue;
        setRay(samples.shadow, i, leave(surface, i, wi), wi, kInfinity);
        samples.lit |= 1u << i;
    }
    const LaneMask visible = visibleLanes(context, samples, tile.counts);
    for (const int i : lanesIn(visible))
    {
        const Vec3 wi = laneOf(samples.wi, i), position = laneOf(surface.position, i);
        const float cosine = glm::dot(wi, laneOf(normal, i));
        const float beams = context.portals->beamPdfA(position, wi, cosine);
        if (!(beams > 0.0f) || !(cosine > 0.0f)) continue; // rounding
        SunSpot& spot = tile.spots.spots[tile.spots.count];
        spot.position = position;
        spot.normal = laneOf(surface.geometricNormal, i);
        spot.offset = surface.offset[i];
        const float byLight = pdfSky[i] + context.portals->chanceOf(position, wi).pdfW;
        const float mis = powerHeuristic(byLight, cosine * kInvPi);
        const Vec3 albedo = traced.materials()[surface.material[i]].front.diffuse;
        const Vec3 light(samples.radiance[0][i], samples.radiance[1][i], samples.radiance[2][i]);
        spot.radiance = albedo * light * (kInvPi * cosine * mis);
        spot.byLight = byLight;
        spot.byBeam = pdfSky[i] * beams;
        if (traced.traits().panes && !((behind >> i) & 1u))
            std::swap(spot, tile.spots.spots[tile.spots.outside++]);
        ++tile.spots.count;
    }
}

/// A spot, and the number of beams that it stands for.
struct ChosenSpot
{
    const SunSpot* spot;
    float beams; ///< 1 over the probability of the choice
};

/// Chooses a spot; fromEye: rather one of those outside of panes, as others give nothing but by a
/// further pane. place: number in [0,1).
ChosenSpot chooseSpot(const SunSpots& spots, bool fromEye, float place)
{
    constexpr float kOutside = 0.75f; ///< share of the places of spots outside of panes
    const float first = fromEye && spots.outside > 0 ? kOutside : 0.0f;
    const int count = place < first ? spots.outside : spots.count;
    const float within = place < first ? place / first : (place - first) / (1.0f - first);
    const int at = std::min(static_cast<int>(within * static_cast<float>(count)), count - 1);
    float pmf = (1.0f - first) / static_cast<float>(spots.count);
    if (at < spots.outside && first > 0.0f) pmf += first / static_cast<float>(spots.outside);
    return {&spots.spots[at], 1.0f / pmf};
}

} // namespace

void beginSunSpots(Tile& tile)
{
    const SkyPortals* portals = tile.context.portals;
    tile.spots.active = portals && portals->lightsSpots();
    if (!tile.spots.active) return;
    const PassKey& key = tile.context.key;
    UintLanes seeds;
    const uint32_t seed =
        hash(pixelSeed(key, static_cast<uint32_t>(tile.left), static_cast<uint32_t>(tile.bottom)));
    for (int b = 0; b < SunSpots::kBeams / kLanes; ++b)
    {
        for (int i = 0; i < kLanes; ++i)
            seeds[i] = hash(seed, static_cast<uint32_t>(b * kLanes + i));
        addSpots(tile, seeds, key.index);
    }
}

void sampleSunSpots(Tile& tile, PathBlock& block, const Bounce& bounce, const UintLanes& seeds)
{
    if (!tile.spots.active || tile.spots.count == 0) return;
    if (bounce.number == 0 && !tile.context.traced->traits().panes) return;
    if (bounce.number + 1 >= tile.context.options.maxBounces) return;
    const PassContext& context = tile.context;
    const LaneMask lanes = bounce.diffuse | (bounce.general & ~bounce.smooth);
    FloatLanes choice, unused;
    dimensionPoints(seeds, context.key.index,
                    bounceDimension(bounce.number, DimensionLightChoice) + kSpotDimension, choice,
                    unused);
    LightLanes samples;
    samples.lit = samples.tinted = 0;
    ChosenSpot chosen[kLanes];
    FloatLanes geometry;
    for (const int i : lanesIn(lanes))
    {
        chosen[i] = chooseSpot(tile.spots, bounce.number == 0, choice[i]);
        const SunSpot& spot = *chosen[i].spot;
        const Vec3 end = spot.position + spot.normal * spot.offset;
        const Vec3 d = spot.position - laneOf(bounce.surface.position, i);
        const float distance2 = glm::dot(d, d);
        const Vec3 wi = d / std::sqrt(distance2);
        const float cosine = -glm::dot(wi, spot.normal);
        geometry[i] = cosine / distance2;
        if (!(cosine > 0.0f) || !(geometry[i] < 1e30f)) continue;
        const bool above = ((bounce.transmissive | bounce.surface.terminatorLanes) >> i) & 1u ||
                           glm::dot(wi, laneOf(bounce.surface.geometricNormal, i)) > 0.0f;
        if (!above) continue;
        const RayBegin begin = leave(bounce.surface, i, wi);
        const Vec3 way = end - begin.origin;
        const float length = glm::length(way);
        setRay(samples.shadow, i, begin, way / length, length);
        setSample(samples, i, wi, spot.radiance, 0.0f);
        samples.lit |= 1u << i;
    }
    Vec3Lanes fCos;
    FloatLanes pdfW;
    if (samples.lit & bounce.general)
        evalTowardsLight(block.rays.ray, bounce.surface, bounce.normal, bounce.bsdfs, samples.wi,
                         samples.lit & bounce.general, fCos, pdfW);
    for (const int i : lanesIn(samples.lit))
    {
        const SunSpot& spot = *chosen[i].spot;
        const bool diffuse = (bounce.diffuse >> i) & 1u;
        const float pdf =
            diffuse ? kInvPi * glm::dot(laneOf(samples.wi, i), laneOf(bounce.normal, i)) : pdfW[i];
        if (!(pdf > 0.0f))
        {
            samples.lit &= ~(1u << i);
            continue;
        }
        samples.weight[i] = chosen[i].beams / static_cast<float>(SunSpots::kBeams) * geometry[i] /
                            (pdf * geometry[i] * spot.byLight + spot.byBeam);
    }
    if (!samples.lit) return;
    countRays(tile, block, samples.lit);
    LaneMask visible = visibleLanes(context, samples, tile.counts);
    if (bounce.number == 0) visible &= samples.tinted; // pixels share the paths to other spots
    addLight(tile, block, bounce, samples, visible, kAllLanes);
}

LaneMask lanesOnSpots(const Tile& tile, const PathBlock& block, const Bounce& bounce)
{
    if (!tile.spots.active || bounce.number == 0) return 0;
    LaneMask lanes = spotLanes(tile, bounce.surface) & bounce.diffuse;
    if (bounce.number == 1) lanes &= bounce.behindPanes;
    for (const int i : lanesIn(lanes))
        if (!(block.pdfW[i] < kInfinity)) lanes &= ~(1u << i);
    return lanes;
}

float shareBesideSpots(const Tile& tile, const PathBlock& block, const Bounce& bounce, int i,
                       Vec3 wi, float pdfSky, float pdfPortal)
{
    if (!(pdfSky > 0.0f)) return 1.0f;
    const Vec3 normal = laneOf(bounce.normal, i);
    const float cosine = glm::dot(wi, normal);
    const float beams =
        tile.context.portals->beamPdfA(laneOf(bounce.surface.position, i), wi, cosine);
    if (!(beams > 0.0f)) return 1.0f;
    const RayBlock& ray = block.rays.ray;
    const float distance = ray.tFar[i];
    const float geometry = -glm::dot(directionOf(ray, i), normal) / (distance * distance);
    const float own = block.pdfW[i] * geometry * (pdfSky + pdfPortal);
    return own / (own + pdfSky * beams);
}

} // namespace osgRayTrace::engine
